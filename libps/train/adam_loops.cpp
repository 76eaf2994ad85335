// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/adam_loops.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libps/train/narrow.h"

namespace ps::train {
namespace {

using torch::Tensor;

constexpr std::int64_t kAtOnce = 1 << 14;
constexpr int kLanes = 16;

PS_ANY_WIDTH void move(const float* gradient, float* value, float* first, float* second,
                       float* average, std::int64_t n, const AdamRates& r) {
  for (std::int64_t i = 0; i < n; ++i) {
    const float g = gradient[i] * r.gradient;
    const float m = first[i] + (1 - r.beta1) * (g - first[i]);
    const float v = r.beta2 * second[i] + (1 - r.beta2) * g * g;
    const float moved = r.shrink * value[i] - r.rate * m / (std::sqrt(v * r.correction) + r.eps);
    first[i] = m;
    second[i] = v;
    value[i] = moved;
    average[i] += r.to_average * (moved - average[i]);
  }
}

PS_ANY_WIDTH double squares_of(const float* x, std::int64_t n) {
  float lanes[kLanes] = {};
  std::int64_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (int k = 0; k < kLanes; ++k) lanes[k] += x[i + k] * x[i + k];
  }
  double sum = 0;
  for (; i < n; ++i) sum += static_cast<double>(x[i]) * x[i];
  for (const float lane : lanes) sum += lane;
  return sum;
}

bool is_dense_float(const Tensor& x) {
  return x.is_cpu() && x.scalar_type() == torch::kFloat32 && x.is_non_overlapping_and_dense();
}

/// Whether values that belong together stand at the same places in memory.
bool are_alike(const std::vector<Tensor>& tensors) {
  return std::all_of(tensors.begin(), tensors.end(), [&](const Tensor& x) {
    return is_dense_float(x) && x.strides() == tensors.front().strides();
  });
}

}  // namespace

void move_along_by_operators(const Tensor& gradient, const Tensor& value, const Tensor& first,
                             const Tensor& second, const Tensor& average, const AdamRates& r) {
  const Tensor g = gradient * r.gradient;
  first.lerp_(g, 1 - r.beta1);
  second.mul_(r.beta2).addcmul_(g, g, 1 - r.beta2);
  value.mul_(r.shrink).addcdiv_(first, (second * r.correction).sqrt_().add_(r.eps), -r.rate);
  average.lerp_(value, r.to_average);
}

void move_along(const Tensor& gradient, const Tensor& value, const Tensor& first,
                const Tensor& second, const Tensor& average, const AdamRates& rates) {
  Tensor placed = gradient;
  if (is_dense_float(value) && is_dense_float(gradient) && !are_alike({value, gradient})) {
    placed = torch::empty_like(value).copy_(gradient);
  }
  if (!are_alike({value, placed, first, second, average})) {
    return move_along_by_operators(gradient, value, first, second, average, rates);
  }
  const float* const g = placed.data_ptr<float>();
  float* const to[] = {value.data_ptr<float>(), first.data_ptr<float>(), second.data_ptr<float>(),
                       average.data_ptr<float>()};
  at::parallel_for(0, value.numel(), kAtOnce, [&](std::int64_t begin, std::int64_t end) {
    move(g + begin, to[0] + begin, to[1] + begin, to[2] + begin, to[3] + begin, end - begin, rates);
  });
}

double sum_of_squares(const Tensor& x) {
  if (!is_dense_float(x)) return x.to(torch::kFloat64).square().sum().item<double>();
  const float* const from = x.data_ptr<float>();
  const std::int64_t n = x.numel(), chunks = (n + kAtOnce - 1) / kAtOnce;
  std::vector<double> sums(static_cast<std::size_t>(chunks));
  at::parallel_for(0, chunks, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t first = i * kAtOnce;
      sums[static_cast<std::size_t>(i)] = squares_of(from + first, std::min(kAtOnce, n - first));
    }
  });
  double sum = 0;
  for (const double part : sums) sum += part;
  return sum;
}

}  // namespace ps::train
