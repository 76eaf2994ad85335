// SPDX-License-Identifier: BSD-3-Clause
// bench_budget DIR: what thinning a cloud to the budget of its cameras costs in their pictures.
// Prints CSV: a line for each tolerance, and one for a voxel grid of as many points.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "io/rgbd_folder.h"
#include "libps/core/parallel.h"
#include "libps/eval/image_metrics.h"
#include "libps/scene/budget.h"
#include "libps/scene/closed_splat.h"
#include "libps/scene/fuse.h"

namespace ps {
namespace {

struct Options {
  std::string folder;
  std::size_t every = 12;
  std::size_t frames = std::numeric_limits<std::size_t>::max();
  bool accumulate = false;
  bool voxels = true;
  std::vector<double> tolerances = {0,    0.005, 0.01, 0.015, 0.02, 0.03,
                                    0.05, 0.07,  0.1,  0.15,  0.2,  1};
  BudgetOptions budget;
  int threads = 0;
};

/// A planned view whose photo is there.
struct Shot {
  PlannedView view;
  Image photo;
  Splat whole;  ///< of the whole cloud
  Mask known;   ///< where that hits and the photo's depth is known
};

Splat draw(const Cloud& cloud, const PlannedView& view) {
  SplatOptions options;
  options.renormalise = true;
  return closed_splat(cloud, view.intrinsics, view.world_from_cam, options);
}

/// Means of cubes: what pcl::VoxelGrid does, without its limit on their number.
Cloud voxel_grid(const Cloud& cloud, double leaf) {
  using Sum = Eigen::Matrix<double, 7, 1>;  // position, colour, count
  std::map<std::tuple<int, int, int>, Sum> cells;
  for (const Point& p : cloud) {
    const auto step = [&](float x) { return static_cast<int>(std::floor(x / leaf)); };
    Sum& sum = cells.try_emplace({step(p.x), step(p.y), step(p.z)}, Sum::Zero()).first->second;
    sum += (Sum() << p.x, p.y, p.z, p.r, p.g, p.b, 1).finished();
  }
  Cloud result;
  for (const auto& [key, sum] : cells) {
    const Sum mean = sum / sum[6];
    Point p;
    p.getVector3fMap() = mean.head<3>().cast<float>();
    p.r = static_cast<std::uint8_t>(std::lround(mean[3]));
    p.g = static_cast<std::uint8_t>(std::lround(mean[4]));
    p.b = static_cast<std::uint8_t>(std::lround(mean[5]));
    p.footprint = 1.5f * static_cast<float>(leaf);  // as wide as no gaps are left
    result.push_back(p);
  }
  return result;
}

/// @return the voxel grid of about so many points (within 1 %)
Cloud voxel_grid_of(const Cloud& cloud, std::size_t points) {
  double leaf = 0.01;
  Cloud result;
  for (int round = 0; round < 10; ++round) {
    result = voxel_grid(cloud, leaf);
    const double ratio = static_cast<double>(result.size()) / static_cast<double>(points);
    if (std::abs(ratio - 1) < 0.01) break;
    leaf *= std::sqrt(ratio);  // of a surface's cells
  }
  return result;
}

/// The cameras of the frames that make the cloud, and one between each two.
std::vector<Shot> planned_shots(const RgbdFolder& folder, const Cloud& cloud, const Options& o) {
  std::vector<Shot> shots;
  const std::size_t step = std::max<std::size_t>(1, o.every / 2);
  for (std::size_t i = 0; i < folder.frames.size(); i += step) {
    const View view = load_frame(folder, folder.frames[i]);
    Shot shot = {{view.intrinsics, view.world_from_cam}, view.color, {}, {}};
    shot.whole = draw(cloud, shot.view);
    shot.known = shot.whole.hit & (view.depth > 0);
    shots.push_back(shot);
  }
  return shots;
}

Cloud whole_cloud(const RgbdFolder& folder, const Options& o) {
  std::vector<RgbdFrame> frames;
  for (std::size_t i = 0; i < folder.frames.size(); i += o.every)
    frames.push_back(folder.frames[i]);
  if (!o.accumulate) {
    return fuse({frames.size(), [&](std::size_t i) { return load_frame(folder, frames[i]); }});
  }
  Cloud cloud;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    cloud += lift(load_frame(folder, frames[i]), static_cast<std::uint16_t>(i));
  }
  return cloud;
}

/// Means over the views; dB.
struct Scores {
  double whole = 0;   ///< PSNR against the whole cloud
  double worst = 99;  ///< of a view
  double photos = 0;  ///< PSNR against the photos
  double lost = 0;    ///< share of the pixels that only the whole cloud hits
};

Scores score(const Cloud& cloud, const std::vector<Shot>& shots) {
  Scores scores;
  const auto views = static_cast<double>(shots.size());
  for (const Shot& shot : shots) {
    const Splat picture = draw(cloud, shot.view);
    const double whole = std::fmin(99, psnr(picture.color, shot.whole.color, shot.known));
    scores.whole += whole / views;
    scores.worst = std::fmin(scores.worst, whole);
    scores.photos += psnr(picture.color, shot.photo, shot.known) / views;
    scores.lost += static_cast<double>(cv::countNonZero(shot.known & (picture.hit == 0))) /
                   cv::countNonZero(shot.known) / views;
  }
  return scores;
}

class Table {
 public:
  Table(const Cloud& cloud, const std::vector<Shot>& shots)
      : shots_(shots), points_(cloud.size()), photos_(score(cloud, shots).photos) {
    std::puts(
        "method,tolerance,points,share,psnr_whole,worst_whole,psnr_photos,change,lost,seconds");
    add("whole", 0, cloud, 0);
  }

  void add(const char* method, double tolerance, const Cloud& cloud, double seconds) const {
    const Scores s = score(cloud, shots_);
    std::printf("%s,%g,%zu,%.4f,%.2f,%.2f,%.3f,%+.3f,%.5f,%.2f\n", method, tolerance, cloud.size(),
                static_cast<double>(cloud.size()) / static_cast<double>(points_), s.whole, s.worst,
                s.photos, s.photos - photos_, s.lost, seconds);
    std::fflush(stdout);
  }

 private:
  const std::vector<Shot>& shots_;
  std::size_t points_;
  double photos_;
};

void run(const Options& o) {
  set_threads(o.threads);
  RgbdFolder folder = open_rgbd_folder(o.folder);
  folder.frames.resize(std::min(folder.frames.size(), o.frames));
  const Cloud cloud = whole_cloud(folder, o);
  const std::vector<Shot> shots = planned_shots(folder, cloud, o);
  std::vector<PlannedView> views;
  for (const Shot& shot : shots) views.push_back(shot.view);
  const Table table(cloud, shots);
  for (const double tolerance : o.tolerances) {
    BudgetOptions budget = o.budget;
    budget.tolerance = tolerance;
    const auto start = std::chrono::steady_clock::now();
    const Cloud thin = thinned(cloud, views, budget);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    table.add("budget", tolerance, thin, seconds.count());
    if (o.voxels) table.add("voxels", tolerance, voxel_grid_of(cloud, thin.size()), 0);
  }
}

}  // namespace
}  // namespace ps

int main(int argc, char** argv) {
  ps::Options o;
  CLI::App app{"Thins the cloud of an RGB-D folder to the budget of its own cameras"};
  app.add_option("folder", o.folder, "RGB-D folder")->required();
  app.add_option("--every", o.every, "the cloud is of every N-th frame")
      ->check(CLI::Range(1, 9999));
  app.add_option("--frames", o.frames, "only the first so many frames");
  app.add_option("--tolerances", o.tolerances);
  app.add_option("--pixels", o.budget.pixels);
  app.add_option("--spacing", o.budget.spacing);
  app.add_option("--threads", o.threads, "0 = one for each core");
  app.add_flag("--accumulate", o.accumulate, "all pixels of the frames, instead of fusing them");
  app.add_flag("!--no-voxels", o.voxels, "no comparison with voxel grids");
  CLI11_PARSE(app, argc, argv);
  try {
    ps::run(o);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_budget: " << error.what() << std::endl;
    return 1;
  }
}
