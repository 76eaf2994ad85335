// SPDX-License-Identifier: BSD-3-Clause
// bench_budget DIR: what thinning a cloud to its budget costs in the pictures. Prints CSV, a line
// for each tolerance, and one for a voxel grid with as many points.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "io/rgbd_folder.h"
#include "libps/core/parallel.h"
#include "libps/eval/image_metrics.h"
#include "libps/geometry/splat.h"
#include "libps/scene/budget.h"
#include "libps/scene/fuse.h"

namespace ps {
namespace {

struct Options {
  std::string folder;
  std::size_t every = 12;
  std::size_t frames = 1000000;
  bool accumulate = false;
  bool no_voxels = false;
  std::vector<double> tolerances = {0, 0.01, 0.02, 0.04, 0.06, 0.1, 0.2, 1};
  BudgetOptions budget;
  int threads = 0;
};

/// A camera whose picture is known.
struct Shot {
  PlannedView view;
  Image photo;
  Mask known;
  Image full;  ///< of the whole cloud
};

Image render(const Cloud& cloud, const PlannedView& view, Mask* hit = nullptr) {
  SplatOptions options;
  options.renormalise = true;
  const Splat picture = splat(cloud, view.intrinsics, view.world_from_cam, options);
  if (hit) *hit = picture.hit;
  return picture.color;
}

/// Each cell's points become their mean: what pcl::VoxelGrid does, without its limit on cells.
Cloud voxel_grid(const Cloud& cloud, double leaf) {
  struct Sum {
    Eigen::Vector3d position = Eigen::Vector3d::Zero(), color = Eigen::Vector3d::Zero();
    double count = 0;
  };
  std::map<std::tuple<int, int, int>, Sum> cells;
  for (const Point& p : cloud) {
    const Eigen::Vector3d at = p.getVector3fMap().cast<double>();
    const auto step = [&](double x) { return static_cast<int>(std::floor(x / leaf)); };
    Sum& sum = cells[{step(at.x()), step(at.y()), step(at.z())}];
    sum.position += at;
    sum.color += Eigen::Vector3d(p.r, p.g, p.b);
    sum.count += 1;
  }
  Cloud result;
  for (const auto& [key, sum] : cells) {
    Point p;
    p.getVector3fMap() = (sum.position / sum.count).cast<float>();
    const Eigen::Vector3d color = sum.color / sum.count;
    p.r = static_cast<std::uint8_t>(std::lround(color.x()));
    p.g = static_cast<std::uint8_t>(std::lround(color.y()));
    p.b = static_cast<std::uint8_t>(std::lround(color.z()));
    result.push_back(p);
  }
  return result;
}

/// @return the voxel grid of about so many points (within 1 %)
Cloud voxel_grid_of(const Cloud& cloud, std::size_t points) {
  double low = 1e-4, high = 1;
  Cloud result;
  for (int i = 0; i < 16; ++i) {
    const double leaf = std::sqrt(low * high);
    result = voxel_grid(cloud, leaf);
    const double ratio = static_cast<double>(result.size()) / static_cast<double>(points);
    if (std::abs(ratio - 1) < 0.01) break;
    (ratio > 1 ? low : high) = leaf;
  }
  return result;
}

std::vector<Shot> planned_shots(const RgbdFolder& folder, const Options& o) {
  std::vector<Shot> shots;
  const std::size_t step = std::max<std::size_t>(1, o.every / 2);
  for (std::size_t i = 0; i < folder.frames.size(); i += step) {
    const View view = load_frame(folder, folder.frames[i]);
    shots.push_back({{view.intrinsics, view.world_from_cam}, view.color, view.depth > 0, {}});
  }
  return shots;
}

Cloud full_cloud(const RgbdFolder& folder, const Options& o) {
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

struct Scores {
  double full = 0, photos = 0, worst = 1e9, lost = 0;
};

Scores score(const Cloud& cloud, const std::vector<Shot>& shots) {
  Scores s;
  const double n = static_cast<double>(shots.size());
  for (const Shot& shot : shots) {
    Mask hit;
    const Image picture = render(cloud, shot.view, &hit);
    const double against_full =
        shot.full.empty() ? 99 : std::min(99., psnr(picture, shot.full, shot.known));
    s.full += against_full / n;
    if (std::getenv("DUMP") && against_full < 26) {
      static int k = 0;
      cv::Mat both, a = (picture * 255), b = (shot.full * 255), c = shot.photo * 255,
                    d = cv::abs(picture - shot.full) * 1024;
      d.setTo(cv::Scalar::all(0), shot.known == 0);
      cv::Mat top, bottom;
      cv::hconcat(std::vector<cv::Mat>{a, b}, top);
      cv::hconcat(std::vector<cv::Mat>{c, d}, bottom);
      cv::vconcat(top, bottom, both);
      cv::cvtColor(both, both, cv::COLOR_RGB2BGR);
      cv::imwrite("/tmp/budget/dump" + std::to_string(k++) + ".png", both);
      std::fprintf(stderr, "dump %.2f\n", against_full);
    }
    s.worst = std::min(s.worst, against_full);
    s.photos += psnr(picture, shot.photo, shot.known) / n;
    s.lost += static_cast<double>(cv::countNonZero(shot.known & (hit == 0))) /
              cv::countNonZero(shot.known) / n;
  }
  return s;
}

void print(const char* method, double tolerance, std::size_t points, std::size_t full,
           const Scores& s, double base, double seconds) {
  std::printf("%s,%g,%zu,%.4f,%.2f,%.2f,%.3f,%+.3f,%.5f,%.2f\n", method, tolerance, points,
              static_cast<double>(points) / static_cast<double>(full), s.full, s.worst, s.photos,
              s.photos - base, s.lost, seconds);
  std::fflush(stdout);
}

void run(const Options& o) {
  set_threads(o.threads);
  RgbdFolder folder = open_rgbd_folder(o.folder);
  folder.frames.resize(std::min(folder.frames.size(), o.frames));
  const Cloud cloud = full_cloud(folder, o);
  std::vector<Shot> shots = planned_shots(folder, o);
  std::vector<PlannedView> views;
  for (Shot& shot : shots) {
    Mask hit;
    shot.full = render(cloud, shot.view, &hit);
    shot.known &= hit;
    shot.known.setTo(1, shot.known);
    views.push_back(shot.view);
  }
  std::printf(
      "method,tolerance,points,share,psnr_full,worst_full,psnr_photos,change,lost,seconds\n");
  const Scores base = score(cloud, shots);
  print("full", 0, cloud.size(), cloud.size(), base, base.photos, 0);
  for (const double tolerance : o.tolerances) {
    BudgetOptions budget = o.budget;
    budget.tolerance = tolerance;
    const double start = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    const Cloud thin = thinned(cloud, views, budget);
    const double seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC - start;
    print("budget", tolerance, thin.size(), cloud.size(), score(thin, shots), base.photos, seconds);
    if (o.no_voxels) continue;
    const Cloud voxels = voxel_grid_of(cloud, thin.size());
    print("voxels", tolerance, voxels.size(), cloud.size(), score(voxels, shots), base.photos, 0);
  }
}

}  // namespace
}  // namespace ps

int main(int argc, char** argv) {
  ps::Options o;
  CLI::App app{"Thins a fused RGB-D folder to the budget of its own cameras"};
  app.add_option("folder", o.folder)->required();
  app.add_option("--every", o.every, "fuse every Nth frame; planned are those and one in between");
  app.add_option("--frames", o.frames, "only the first so many frames");
  app.add_option("--tolerances", o.tolerances);
  app.add_option("--pixels", o.budget.pixels);
  app.add_option("--spacing", o.budget.spacing);
  app.add_option("--threads", o.threads);
  app.add_flag("--accumulate", o.accumulate, "lift all frames instead of fusing them");
  app.add_flag("--no-voxels", o.no_voxels);
  CLI11_PARSE(app, argc, argv);
  try {
    ps::run(o);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_budget: " << error.what() << std::endl;
    return 1;
  }
}
