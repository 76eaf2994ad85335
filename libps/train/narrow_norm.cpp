// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/narrow_norm.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libps/train/layers.h"
#include "libps/train/layout.h"
#include "libps/train/leaky.h"
#include "libps/train/narrow.h"

namespace ps::train {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

constexpr double kEpsilon = 1e-5, kMomentum = .1;
constexpr std::int64_t kBlock = 64;    ///< pixels summed in float
constexpr std::int64_t kChunk = 1024;  ///< pixels whose sums are one thread's

const Narrow* bits_of(const Tensor& x) { return static_cast<const Narrow*>(x.data_ptr()); }

/// Of each channel: x -> by * x + add, times the slope where that is below 0.
struct Scale {
  const float* by;
  const float* add;
  float slope;
};

/// Adds up x less a pixel's, and its squares, over pixels of c channels.
PS_ANY_WIDTH void add_squares(const Narrow* x, const Narrow* pivot, std::int64_t pixels,
                              std::int64_t c, float* sum, float* squares) {
  for (std::int64_t p = 0; p < pixels; ++p, x += c) {
    for (std::int64_t i = 0; i < c; ++i) {
      const float value = widened(x[i]) - widened(pivot[i]);
      sum[i] += value;
      squares[i] += value * value;
    }
  }
}

/// What scale() makes of a value, before it is narrowed and what is below 0 is multiplied.
inline float scaled(Narrow x, float by, float add) { return widened(x) * by + add; }

/// Adds up gradients, and gradients times x less its mean.
PS_ANY_WIDTH void add_products(const Narrow* x, const Narrow* gradient, const Scale& s,
                               const float* mean, std::int64_t pixels, std::int64_t c, float* sum,
                               float* products) {
  for (std::int64_t p = 0; p < pixels; ++p, x += c, gradient += c) {
    for (std::int64_t i = 0; i < c; ++i) {
      const float above = widened(gradient[i]);
      const float g = chosen(scaled(x[i], s.by[i], s.add[i]) > 0, above, above * s.slope);
      sum[i] += g;
      products[i] += g * (widened(x[i]) - mean[i]);
    }
  }
}

PS_ANY_WIDTH void scale(const Narrow* x, const Scale& s, Narrow* to, std::int64_t pixels,
                        std::int64_t c) {
  for (std::int64_t p = 0; p < pixels; ++p, x += c, to += c) {
    for (std::int64_t i = 0; i < c; ++i) {
      const float value = scaled(x[i], s.by[i], s.add[i]);
      to[i] = narrowed(chosen(value > 0, value, value * s.slope));
    }
  }
}

/// @param by_x, add  what the gradients' sums make of x and of 1
PS_ANY_WIDTH void scale_back(const Narrow* x, const Narrow* gradient, const Scale& s,
                             const float* by_x, const float* add, Narrow* to, std::int64_t pixels,
                             std::int64_t c) {
  for (std::int64_t p = 0; p < pixels; ++p, x += c, gradient += c, to += c) {
    for (std::int64_t i = 0; i < c; ++i) {
      const float above = widened(gradient[i]);
      const float g = chosen(scaled(x[i], s.by[i], s.add[i]) > 0, above, above * s.slope);
      to[i] = narrowed(g * s.by[i] + widened(x[i]) * by_x[i] + add[i]);
    }
  }
}

/// Two sums for each channel: add(first pixel, pixels, float sums, float sums) adds to them. The
/// order of the sums does not depend on the threads.
template <class Add>
std::vector<double> two_sums(std::int64_t pixels, std::int64_t c, const Add& add) {
  const std::int64_t chunks = (pixels + kChunk - 1) / kChunk, width = 2 * c;
  std::vector<double> parts(static_cast<std::size_t>(chunks * width));
  at::parallel_for(0, chunks, 1, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> block(static_cast<std::size_t>(width));
    for (std::int64_t chunk = begin; chunk < end; ++chunk) {
      const std::int64_t last = std::min(pixels, (chunk + 1) * kChunk);
      double* const part = parts.data() + chunk * width;
      for (std::int64_t p = chunk * kChunk; p < last; p += kBlock) {
        std::fill(block.begin(), block.end(), 0.F);
        add(p, std::min(kBlock, last - p), block.data(), block.data() + c);
        for (std::int64_t i = 0; i < width; ++i) part[i] += block[static_cast<std::size_t>(i)];
      }
    }
  });
  std::vector<double> sums(static_cast<std::size_t>(width));
  for (std::size_t i = 0; i < parts.size(); ++i) sums[i % sums.size()] += parts[i];
  return sums;
}

template <class Body>
void over_pixels(std::int64_t pixels, const Body& body) {
  at::parallel_for(0, pixels, kChunk, body);
}

void move(const Tensor& running, const Tensor& to) { running.lerp_(to, kMomentum); }

class NarrowNorm : public torch::autograd::Function<NarrowNorm> {
 public:
  static Tensor forward(AutogradContext* context, const Tensor& image, const Tensor& weight,
                        const Tensor& bias, const Tensor& running_mean, const Tensor& running_var,
                        double slope) {
    const Tensor x = channels_last(image);
    const std::int64_t c = x.size(1), pixels = x.numel() / c;
    const Narrow* const from = bits_of(x);
    const auto sums = two_sums(pixels, c, [&](std::int64_t p, std::int64_t n, float* a, float* b) {
      add_squares(from + p * c, from, n, c, a, b);
    });
    const auto moments = torch::tensor(sums, torch::kFloat64).view({2, c}) / pixels;
    // Squares of differences from the first pixel: of large means little would be left.
    const Tensor pivot = x.permute({0, 2, 3, 1}).reshape({pixels, c})[0].to(torch::kFloat64);
    const Tensor mean = moments[0] + pivot;
    const Tensor var = (moments[1] - moments[0].square()).clamp_min(0);
    const double unbiased = static_cast<double>(pixels) / std::max<double>(1, pixels - 1.);
    move(running_mean, mean.to(torch::kFloat32));
    move(running_var, (var * unbiased).to(torch::kFloat32));
    const Tensor root = (var + kEpsilon).rsqrt();
    const Tensor by = weight.detach() * root.to(torch::kFloat32);
    const Tensor add = bias.detach() - mean.to(torch::kFloat32) * by;
    context->save_for_backward({x, by, add, mean.to(torch::kFloat32), root.to(torch::kFloat32)});
    context->saved_data["slope"] = slope;
    const Scale scales{by.data_ptr<float>(), add.data_ptr<float>(), static_cast<float>(slope)};
    const Tensor out = torch::empty_like(x);
    auto* const to = static_cast<Narrow*>(out.data_ptr());
    over_pixels(pixels, [&](std::int64_t begin, std::int64_t end) {
      scale(from + begin * c, scales, to + begin * c, end - begin, c);
    });
    return out;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const auto saved = context->get_saved_variables();
    const Tensor &x = saved[0], &by = saved[1], &mean = saved[3], &root = saved[4];
    const Scale scales{by.data_ptr<float>(), saved[2].data_ptr<float>(),
                       static_cast<float>(context->saved_data["slope"].toDouble())};
    const Tensor gradient = channels_last(gradients[0]);
    const std::int64_t c = x.size(1), pixels = x.numel() / c;
    const Narrow* const from = bits_of(x);
    const Narrow* const above = bits_of(gradient);
    const auto sums = two_sums(pixels, c, [&](std::int64_t p, std::int64_t n, float* a, float* b) {
      add_products(from + p * c, above + p * c, scales, mean.data_ptr<float>(), n, c, a, b);
    });
    const auto both = torch::tensor(sums, torch::kFloat64).view({2, c}).to(torch::kFloat32);
    const Tensor by_weight = both[1] * root, by_bias = both[0];
    const Tensor by_x = -by * root * by_weight / pixels;
    const Tensor add = -by * by_bias / pixels - by_x * mean;
    const Tensor out = torch::empty_like(x);
    auto* const to = static_cast<Narrow*>(out.data_ptr());
    over_pixels(pixels, [&, by_x = by_x.data_ptr<float>(), add = add.data_ptr<float>()](
                            std::int64_t begin, std::int64_t end) {
      scale_back(from + begin * c, above + begin * c, scales, by_x, add, to + begin * c,
                 end - begin, c);
    });
    return {out, by_weight, by_bias, Tensor(), Tensor(), Tensor()};
  }
};

}  // namespace

Tensor narrow_batch_norm(const Tensor& x, const Tensor& weight, const Tensor& bias,
                         const Tensor& running_mean, const Tensor& running_var, float slope) {
  TORCH_CHECK(is_narrow_on_cpu(x), "not of bfloat16 on the CPU");
  return NarrowNorm::apply(x, weight, bias, running_mean, running_var, static_cast<double>(slope));
}

Tensor normed_convolution(const Parameters& p, const std::string& name, const std::string& norm,
                          const Tensor& x, int stride, int padding, float slope, bool training) {
  const auto sloping = [&](const Tensor& y) { return slope == 1 ? y : leaky(y, slope); };
  if (!training || !products_are_narrow() || !x.is_cpu()) {
    const Tensor wide = convolution(p, name, x, stride, padding);
    return sloping(norm.empty() ? wide : batch_norm(p, norm, wide, training));
  }
  const Tensor product = torch::conv2d(as_factor(x), as_factor(p[name + ".weight"]),
                                       as_factor(p[name + ".bias"]), stride, padding);
  if (norm.empty()) return sloping(product);
  return narrow_batch_norm(product, p[norm + ".weight"], p[norm + ".bias"],
                           p[norm + ".running_mean"], p[norm + ".running_var"], slope);
}

}  // namespace ps::train
