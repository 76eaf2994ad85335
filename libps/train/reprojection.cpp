// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/reprojection.h"

#include <cmath>

namespace ps::train {
namespace {

constexpr double kNear = 0.05;                           ///< metres before the partner's camera
constexpr int kFinest = 2, kSizes = 3;                   ///< sides are divided by 2, 4, 8
constexpr double kSmoothness = 0.02, kHintWeight = 0.5;  ///< beside the photometric error's 1
constexpr int kHinted = 4, kPlanes = 24;  ///< sides of pictures that are swept are divided by
constexpr double kNearest = 0.4, kFarthest = 16;  ///< metres, of the planes
constexpr double kClear = 0.03;                   ///< errors that differ by less are the same
constexpr double kOutside = 10;                   ///< more than any error

/// One number of each example, to be spread over pictures.
Tensor each(const Tensor& table, std::int64_t column) {
  return table.select(1, column).view({-1, 1, 1, 1});
}

/// The lens of a picture that is k times smaller: cx' = (cx + 1/2) / k - 1/2.
Tensor shrunk(const Tensor& lens, int k) {
  return torch::cat({lens.narrow(1, 0, 2) / k, (lens.narrow(1, 2, 2) + .5) / k - .5}, 1);
}

Tensor mean_3x3(const Tensor& x) {
  return torch::avg_pool2d(x, 3, 1, 1, false, /*count_include_pad=*/false);
}

/// 1 - SSIM (Wang and others, 2004) with the constants of signals in [0,1].
Tensor dissimilarity(const Tensor& a, const Tensor& b) {
  constexpr double kC1 = .01 * .01, kC2 = .03 * .03;
  const Tensor mean_a = mean_3x3(a), mean_b = mean_3x3(b);
  const Tensor var_a = mean_3x3(a.square()) - mean_a.square();
  const Tensor var_b = mean_3x3(b.square()) - mean_b.square();
  const Tensor both = mean_3x3(a * b) - mean_a * mean_b;
  return 1 - (2 * mean_a * mean_b + kC1) * (2 * both + kC2) /
                 ((mean_a.square() + mean_b.square() + kC1) * (var_a + var_b + kC2));
}

/// Differences of neighbours of log depth, less where the picture's neighbours differ too.
Tensor roughness(const Tensor& depth, const Tensor& color) {
  Tensor sum = torch::zeros({depth.size(0)}, depth.options());
  const Tensor log = torch::log(depth);
  for (const int axis : {2, 3}) {
    const auto n = depth.size(axis) - 1;
    const auto steps = [&](const Tensor& x) {
      return (x.narrow(axis, 1, n) - x.narrow(axis, 0, n)).abs();
    };
    sum = sum + (steps(log) * torch::exp(-5 * steps(color).mean(1, true))).mean({1, 2, 3});
  }
  return sum;
}

/// A pair at one size: sides are divided by k.
struct Pair {
  Tensor view, partner, lens, partner_lens;
  const Tensor& partner_from_view;

  Pair(const Batch& batch, int k)
      : view(torch::avg_pool2d(batch.plain, k)),
        partner(torch::avg_pool2d(batch.partner, k)),
        lens(shrunk(batch.lens, k)),
        partner_lens(shrunk(batch.partner_lens, k)),
        partner_from_view(batch.partner_from_view) {}

  Warped at(const Tensor& metres) const {
    return warp(metres, partner, lens, partner_lens, partner_from_view);
  }
  /// Of each pixel's surroundings; much where it falls outside.
  Tensor error_at(const Tensor& metres) const {
    const Warped found = at(metres);
    return mean_3x3(mean_3x3(photometric_error(found.color, view))) + kOutside * (1 - found.inside);
  }
};

/// The depth of those on kPlanes planes that explains each pixel best, and how far the given depth
/// is from it where that one explains the pixel clearly worse (Watson and others, ICCV 2019,
/// equation 3, with a plane sweep for the hints). Gradients of pictures reach no further than their
/// edges are wide; this one reaches any distance.
Tensor hint_loss(const Pair& pair, const Tensor& metres) {
  Tensor hint, clear;
  {
    const torch::NoGradGuard guard;
    Tensor best = torch::full_like(metres, kOutside);
    hint = metres.detach().clone();
    for (int i = 0; i < kPlanes; ++i) {
      const double z = kNearest * std::pow(kFarthest / kNearest, i / (kPlanes - 1.0));
      const Tensor plane = torch::full_like(metres, z), error = pair.error_at(plane);
      hint = torch::where(error < best, plane, hint);
      best = torch::min(error, best);
    }
    clear = (best + kClear < pair.error_at(metres)).to(metres.dtype());
  }
  return ((torch::log(metres) - torch::log(hint)).abs() * clear).mean({1, 2, 3});
}

}  // namespace

Warped warp(const Tensor& depth, const Tensor& partner, const Tensor& lens,
            const Tensor& partner_lens, const Tensor& partner_from_view) {
  const std::int64_t h = depth.size(2), w = depth.size(3);
  const Tensor u = torch::arange(w, depth.options()).view({1, 1, 1, w});
  const Tensor v = torch::arange(h, depth.options()).view({1, 1, h, 1});
  const Tensor x = (u - each(lens, 2)) / each(lens, 0) * depth;
  const Tensor y = (v - each(lens, 3)) / each(lens, 1) * depth;
  const auto moved = [&](std::int64_t axis) {
    const Tensor row = partner_from_view.select(1, axis);
    return each(row, 0) * x + each(row, 1) * y + each(row, 2) * depth + each(row, 3);
  };
  const Tensor z = moved(2), before = z > kNear, safe = z.clamp_min(kNear);
  const Tensor pu = each(partner_lens, 0) * moved(0) / safe + each(partner_lens, 2);
  const Tensor pv = each(partner_lens, 1) * moved(1) / safe + each(partner_lens, 3);
  const auto within = [](const Tensor& at, std::int64_t size) {
    return (at >= 0).logical_and(at <= size - 1);
  };
  const Tensor inside = within(pu, w).logical_and(within(pv, h)).logical_and(before);
  // Pixel u is at (2u + 1) / w - 1 of the grid.
  const Tensor grid = torch::cat({(2 * pu + 1) / w - 1, (2 * pv + 1) / h - 1}, 1);
  constexpr int kBilinear = 0, kBorder = 1;
  return {torch::grid_sampler(partner, grid.permute({0, 2, 3, 1}), kBilinear, kBorder, false),
          inside.to(depth.dtype())};
}

Tensor photometric_error(const Tensor& a, const Tensor& b) {
  const Tensor x = (a + 1) / 2, y = (b + 1) / 2;
  constexpr double kSmooth = .01;
  const Tensor robust = ((x - y).square() + kSmooth * kSmooth).sqrt() - kSmooth;
  return (.15 * robust + .85 * (dissimilarity(x, y) / 2).clamp(0, 1)).mean(1, true);
}

Tensor reprojection_loss(const Batch& batch, const Tensor& depth) {
  const auto side = static_cast<double>(depth.size(3));
  const Tensor focal = (each(batch.lens, 0) * each(batch.lens, 1)).abs().sqrt() / side;
  // The mean of 1 / z is exact on planes.
  const Tensor nearness = (depth * focal).reciprocal();
  Tensor sum = torch::zeros({depth.size(0)}, depth.options());
  for (int k = kFinest; k < kFinest << kSizes; k *= 2) {
    const Pair pair(batch, k);
    const Tensor metres = torch::avg_pool2d(nearness, k).reciprocal();
    const Warped found = pair.at(metres);
    const Tensor error = photometric_error(found.color, pair.view) * found.inside;
    sum = sum + error.sum({1, 2, 3}) / found.inside.sum({1, 2, 3}).clamp_min(1) / kSizes;
    if (k == kHinted) sum = sum + kHintWeight * hint_loss(pair, metres);
  }
  return batch.posed * (sum + kSmoothness * roughness(depth, batch.plain));
}

}  // namespace ps::train
