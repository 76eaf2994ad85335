// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/upsample.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <vector>

#include "libps/train/layers.h"
#include "libps/train/layout.h"
#include "libps/train/narrow.h"

namespace ps::train {
namespace {

using torch::Tensor;

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
PS_ANY_WIDTH void gather_back(const float* row, float* to, std::int64_t w, std::int64_t c) {
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

Tensor empty_like_of(const Tensor& x, std::int64_t h, std::int64_t w) {
  return torch::empty({x.size(0), x.size(1), h, w}, x.options(), torch::MemoryFormat::ChannelsLast);
}

/// For each two rows of the output: blend(near row, far row, between, values), then
/// spread(between, row of the output, w, c).
template <class Value, class Blend, class Spread>
void for_row_pairs(const Tensor& x, Value* to, const Blend& blend, const Spread& spread) {
  const std::int64_t c = x.size(1), h = x.size(2), w = x.size(3), row = w * c;
  const auto* const from = static_cast<const Value*>(x.data_ptr());
  at::parallel_for(0, x.size(0) * h, 1, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> mixed(static_cast<std::size_t>(row));
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t y = i % h;
      const Value* const at = from + i * row;
      for (const std::int64_t below : {0, 1}) {
        const bool inside = below != 0 ? y + 1 < h : y > 0;
        const std::int64_t step = below != 0 ? row : -row;
        blend(at, inside ? at + step : at, mixed.data(), row);
        spread(mixed.data(), to + (2 * i + below) * 2 * row, w, c);
      }
    }
  });
}

/// The way back, for each row of the input: mix(the four rows of the gradient that it went to, from
/// above, between, values), then gather(between, number of the first value of the row).
template <class From, class Mix, class Gather>
void for_rows_back(const From* from, const Tensor& input, const Mix& mix, const Gather& gather) {
  const std::int64_t c = input.size(1), h = input.size(2), w = input.size(3), row = 2 * w * c;
  at::parallel_for(0, input.size(0) * h, 1, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> mixed(static_cast<std::size_t>(row));
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t y = i % h;
      const From* const b = from + 2 * i * row;
      const From* const d = b + row;
      mix(y > 0 ? b - row : b, b, d, y + 1 < h ? d + row : d, mixed.data(), row);
      gather(mixed.data(), i * w * c);
    }
  });
}

Tensor upsampled(const Tensor& image) {
  const Tensor x = channels_last(image);
  const Tensor out = empty_like_of(x, 2 * x.size(2), 2 * x.size(3));
  for_row_pairs(x, out.data_ptr<float>(), blend, widen);
  return out;
}

Tensor passed_back(const Tensor& gradient) {
  const Tensor g = channels_last(gradient);
  const Tensor out = empty_like_of(g, g.size(2) / 2, g.size(3) / 2);
  float* const to = out.data_ptr<float>();
  const auto mix = [](const float* a, const float* b, const float* d, const float* e, float* mixed,
                      std::int64_t n) {
    for (std::int64_t k = 0; k < n; ++k) mixed[k] = kNear * (b[k] + d[k]) + kFar * (a[k] + e[k]);
  };
  for_rows_back(g.data_ptr<float>(), out, mix, [&](const float* mixed, std::int64_t first) {
    gather_back(mixed, to + first, out.size(3), out.size(1));
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
PS_ANY_WIDTH void rectified_blend(const Narrow* near, const Narrow* far, float* to,
                                  std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    const float a = widened(near[i]), b = widened(far[i]);
    to[i] = kNear * chosen(a < 0, 0, a) + kFar * chosen(b < 0, 0, b);
  }
}

/// As widen().
PS_ANY_WIDTH void widen_to_narrow(const float* row, Narrow* to, std::int64_t w, std::int64_t c) {
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

/// As gather_back(), where x was above 0.
PS_ANY_WIDTH void gather_rectified(const float* row, const Narrow* x, Narrow* to, std::int64_t w,
                                   std::int64_t c) {
  const std::int64_t last = 2 * w - 1;
  for (std::int64_t p = 0; p < w; ++p, x += c, to += c) {
    const float* const a = row + std::max<std::int64_t>(2 * p - 1, 0) * c;
    const float* const b = row + 2 * p * c;
    const float* const d = row + (2 * p + 1) * c;
    const float* const e = row + std::min(2 * p + 2, last) * c;
    for (std::int64_t i = 0; i < c; ++i) {
      const float sum = kNear * (b[i] + d[i]) + kFar * (a[i] + e[i]);
      to[i] = narrowed(chosen(widened(x[i]) <= 0, 0, sum));
    }
  }
}

class ReluUpsample : public torch::autograd::Function<ReluUpsample> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& image) {
    const Tensor x = channels_last(image);
    context->save_for_backward({x});
    const Tensor out = empty_like_of(x, 2 * x.size(2), 2 * x.size(3));
    for_row_pairs(x, static_cast<Narrow*>(out.data_ptr()), rectified_blend, widen_to_narrow);
    return out;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const Tensor x = context->get_saved_variables()[0], g = channels_last(gradients[0]);
    const Tensor out = torch::empty_like(x);
    const auto* const from = static_cast<const Narrow*>(x.data_ptr());
    auto* const to = static_cast<Narrow*>(out.data_ptr());
    const auto gather = [&](const float* mixed, std::int64_t first) {
      gather_rectified(mixed, from + first, to + first, x.size(3), x.size(1));
    };
    for_rows_back(static_cast<const Narrow*>(g.data_ptr()), x, mix_rows, gather);
    return {out};
  }
};

}  // namespace

Tensor relu_upsample_2x(const Tensor& x) {
  if (!is_narrow_on_cpu(x)) {
    return as_factor(upsample_2x(torch::relu(x)));
  }
  return ReluUpsample::apply(x);
}

Tensor upsample_2x(const Tensor& x) {
  if (!is_float_on_cpu(x)) {
    return torch::upsample_bilinear2d(x, {2 * x.size(2), 2 * x.size(3)}, false);
  }
  return Upsample::apply(x);
}

}  // namespace ps::train
