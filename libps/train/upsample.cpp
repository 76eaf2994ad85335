// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/upsample.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <vector>

namespace ps::train {
namespace {

using torch::Tensor;

constexpr float kNear = .75f, kFar = .25f;

/// to = kNear * near + kFar * far
void blend(const float* near, const float* far, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) to[i] = kNear * near[i] + kFar * far[i];
}

/// A row of w pixels of c channels, to one of 2 w.
void widen(const float* row, float* to, std::int64_t w, std::int64_t c) {
  for (std::int64_t x = 0; x < w; ++x) {
    const std::int64_t left = std::max<std::int64_t>(x - 1, 0), right = std::min(x + 1, w - 1);
    blend(row + x * c, row + left * c, to + 2 * x * c, c);
    blend(row + x * c, row + right * c, to + (2 * x + 1) * c, c);
  }
}

/// What widen() passes back: each pixel's share of the four that it is part of. Beyond the ends,
/// the last pixel stands for its neighbour.
void narrow(const float* row, float* to, std::int64_t w, std::int64_t c) {
  const std::int64_t last = 2 * w - 1;
  for (std::int64_t x = 0; x < w; ++x) {
    const float* const a = row + std::max<std::int64_t>(2 * x - 1, 0) * c;
    const float* const b = row + 2 * x * c;
    const float* const d = row + (2 * x + 1) * c;
    const float* const e = row + std::min(2 * x + 2, last) * c;
    float* const out = to + x * c;
    for (std::int64_t i = 0; i < c; ++i) out[i] = kNear * (b[i] + d[i]) + kFar * (a[i] + e[i]);
  }
}

Tensor channels_last(const Tensor& x) { return x.contiguous(torch::MemoryFormat::ChannelsLast); }

Tensor empty_like_of(const Tensor& x, std::int64_t h, std::int64_t w) {
  return torch::empty({x.size(0), x.size(1), h, w}, x.options(), torch::MemoryFormat::ChannelsLast);
}

Tensor upsampled(const Tensor& image) {
  const Tensor x = channels_last(image);
  const std::int64_t c = x.size(1), h = x.size(2), w = x.size(3), row = w * c;
  const Tensor out = empty_like_of(x, 2 * h, 2 * w);
  const float* const from = x.data_ptr<float>();
  float* const to = out.data_ptr<float>();
  at::parallel_for(0, x.size(0) * h, 1, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> mixed(static_cast<std::size_t>(row));
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t y = i % h;
      const float* const at = from + i * row;
      for (const std::int64_t below : {0, 1}) {
        const bool inside = below != 0 ? y + 1 < h : y > 0;
        const std::int64_t step = below != 0 ? row : -row;
        blend(at, inside ? at + step : at, mixed.data(), row);
        widen(mixed.data(), to + (2 * i + below) * 2 * row, w, c);
      }
    }
  });
  return out;
}

Tensor passed_back(const Tensor& gradient) {
  const Tensor g = channels_last(gradient);
  const std::int64_t c = g.size(1), h = g.size(2) / 2, w = g.size(3) / 2, row = 2 * w * c;
  const Tensor out = empty_like_of(g, h, w);
  const float* const from = g.data_ptr<float>();
  float* const to = out.data_ptr<float>();
  at::parallel_for(0, g.size(0) * h, 1, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> mixed(static_cast<std::size_t>(row));
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t y = i % h;
      const float* const b = from + 2 * i * row;
      const float* const a = y > 0 ? b - row : b;
      const float* const d = b + row;
      const float* const e = y + 1 < h ? d + row : d;
      for (std::int64_t k = 0; k < row; ++k) {
        mixed[static_cast<std::size_t>(k)] = kNear * (b[k] + d[k]) + kFar * (a[k] + e[k]);
      }
      narrow(mixed.data(), to + i * w * c, w, c);
    }
  });
  return out;
}

class Upsample : public torch::autograd::Function<Upsample> {
 public:
  static Tensor forward(torch::autograd::AutogradContext*, const Tensor& x) { return upsampled(x); }
  static torch::autograd::variable_list backward(torch::autograd::AutogradContext*,
                                                 torch::autograd::variable_list gradients) {
    return {passed_back(gradients[0])};
  }
};

}  // namespace

Tensor upsample_2x(const Tensor& x) {
  if (!x.is_cpu() || x.scalar_type() != torch::kFloat32) {
    return torch::upsample_bilinear2d(x, {2 * x.size(2), 2 * x.size(3)}, false);
  }
  return Upsample::apply(x);
}

}  // namespace ps::train
