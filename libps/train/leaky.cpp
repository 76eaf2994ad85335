// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/leaky.h"

#include <ATen/Parallel.h>

#include "libps/train/layout.h"
#include "libps/train/narrow.h"

namespace ps::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

constexpr std::int64_t kAtOnce = 1 << 15;

PS_ANY_WIDTH void forwards(const Narrow* x, Narrow* to, std::int64_t n, float slope) {
  for (std::int64_t i = 0; i < n; ++i) {
    const float value = widened(x[i]);
    to[i] = narrowed(chosen(value > 0, value, value * slope));
  }
}

PS_ANY_WIDTH void backwards(const Narrow* x, const Narrow* gradient, Narrow* to, std::int64_t n,
                            float slope) {
  for (std::int64_t i = 0; i < n; ++i) {
    const float g = widened(gradient[i]);
    to[i] = narrowed(chosen(widened(x[i]) > 0, g, g * slope));
  }
}

class Leaky : public torch::autograd::Function<Leaky> {
 public:
  static Tensor forward(AutogradContext* context, const Tensor& image, double slope) {
    const Tensor x = channels_last(image);
    context->save_for_backward({x});
    context->saved_data["slope"] = slope;
    const Tensor out = torch::empty_like(x);
    const auto* const from = static_cast<const Narrow*>(x.data_ptr());
    auto* const to = static_cast<Narrow*>(out.data_ptr());
    at::parallel_for(0, x.numel(), kAtOnce, [&](std::int64_t begin, std::int64_t end) {
      forwards(from + begin, to + begin, end - begin, static_cast<float>(slope));
    });
    return out;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const Tensor x = context->get_saved_variables()[0];
    const auto slope = static_cast<float>(context->saved_data["slope"].toDouble());
    const Tensor gradient = channels_last(gradients[0]);
    const Tensor out = torch::empty_like(x);
    const auto* const from = static_cast<const Narrow*>(x.data_ptr());
    const auto* const above = static_cast<const Narrow*>(gradient.data_ptr());
    auto* const to = static_cast<Narrow*>(out.data_ptr());
    at::parallel_for(0, x.numel(), kAtOnce, [&](std::int64_t begin, std::int64_t end) {
      backwards(from + begin, above + begin, to + begin, end - begin, slope);
    });
    return {out, Tensor()};
  }
};

}  // namespace

Tensor leaky(const Tensor& x, float slope) {
  if (!is_narrow_on_cpu(x)) return torch::leaky_relu(x, slope);
  return Leaky::apply(x, static_cast<double>(slope));
}

}  // namespace ps::train
