// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/upsample.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <vector>

#include "libps/train/layers.h"
#include "libps/train/narrow.h"

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
PS_ANY_WIDTH void narrow(const float* row, float* to, std::int64_t w, std::int64_t c) {
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

/// to = kNear * near + kFar * far, of what is above 0
PS_ANY_WIDTH void rectified_blend(const float* near, const float* far, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    const float a = chosen(near[i] < 0, 0, near[i]), b = chosen(far[i] < 0, 0, far[i]);
    to[i] = kNear * a + kFar * b;
  }
}

/// As widen().
PS_ANY_WIDTH void narrow_widen(const float* row, Narrow* to, std::int64_t w, std::int64_t c) {
  for (std::int64_t x = 0; x < w; ++x, row += c, to += 2 * c) {
    const float* const left = x > 0 ? row - c : row;
    const float* const right = x + 1 < w ? row + c : row;
    for (std::int64_t i = 0; i < c; ++i) to[i] = narrowed(kNear * row[i] + kFar * left[i]);
    for (std::int64_t i = 0; i < c; ++i) to[c + i] = narrowed(kNear * row[i] + kFar * right[i]);
  }
}

PS_ANY_WIDTH void mix_rows(const Narrow* a, const Narrow* b, const Narrow* d, const Narrow* e,
                           float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    to[i] = kNear * (widened(b[i]) + widened(d[i])) + kFar * (widened(a[i]) + widened(e[i]));
  }
}

PS_ANY_WIDTH void cut_off(const float* x, float* gradient, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) gradient[i] = chosen(x[i] <= 0, 0, gradient[i]);
}

class ReluUpsample : public torch::autograd::Function<ReluUpsample> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& image) {
    const Tensor x = channels_last(image);
    context->save_for_backward({x});
    const std::int64_t c = x.size(1), h = x.size(2), w = x.size(3), row = w * c;
    const Tensor out =
        torch::empty({x.size(0), c, 2 * h, 2 * w}, x.options().dtype(torch::kBFloat16),
                     torch::MemoryFormat::ChannelsLast);
    const float* const from = x.data_ptr<float>();
    auto* const to = static_cast<Narrow*>(out.data_ptr());
    at::parallel_for(0, x.size(0) * h, 1, [&](std::int64_t begin, std::int64_t end) {
      std::vector<float> mixed(static_cast<std::size_t>(row));
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t y = i % h;
        const float* const at = from + i * row;
        for (const std::int64_t below : {0, 1}) {
          const bool inside = below != 0 ? y + 1 < h : y > 0;
          const std::int64_t step = below != 0 ? row : -row;
          rectified_blend(at, inside ? at + step : at, mixed.data(), row);
          narrow_widen(mixed.data(), to + (2 * i + below) * 2 * row, w, c);
        }
      }
    });
    return out;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const Tensor x = context->get_saved_variables()[0], g = channels_last(gradients[0]);
    const std::int64_t c = x.size(1), h = x.size(2), w = x.size(3), row = 2 * w * c;
    const Tensor out = torch::empty_like(x);
    const auto* const from = static_cast<const Narrow*>(g.data_ptr());
    const float* const cut = x.data_ptr<float>();
    float* const to = out.data_ptr<float>();
    at::parallel_for(0, x.size(0) * h, 1, [&](std::int64_t begin, std::int64_t end) {
      std::vector<float> mixed(static_cast<std::size_t>(row));
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t y = i % h;
        const Narrow* const b = from + 2 * i * row;
        const Narrow* const d = b + row;
        mix_rows(y > 0 ? b - row : b, b, d, y + 1 < h ? d + row : d, mixed.data(), row);
        narrow(mixed.data(), to + i * w * c, w, c);
        cut_off(cut + i * w * c, to + i * w * c, w * c);
      }
    });
    return {out};
  }
};

}  // namespace

Tensor relu_upsample_2x(const Tensor& x) {
  if (!products_are_narrow() || !x.is_cpu() || x.scalar_type() != torch::kFloat32) {
    return as_factor(upsample_2x(torch::relu(x)));
  }
  return ReluUpsample::apply(x);
}

Tensor upsample_2x(const Tensor& x) {
  if (!x.is_cpu() || x.scalar_type() != torch::kFloat32) {
    return torch::upsample_bilinear2d(x, {2 * x.size(2), 2 * x.size(3)}, false);
  }
  return Upsample::apply(x);
}

}  // namespace ps::train
