// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/augmentation.h"

#include <vector>

#include "libps/train/picture_loops.h"

namespace ps::train {
namespace {

Tensor uniform(std::int64_t n, double low, double high, torch::Generator& generator) {
  return torch::rand({n}, generator) * (high - low) + low;
}

void jitter(Tensor& color, torch::Generator& generator) {
  const std::int64_t n = color.size(0);
  const auto each = [&](double low, double high) {
    return uniform(n, low, high, generator).view({n, 1, 1, 1}).to(color.device());
  };
  Tints tints;
  tints.gamma = torch::exp(each(-.35, .35));
  tints.gain = torch::exp(each(-.3, .3));
  tints.tint = torch::exp(torch::randn({n, 3, 1, 1}, generator).mul_(.06)).to(color.device());
  tints.saturation = each(.5, 1.4);
  tints.contrast = each(.75, 1.25);
  color = tinted(color, tints);
}

/// The lens of what a picture is after a grid of theta is sampled from it. A mirrored picture's fx
/// is below 0: lifting and projecting then hold as they are.
Tensor resampled(const Tensor& lens, const Tensor& theta, std::int64_t side) {
  std::vector<Tensor> focal, centre;
  const auto s = static_cast<double>(side);
  for (const int axis : {0, 1}) {
    const Tensor scale = theta.select(1, axis).select(1, axis),
                 shift = theta.select(1, axis).select(1, 2);
    // Pixel u is at (2u + 1) / s - 1 of the grid; there, old = scale * new + shift.
    const Tensor old = (2 * lens.select(1, 2 + axis) + 1) / s - 1;
    focal.push_back(lens.select(1, axis) / scale);
    centre.push_back((((old - shift) / scale + 1) * s - 1) / 2);
  }
  return torch::stack({focal[0], focal[1], centre[0], centre[1]}, 1);
}

void crop_and_mirror(Batch& batch, const Augmentation& how, torch::Generator& generator) {
  const std::int64_t n = batch.color.size(0);
  const Tensor share = how.crop ? uniform(n, .6, 1, generator) : torch::ones({n});
  const Tensor flip = how.mirror ? (torch::rand({n}, generator) < .5).to(torch::kFloat32) * -2 + 1
                                 : torch::ones({n});
  const Tensor theta = torch::zeros({n, 2, 3});
  theta.select(1, 0).select(1, 0).copy_(share * flip);
  theta.select(1, 1).select(1, 1).copy_(share);
  theta.select(1, 0).select(1, 2).copy_((1 - share) * uniform(n, -1, 1, generator));
  theta.select(1, 1).select(1, 2).copy_((1 - share) * uniform(n, -1, 1, generator));
  if (batch.lens.defined()) {
    batch.lens = resampled(batch.lens, theta.to(batch.lens.device()), batch.color.size(3));
  }
  batch.color = sampled_upright(batch.color, theta, false);
  if (batch.depth.defined()) {
    // The crop's focal length is longer by 1 / share, so canonical depth is shorter.
    batch.depth = sampled_upright(batch.depth, theta, true) *
                  share.view({n, 1, 1, 1}).to(batch.color.device());
  }
}

}  // namespace

void augment(Batch& batch, const Augmentation& how, torch::Generator generator) {
  const torch::NoGradGuard guard;
  if (how.crop || how.mirror) crop_and_mirror(batch, how, generator);
  if (batch.plain.defined()) batch.plain = batch.color;
  if (how.jitter) jitter(batch.color, generator);
}

}  // namespace ps::train
