// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/elu_taps.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "libps/train/layers.h"
#include "libps/train/layout.h"
#include "libps/train/narrow.h"

namespace ps::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

/// Rows of x by number; zeros where the number is negative.
Tensor rows_of(const Tensor& x, const Tensor& index) {
  if (!x.is_cpu()) {
    const Tensor rows = x.index_select(0, index.clamp_min(0));
    return rows.masked_fill_((index < 0).unsqueeze(1), 0);
  }
  const Tensor out = torch::empty({index.size(0), x.size(1)}, x.options());
  const auto* const from = static_cast<const char*>(x.data_ptr());
  auto* const to = static_cast<char*>(out.data_ptr());
  const std::int64_t* const rows = index.data_ptr<std::int64_t>();
  const std::int64_t bytes = x.size(1) * static_cast<std::int64_t>(x.element_size());
  at::parallel_for(0, index.size(0), 2048, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      char* const row = to + i * bytes;
      if (rows[i] < 0) {
        std::memset(row, 0, static_cast<std::size_t>(bytes));
      } else {
        std::memcpy(row, from + rows[i] * bytes, static_cast<std::size_t>(bytes));
      }
    }
  });
  return out;
}

/// Of each kTaps rows by number their sum, in float; negative numbers count as zeros.
template <class T>
void sum_rows(const Tensor& x, const Tensor& index, const Tensor& sums) {
  const std::int64_t channels = x.size(1);
  const T* const from = x.data_ptr<T>();
  const std::int64_t* const rows = index.data_ptr<std::int64_t>();
  float* const to = sums.data_ptr<float>();
  at::parallel_for(0, sums.size(0), 512, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      float* const sum = to + i * channels;
      std::fill_n(sum, channels, 0.F);
      for (int tap = 0; tap < kTaps; ++tap) {
        const std::int64_t row = rows[i * kTaps + tap];
        if (row < 0) continue;
        const T* const summand = from + row * channels;
        for (std::int64_t c = 0; c < channels; ++c) sum[c] += static_cast<float>(summand[c]);
      }
    }
  });
}

Tensor summed_rows(const Tensor& x, const Tensor& index) {
  const std::int64_t cells = index.size(0) / kTaps, channels = x.size(1);
  if (!x.is_cpu()) {
    return rows_of(x, index).view({cells, kTaps, channels}).sum(1, false, torch::kFloat32);
  }
  const Tensor sums = torch::empty({cells, channels}, x.options().dtype(torch::kFloat32));
  if (x.scalar_type() == torch::kBFloat16) {
    sum_rows<at::BFloat16>(x, index, sums);
  } else {
    sum_rows<float>(x, index, sums);
  }
  return sums;
}

class GatherTaps : public torch::autograd::Function<GatherTaps> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& x,
                        const Tensor& from, const Tensor& to) {
    context->save_for_backward({to});
    return rows_of(as_factor(x).contiguous(), from).view({x.size(0), kTaps * x.size(1)});
  }
  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const Tensor to = context->get_saved_variables()[0];
    const Tensor gradient = gradients[0].contiguous();
    return {summed_rows(gradient.view({-1, gradient.size(1) / kTaps}), to), Tensor(), Tensor()};
  }
};

/// e^x of x <= 0, to a ten millionth of 1, in a form that becomes vectors: 2^n by its bits, times
/// a polynomial of what is left (Cephes' expf).
inline float exp_of_negative(float x) {
  const float bound = chosen(x < -87, -87, x);                  // NaN stays NaN,
  const float scaled = chosen(x >= -87, x, -87) * 1.44269504F;  // but is no whole number
  const auto n = static_cast<std::int32_t>(scaled - .5F);       // towards 0: the nearest one
  const auto whole = static_cast<float>(n);
  const float r = (bound - whole * .693359375F) + whole * 2.12194440e-4F;
  float p = 1.9875691500e-4F;
  p = p * r + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  const std::uint32_t bits = static_cast<std::uint32_t>(n + 127) << 23;
  float power;
  std::memcpy(&power, &bits, sizeof power);
  return (p * r * r + r + 1) * power;
}

PS_ANY_WIDTH void elu_both(const float* x, Narrow* to, std::int64_t cells, std::int64_t c) {
  for (std::int64_t i = 0; i < cells; ++i, x += c, to += 2 * c) {
    for (std::int64_t k = 0; k < c; ++k) {
      const float size = chosen(x[k] > 0, -x[k], x[k]);
      const float below = exp_of_negative(size) - 1;
      to[k] = narrowed(chosen(x[k] > 0, x[k], below));
      to[c + k] = narrowed(chosen(x[k] > 0, below, -x[k]));
    }
  }
}

/// @param gradient  [2 c] of one cell
PS_ANY_WIDTH void pass_back(const float* x, const float* gradient, float* to, std::int64_t c) {
  for (std::int64_t k = 0; k < c; ++k) {
    const float slope = exp_of_negative(chosen(x[k] > 0, -x[k], x[k]));
    const float a = gradient[k], b = gradient[c + k];
    to[k] = chosen(x[k] > 0, a - b * slope, a * slope - b);
  }
}

PS_ANY_WIDTH void add_narrow(const Narrow* from, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) to[i] += widened(from[i]);
}

/// elu_taps(), or concat_elu() where nothing is gathered.
class EluTaps : public torch::autograd::Function<EluTaps> {
 public:
  static Tensor forward(AutogradContext* context, const Tensor& image, const Tensor& from,
                        const Tensor& to, bool gathers) {
    const Tensor x = image.contiguous();
    context->save_for_backward({x, to});
    context->saved_data["gathers"] = gathers;
    const std::int64_t cells = x.size(0), c = x.size(1);
    const Tensor out = torch::empty({cells, 2 * c}, x.options().dtype(torch::kBFloat16));
    auto* const both = static_cast<Narrow*>(out.data_ptr());
    const float* const values = x.data_ptr<float>();
    at::parallel_for(0, cells, 512, [&](std::int64_t begin, std::int64_t end) {
      elu_both(values + begin * c, both + 2 * begin * c, end - begin, c);
    });
    return gathers ? rows_of(out, from).view({cells, 2 * kTaps * c}) : out;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const auto saved = context->get_saved_variables();
    const Tensor &x = saved[0], &to = saved[1];
    const Tensor gradient = gradients[0].contiguous();
    const std::int64_t cells = x.size(0), c = x.size(1);
    const Tensor out = torch::empty_like(x);
    const auto* const above = static_cast<const Narrow*>(gradient.data_ptr());
    const bool gathers = context->saved_data["gathers"].toBool();
    const std::int64_t* const index = gathers ? to.data_ptr<std::int64_t>() : nullptr;
    at::parallel_for(0, cells, 512, [&](std::int64_t begin, std::int64_t end) {
      std::vector<float> sum(static_cast<std::size_t>(2 * c));
      for (std::int64_t i = begin; i < end; ++i) {
        std::fill(sum.begin(), sum.end(), 0.F);
        for (int tap = 0; tap < (index != nullptr ? kTaps : 1); ++tap) {
          const std::int64_t row = index != nullptr ? index[i * kTaps + tap] : i;
          if (row >= 0) add_narrow(above + 2 * row * c, sum.data(), 2 * c);
        }
        pass_back(x.data_ptr<float>() + i * c, sum.data(), out.data_ptr<float>() + i * c, c);
      }
    });
    return {out, Tensor(), Tensor(), Tensor()};
  }
};

bool is_one_pass(const Tensor& x) { return products_are_narrow() && is_float_on_cpu(x); }

}  // namespace

Tensor gathered_taps(const Tensor& x, const Tensor& from, const Tensor& to) {
  return GatherTaps::apply(x, from, to);
}

Tensor concat_elu(const Tensor& x) {
  if (is_one_pass(x)) {
    const Tensor none = torch::empty({0}, torch::kInt64);
    return EluTaps::apply(x, none, none, false);
  }
  return as_factor(torch::elu(torch::cat({x, -x}, 1)));
}

Tensor elu_taps(const Tensor& x, const Tensor& from, const Tensor& to) {
  if (is_one_pass(x)) return EluTaps::apply(x, from, to, true);
  return gathered_taps(concat_elu(x), from, to);
}

}  // namespace ps::train
