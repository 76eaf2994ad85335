// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/upsampled_sum.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <vector>

#include "libps/train/layers.h"
#include "libps/train/layout.h"
#include "libps/train/narrow.h"
#include "libps/train/upsample.h"

namespace ps::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

constexpr int kSide = 3, kMaps = kSide * kSide;

/// The two rows of h that make row y of 2 h.
struct Pair {
  std::int64_t near, far;
};

Pair pair_of(std::int64_t y, std::int64_t h) {
  const std::int64_t near = y / 2, far = y % 2 == 0 ? near - 1 : near + 1;
  return {near, std::clamp<std::int64_t>(far, 0, h - 1)};
}

PS_ANY_WIDTH void add_blend(const float* near, const float* far, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) to[i] += kNear * near[i] + kFar * far[i];
}

PS_ANY_WIDTH void add_times(const float* from, float by, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) to[i] += by * from[i];
}

/// A row of w to one of 2 w; to has a 0 before it and one after.
void widen(const float* row, float* to, std::int64_t w) {
  for (std::int64_t x = 0; x < w; ++x) {
    const float left = row[std::max<std::int64_t>(x - 1, 0)], right = row[std::min(x + 1, w - 1)];
    to[2 * x] = kNear * row[x] + kFar * left;
    to[2 * x + 1] = kNear * row[x] + kFar * right;
  }
}

/// What widen() passes back.
void narrow_back(const float* gradient, float* to, std::int64_t w) {
  const std::int64_t last = 2 * w - 1;
  for (std::int64_t x = 0; x < w; ++x) {
    const float left = gradient[std::max<std::int64_t>(2 * x - 1, 0)];
    const float right = gradient[std::min(2 * x + 2, last)];
    to[x] = kNear * (gradient[2 * x] + gradient[2 * x + 1]) + kFar * (left + right);
  }
}

void to_planes(const Narrow* pixels, float* planes, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) {
    for (int k = 0; k < kMaps; ++k) planes[k * count + i] = widened(pixels[kMaps * i + k]);
  }
}

void to_pixels(const float* planes, Narrow* pixels, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) {
    for (int k = 0; k < kMaps; ++k) pixels[kMaps * i + k] = narrowed(planes[k * count + i]);
  }
}

/// Calls body(row y of the result, row of 2 h that the tap row ky reads) where that is inside.
template <class Body>
void over_taps(std::int64_t h, const Body& body) {
  for (std::int64_t y = 0; y < 2 * h; ++y) {
    for (int ky = 0; ky < kSide; ++ky) {
      const std::int64_t from = y + ky - 1;
      if (from >= 0 && from < 2 * h) body(y, ky, pair_of(from, h));
    }
  }
}

/// @param planes  kMaps of h rows of w
/// @param out     2 h rows of 2 w
void sum_planes(const float* planes, float* out, std::int64_t h, std::int64_t w) {
  // For each tap across, what the three taps down add up to, before it is widened.
  std::vector<float> sums(static_cast<std::size_t>(2 * h * kSide * w));
  over_taps(h, [&](std::int64_t y, int ky, Pair rows) {
    for (int kx = 0; kx < kSide; ++kx) {
      const float* const plane = planes + (kSide * ky + kx) * h * w;
      add_blend(plane + rows.near * w, plane + rows.far * w, sums.data() + (y * kSide + kx) * w, w);
    }
  });
  std::vector<float> wide(static_cast<std::size_t>(2 * w + 2));
  std::fill(out, out + 4 * h * w, 0.F);
  for (std::int64_t y = 0; y < 2 * h; ++y) {
    for (int kx = 0; kx < kSide; ++kx) {
      widen(sums.data() + (y * kSide + kx) * w, wide.data() + 1, w);
      add_times(wide.data() + kx, 1, out + 2 * y * w, 2 * w);
    }
  }
}

void pass_to_planes(const float* gradient, float* planes, std::int64_t h, std::int64_t w) {
  std::vector<float> wide(static_cast<std::size_t>(2 * w + 2));
  std::vector<float> parts(static_cast<std::size_t>(2 * h * kSide * w));
  for (std::int64_t y = 0; y < 2 * h; ++y) {
    std::copy(gradient + 2 * y * w, gradient + 2 * (y + 1) * w, wide.data() + 1);
    for (int kx = 0; kx < kSide; ++kx) {
      // Tap kx of pixel x reads pixel x + kx - 1: that one is passed what x was.
      narrow_back(wide.data() + 2 - kx, parts.data() + (y * kSide + kx) * w, w);
    }
  }
  std::fill(planes, planes + kMaps * h * w, 0.F);
  over_taps(h, [&](std::int64_t y, int ky, Pair rows) {
    for (int kx = 0; kx < kSide; ++kx) {
      float* const plane = planes + (kSide * ky + kx) * h * w;
      const float* const part = parts.data() + (y * kSide + kx) * w;
      add_times(part, kNear, plane + rows.near * w, w);
      add_times(part, kFar, plane + rows.far * w, w);
    }
  });
}

template <class Body>
void over_pictures(std::int64_t n, std::int64_t values, const Body& body) {
  at::parallel_for(0, n, 1, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> planes(static_cast<std::size_t>(values));
    for (std::int64_t i = begin; i < end; ++i) body(i, planes.data());
  });
}

/// [n, 9, h, w] of bfloat16, each map shifted by its tap and upsampled: the sum, in float.
class UpsampledSum : public torch::autograd::Function<UpsampledSum> {
 public:
  static Tensor forward(AutogradContext*, const Tensor& maps) {
    const Tensor x = channels_last(maps);
    const std::int64_t n = x.size(0), h = x.size(2), w = x.size(3);
    const Tensor out = torch::empty({n, 1, 2 * h, 2 * w}, x.options().dtype(torch::kFloat32));
    const auto* const from = static_cast<const Narrow*>(x.data_ptr());
    float* const to = out.data_ptr<float>();
    over_pictures(n, kMaps * h * w, [&](std::int64_t i, float* planes) {
      to_planes(from + i * kMaps * h * w, planes, h * w);
      sum_planes(planes, to + i * 4 * h * w, h, w);
    });
    return out;
  }

  static variable_list backward(AutogradContext*, variable_list gradients) {
    const Tensor gradient = gradients[0].contiguous();
    const std::int64_t n = gradient.size(0), h = gradient.size(2) / 2, w = gradient.size(3) / 2;
    const Tensor out = torch::empty({n, kMaps, h, w}, gradient.options().dtype(torch::kBFloat16),
                                    torch::MemoryFormat::ChannelsLast);
    const float* const from = gradient.data_ptr<float>();
    auto* const to = static_cast<Narrow*>(out.data_ptr());
    over_pictures(n, kMaps * h * w, [&](std::int64_t i, float* planes) {
      pass_to_planes(from + i * 4 * h * w, planes, h, w);
      to_pixels(planes, to + i * kMaps * h * w, h * w);
    });
    return {out};
  }
};

}  // namespace

Tensor relu_upsample_to_one(const Tensor& x, const Tensor& weight, const Tensor& bias) {
  if (!is_narrow_on_cpu(x)) {
    return conv2d(relu_upsample_2x(x).to(weight.scalar_type()), weight, bias, 1, 1);
  }
  const Tensor by_tap = weight.reshape({weight.size(1), kMaps}).t().reshape({kMaps, -1, 1, 1});
  const Tensor maps = torch::conv2d(torch::relu(x), by_tap.to(torch::kBFloat16));
  return UpsampledSum::apply(maps) + bias.view({1, 1, 1, 1});
}

}  // namespace ps::train
