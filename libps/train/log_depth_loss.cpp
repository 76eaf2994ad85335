// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/log_depth_loss.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <vector>

#include "libps/train/layout.h"
#include "libps/train/narrow.h"

namespace ps::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

constexpr float kForgiven = .7F;  ///< of a common factor
constexpr float kByGradient = .5F;
constexpr int kScales = 4, kLanes = 16;

/// A sum of absolute values and how many were added.
struct Sum {
  double sum = 0, count = 0;
  float mean() const { return static_cast<float>(sum / std::max(count, 1.)); }
  float share() const { return static_cast<float>(1 / std::max(count, 1.)); }
};

float sign_of(float x) { return static_cast<float>(x > 0) - static_cast<float>(x < 0); }

/// Adds up values(i), and counts(i), of 0 <= i < n, kLanes at a time.
template <class Values, class Counts>
inline Sum added(std::int64_t n, const Values& values, const Counts& counts) {
  float sums[kLanes] = {}, numbers[kLanes] = {};
  std::int64_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (int k = 0; k < kLanes; ++k) sums[k] += values(i + k);
    for (int k = 0; k < kLanes; ++k) numbers[k] += counts(i + k);
  }
  Sum all;
  for (; i < n; ++i) {
    all.sum += values(i);
    all.count += counts(i);
  }
  for (int k = 0; k < kLanes; ++k) {
    all.sum += sums[k];
    all.count += numbers[k];
  }
  return all;
}

PS_ANY_WIDTH Sum sum_errors(const float* error, const float* known, std::int64_t n) {
  return added(
      n, [&](std::int64_t i) { return error[i]; }, [&](std::int64_t i) { return known[i]; });
}

/// Sum of known |error - middle|, and, as its count, of their signs.
PS_ANY_WIDTH Sum sum_off(const float* error, const float* known, float middle, std::int64_t n) {
  return added(
      n,
      [&](std::int64_t i) {
        const float off = error[i] - middle;
        return known[i] * (off < 0 ? -off : off);
      },
      [&](std::int64_t i) { return known[i] * sign_of(error[i] - middle); });
}

PS_ANY_WIDTH void pull_off(const float* error, const float* known, float middle, float by,
                           float back, float* gradient, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    gradient[i] = known[i] * (by * sign_of(error[i] - middle) - back);
  }
}

/// Of pixels and those `step` further on.
PS_ANY_WIDTH Sum sum_steps(const float* error, const float* known, std::int64_t step,
                           std::int64_t n) {
  return added(
      n,
      [&](std::int64_t i) {
        const float d = error[i + step] - error[i];
        return known[i] * known[i + step] * (d < 0 ? -d : d);
      },
      [&](std::int64_t i) { return known[i] * known[i + step]; });
}

PS_ANY_WIDTH void pull_steps(const float* error, const float* known, std::int64_t step, float by,
                             float* pulls, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    pulls[i] = by * known[i] * known[i + step] * sign_of(error[i + step] - error[i]);
  }
}

PS_ANY_WIDTH void add_pulls(const float* pulls, float* from, float* to, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) from[i] -= pulls[i];
  for (std::int64_t i = 0; i < n; ++i) to[i] += pulls[i];
}

/// One example at one scale, rows one after another.
struct Level {
  std::int64_t w = 0, h = 0;
  std::vector<float> error, known, gradient;
};

/// Every other pixel of every other row.
Level halved(const Level& of) {
  Level level;
  level.w = (of.w + 1) / 2;
  level.h = (of.h + 1) / 2;
  const auto size = static_cast<std::size_t>(level.w * level.h);
  level.error.resize(size);
  level.known.resize(size);
  level.gradient.assign(size, 0);
  for (std::int64_t y = 0; y < level.h; ++y) {
    for (std::int64_t x = 0; x < level.w; ++x) {
      const auto to = static_cast<std::size_t>(y * level.w + x);
      const auto from = static_cast<std::size_t>(2 * y * of.w + 2 * x);
      level.error[to] = of.error[from];
      level.known[to] = of.known[from];
    }
  }
  return level;
}

void give_back(const Level& level, Level& to) {
  for (std::int64_t y = 0; y < level.h; ++y) {
    for (std::int64_t x = 0; x < level.w; ++x) {
      to.gradient[static_cast<std::size_t>(2 * y * to.w + 2 * x)] +=
          level.gradient[static_cast<std::size_t>(y * level.w + x)];
    }
  }
}

/// Runs of pixels that have a neighbour `step` further on: whole rows downwards, all but each
/// row's last pixel to the right.
template <class Body>
void over_runs(const Level& level, bool down, const Body& body) {
  if (down) return body(0, level.w, level.w * (level.h - 1));
  for (std::int64_t y = 0; y < level.h; ++y) body(y * level.w, 1, level.w - 1);
}

/// @return the loss of differences at this scale and the coarser ones; `weight` times its gradients
/// is added to the level's
float add_differences(Level& level, int scales, float weight) {
  float loss = 0;
  std::vector<float> pulls(level.error.size());
  for (const bool down : {false, true}) {
    Sum sum;
    over_runs(level, down, [&](std::int64_t at, std::int64_t step, std::int64_t n) {
      const Sum part = sum_steps(level.error.data() + at, level.known.data() + at, step, n);
      sum.sum += part.sum;
      sum.count += part.count;
    });
    over_runs(level, down, [&](std::int64_t at, std::int64_t step, std::int64_t n) {
      float* const gradient = level.gradient.data() + at;
      pull_steps(level.error.data() + at, level.known.data() + at, step, weight * sum.share(),
                 pulls.data(), n);
      add_pulls(pulls.data(), gradient, gradient + step, n);
    });
    loss += sum.mean();
  }
  if (scales > 1) {
    Level coarse = halved(level);
    loss += add_differences(coarse, scales - 1, weight);
    give_back(coarse, level);
  }
  return loss;
}

struct Losses {
  float value = 0, gradient = 0;
};

/// @param weight  of what is written to the level's gradient
Losses losses_of(Level& level, float weight) {
  const float* const error = level.error.data();
  const float* const known = level.known.data();
  const auto n = static_cast<std::int64_t>(level.error.size());
  const Sum all = sum_errors(error, known, n);
  const float middle = kForgiven * all.mean(), share = all.share();
  const Sum off = sum_off(error, known, middle, n);
  const float by = weight * share;
  pull_off(error, known, middle, by, by * kForgiven * share * static_cast<float>(off.count),
           level.gradient.data(), n);
  const float value = static_cast<float>(off.sum) * share;
  return {value, add_differences(level, kScales, weight * kByGradient)};
}

/// 0 where the truth is not known, whatever stands there.
Tensor errors_of(const Tensor& log_depth, const Tensor& log_truth, const Tensor& known) {
  return (log_depth - log_truth).masked_fill(known == 0, 0);
}

class Loss : public torch::autograd::Function<Loss> {
 public:
  static variable_list forward(AutogradContext* context, const Tensor& log_depth,
                               const Tensor& log_truth, const Tensor& known) {
    const Tensor mask = known.contiguous();
    const Tensor error = errors_of(log_depth.detach(), log_truth, mask).contiguous();
    const Tensor gradient = torch::empty_like(error);
    const std::int64_t n = error.size(0), size = error.size(2) * error.size(3);
    const Tensor parts = torch::zeros({n, 2});
    const float weight = 1 / static_cast<float>(n);
    at::parallel_for(0, n, 1, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) {
        const float* const e = error.data_ptr<float>() + i * size;
        const float* const m = mask.data_ptr<float>() + i * size;
        Level level{error.size(3), error.size(2), {e, e + size}, {m, m + size}, {}};
        level.gradient.resize(level.error.size());
        const Losses losses = losses_of(level, weight);
        std::copy(level.gradient.begin(), level.gradient.end(),
                  gradient.data_ptr<float>() + i * size);
        parts.data_ptr<float>()[2 * i] = losses.value;
        parts.data_ptr<float>()[2 * i + 1] = losses.gradient;
      }
    });
    context->save_for_backward({gradient});
    const Tensor means = parts.mean(0);
    const Tensor value = means[0].clone(), by_gradient = means[1].clone();
    context->mark_non_differentiable({value, by_gradient});
    return {value + kByGradient * by_gradient, value, by_gradient};
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    return {context->get_saved_variables()[0] * gradients[0], Tensor(), Tensor()};
  }
};

Tensor differences(Tensor error, Tensor mask) {
  Tensor sum = torch::zeros({error.size(0)}, error.options());
  using torch::indexing::None;
  using torch::indexing::Slice;
  for (int scale = 0; scale < kScales; ++scale) {
    for (const int axis : {2, 3}) {
      const auto n = error.size(axis) - 1;
      const Tensor d = error.narrow(axis, 1, n) - error.narrow(axis, 0, n);
      sum = sum + masked_mean(d.abs(), mask.narrow(axis, 1, n) * mask.narrow(axis, 0, n));
    }
    const Slice every_other(None, None, 2);
    error = error.index({Slice(), Slice(), every_other, every_other});
    mask = mask.index({Slice(), Slice(), every_other, every_other});
  }
  return sum;
}

}  // namespace

Tensor masked_mean(const Tensor& values, const Tensor& mask) {
  return (values * mask).sum({1, 2, 3}) / mask.sum({1, 2, 3}).clamp_min(1);
}

LogDepthLoss log_depth_loss_by_operators(const Tensor& log_depth, const Tensor& log_truth,
                                         const Tensor& known) {
  const Tensor error = errors_of(log_depth, log_truth, known);
  const Tensor common = masked_mean(error, known).view({-1, 1, 1, 1});
  const Tensor value = masked_mean((error - kForgiven * common).abs(), known).mean();
  const Tensor gradient = differences(error, known).mean();
  return {value + kByGradient * gradient, value.detach(), gradient.detach()};
}

LogDepthLoss log_depth_loss(const Tensor& log_depth, const Tensor& log_truth, const Tensor& known) {
  TORCH_CHECK(log_depth.sizes() == log_truth.sizes() && log_depth.sizes() == known.sizes() &&
                  log_depth.dim() == 4 && log_depth.size(1) == 1,
              "log depth, its truth and where it is known are not [n, 1, h, w]");
  if (!is_float_on_cpu(log_depth)) {
    return log_depth_loss_by_operators(log_depth, log_truth, known);
  }
  const variable_list all = Loss::apply(log_depth, log_truth, known);
  return {all[0], all[1], all[2]};
}

}  // namespace ps::train
