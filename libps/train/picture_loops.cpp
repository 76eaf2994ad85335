// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/picture_loops.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libps/train/layout.h"
#include "libps/train/narrow.h"

namespace ps::train {
namespace {

using torch::Tensor;

constexpr float kDarkest = 1e-4F;
constexpr int kChannels = 3;

/// Where a pixel of the result lies along one axis.
struct Place {
  std::int64_t low, high;
  float by_high;
};

std::vector<Place> places(std::int64_t count, float scale, float shift, bool nearest) {
  const auto n = static_cast<float>(count);
  std::vector<Place> all;
  for (std::int64_t i = 0; i < count; ++i) {
    const float at = scale * ((2 * static_cast<float>(i) + 1) / n - 1) + shift;
    const float pixel = std::min(std::max(0.F, ((at + 1) * n - 1) / 2), n - 1);  // NaN is 0
    const float low = nearest ? std::nearbyint(pixel) : std::floor(pixel);
    const auto first = static_cast<std::int64_t>(low);
    all.push_back({first, std::min(first + 1, count - 1), nearest ? 0 : pixel - low});
  }
  return all;
}

PS_ANY_WIDTH void mix(const float* a, const float* b, float by_b, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) to[i] = a[i] + by_b * (b[i] - a[i]);
}

void spread(const float* row, const std::vector<Place>& xs, std::int64_t c, float* to) {
  for (const Place& x : xs) {
    const float* const a = row + x.low * c;
    const float* const b = row + x.high * c;
    for (std::int64_t i = 0; i < c; ++i) to[i] = a[i] + x.by_high * (b[i] - a[i]);
    to += c;
  }
}

void pick(const float* row, const std::vector<Place>& xs, std::int64_t c, float* to) {
  for (const Place& x : xs) to = std::copy_n(row + x.low * c, c, to);
}

/// From -1..1 to kDarkest..1.
PS_ANY_WIDTH void to_light(const float* from, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    const float x = (from[i] + 1) / 2;
    const float above = chosen(x < kDarkest, kDarkest, x);
    to[i] = chosen(above > 1, 1, above);
  }
}

/// Gains and saturation; adds up what comes out.
PS_ANY_WIDTH double saturate(float* x, const float* gains, float saturation, std::int64_t pixels) {
  float sums[kChannels] = {};
  for (std::int64_t p = 0; p < pixels; ++p, x += kChannels) {
    const float r = x[0] * gains[0], g = x[1] * gains[1], b = x[2] * gains[2];
    const float grey = (r + g + b) / 3;
    x[0] = grey + (r - grey) * saturation;
    x[1] = grey + (g - grey) * saturation;
    x[2] = grey + (b - grey) * saturation;
    for (int i = 0; i < kChannels; ++i) sums[i] += x[i];
  }
  return static_cast<double>(sums[0]) + sums[1] + sums[2];
}

PS_ANY_WIDTH void contrast_from(float* x, float mean, float contrast, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    const float y = mean + (x[i] - mean) * contrast;
    const float above = chosen(y < 0, 0, y);
    x[i] = chosen(above > 1, 1, above) * 2 - 1;
  }
}

}  // namespace

Tensor sampled_upright(const Tensor& image, const Tensor& theta, bool nearest) {
  if (!is_float_on_cpu(image)) {
    const Tensor grid =
        torch::nn::functional::affine_grid(theta.to(image.options()), image.sizes(), false);
    return channels_last(torch::grid_sampler(image, grid, nearest ? 1 : 0, 1, false));
  }
  TORCH_CHECK(theta.sizes() == torch::IntArrayRef({image.size(0), 2, 3}), "theta is not [n, 2, 3]");
  const Tensor x = channels_last(image);
  const Tensor out = torch::empty_like(x);
  const std::int64_t c = x.size(1), h = x.size(2), w = x.size(3), row = w * c;
  const Tensor maps = theta.to(torch::kFloat32).contiguous();
  at::parallel_for(0, x.size(0), 1, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> mixed(static_cast<std::size_t>(row));
    for (std::int64_t i = begin; i < end; ++i) {
      const float* const map = maps.data_ptr<float>() + 6 * i;
      const auto xs = places(w, map[0], map[2], nearest), ys = places(h, map[4], map[5], nearest);
      const float* const from = x.data_ptr<float>() + i * h * row;
      float* to = out.data_ptr<float>() + i * h * row;
      for (const Place& y : ys) {
        // The nearest is copied, as what is not finite would not stay where it is.
        const float* rows = from + y.low * row;
        if (!nearest) {
          mix(rows, from + y.high * row, y.by_high, mixed.data(), row);
          rows = mixed.data();
        }
        (nearest ? pick : spread)(rows, xs, c, to);
        to += row;
      }
    }
  });
  return out;
}

Tensor tinted_by_operators(const Tensor& color, const Tints& tints) {
  Tensor x = ((color + 1) / 2).clamp(kDarkest, 1);
  x = x.pow(tints.gamma) * tints.gain * tints.tint;
  const Tensor grey = x.mean(1, true);
  x = grey + (x - grey) * tints.saturation;
  const Tensor mean = x.mean({1, 2, 3}, true);
  x = mean + (x - mean) * tints.contrast;
  return channels_last(x.clamp_(0, 1).mul_(2).sub_(1));
}

Tensor tinted(const Tensor& color, const Tints& tints) {
  if (!is_float_on_cpu(color) || color.size(1) != kChannels)
    return tinted_by_operators(color, tints);
  const Tensor x = channels_last(color);
  const Tensor out = torch::empty_like(x);
  const std::int64_t row = x.size(3) * kChannels, size = x.size(2) * row;
  for (std::int64_t i = 0; i < x.size(0); ++i) {
    float* const to = out.data_ptr<float>() + i * size;
    to_light(x.data_ptr<float>() + i * size, to, size);
    out[i].pow_(tints.gamma[i].item<double>());
    const Tensor gains = (tints.gain[i] * tints.tint[i]).contiguous();
    const auto saturation = tints.saturation[i].item<float>();
    double sum = 0;
    for (std::int64_t y = 0; y < x.size(2); ++y) {
      sum += saturate(to + y * row, gains.data_ptr<float>(), saturation, x.size(3));
    }
    const auto mean = static_cast<float>(sum / static_cast<double>(size));
    contrast_from(to, mean, tints.contrast[i].item<float>(), size);
  }
  return out;
}

}  // namespace ps::train
