// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/stress_suite.h"

#include <algorithm>
#include <limits>

#include "libps/eval/cloud_metrics.h"
#include "libps/eval/image_metrics.h"
#include "libps/eval/statistics.h"
#include "libps/geometry/splat.h"
#include "libps/scene/closed_splat.h"
#include "libps/scene/stress_fusers.h"

namespace ps::stress {
namespace {

constexpr std::size_t kSamples = 10000;  ///< of a cloud, evenly spread, speak for it

double share_near(const Cloud& from, const Cloud& to) {
  if (from.empty() || to.empty()) return 0;
  Cloud some;
  const std::size_t step = std::max<std::size_t>(1, from.size() / kSamples);
  for (std::size_t i = 0; i < from.size(); i += step) some.push_back(from[i]);
  const std::vector<double> distances = nearest_distances(some, to);
  const auto near =
      std::count_if(distances.begin(), distances.end(), [](double d) { return d < kNearEnough; });
  return static_cast<double>(near) / static_cast<double>(some.size());
}

}  // namespace

SuiteOptions small_suite(std::uint64_t seed) {
  SuiteOptions options;
  options.seed = seed;
  return options;
}

SuiteOptions full_suite(std::uint64_t seed) {
  SuiteOptions options;
  options.seed = seed;
  options.rooms = 8;
  options.frames = 24;
  options.held_out = 6;
  options.photos = 8;
  options.samples = 8;
  options.size = {256, 192};
  options.dense = true;
  return options;
}

std::uint64_t room_seed(const SuiteOptions& options, int i) {
  return 9000 + draw_seed(options, static_cast<std::size_t>(i));
}

std::uint64_t draw_seed(const SuiteOptions& options, std::size_t i) {
  return 100 * options.seed + i;
}

Worlds make_worlds(const SuiteOptions& options) {
  return std::make_shared<Lazy<std::vector<World>>>([options] {
    std::vector<World> worlds;
    if (options.given) {
      for (const auto& walk : options.given->walks) {
        worlds.push_back(given_world(walk, options.size));
      }
      return worlds;
    }
    for (int i = 0; i < options.rooms; ++i) {
      worlds.push_back(
          make_world(room_seed(options, i), options.frames, options.held_out, options.size));
    }
    return worlds;
  });
}

std::vector<double> values_of(const SuiteOptions& options, std::vector<double> values) {
  if (!options.dense) return values;
  std::vector<double> dense = {values[0]};
  for (std::size_t i = 1; i < values.size(); ++i) {
    dense.push_back((values[i - 1] + values[i]) / 2);
    dense.push_back(values[i]);
  }
  return dense;
}

Image picture_of(const std::string& method, const Cloud& cloud, const View& truth) {
  SplatOptions options;
  options.renormalise = true;
  if (method == kOurs) {
    options.radius = kWidest;
    return closed_splat(cloud, truth.intrinsics, truth.world_from_cam, options, kDetail).color;
  }
  options.radius = kRadius;
  return splat(cloud, truth.intrinsics, truth.world_from_cam, options).color;
}

double psnr_of(const std::string& method, const Cloud& cloud, const World& world) {
  if (cloud.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> scores;
  for (std::size_t i = 0; i < world.held_out.size(); ++i) {
    const View& view = world.held_out[i];
    if (cv::countNonZero(world.covered[i]) == 0) continue;
    scores.push_back(psnr(picture_of(method, cloud, view), view.color, world.covered[i]));
  }
  return mean(scores);
}

double f_score_of(const Cloud& cloud, const Cloud& truth) {
  const double accuracy = share_near(cloud, truth), completeness = share_near(truth, cloud);
  const double sum = accuracy + completeness;
  return sum > 0 ? 200 * accuracy * completeness / sum : 0;
}

void note(const Cloud& cloud, Outcome* outcome) {
  outcome->finite = outcome->finite && finite(cloud);
  outcome->digest = outcome->digest * 31 + digest_of(cloud);
}

}  // namespace ps::stress
