// SPDX-License-Identifier: BSD-3-Clause
// Makes data/room: an RGB-D folder of the tests' little world with planks, tiles and panels painted on.
//   make_sample FOLDER
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "io/depth_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/trajectory.h"
#include "libps/core/error.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

constexpr int kFrames = 16;
const Intrinsics kCamera{400, 300, 333, 333, 199.5, 149.5};

float line(double x, double width) { return std::abs(x - std::round(x)) < width ? 0.55f : 1.0f; }

cv::Vec3f planks(const Eigen::Vector3d& p) {
  const double plank = std::floor(p.x() / 0.2);
  const double grain = std::sin(40 * p.x() + 3 * std::sin(2 * p.z() + plank * 1.7));
  const auto shade = static_cast<float>(0.8 + 0.12 * std::sin(plank * 12.9898) + 0.03 * grain);
  return line(p.x() / 0.2, 0.03) * line(p.z() / 1.1 + plank * 0.37, 0.006) * shade *
         cv::Vec3f(0.72f, 0.5f, 0.32f);
}

cv::Vec3f wall(const Eigen::Vector3d& p, double along) {
  if (p.y() > 1.38) return {0.93f, 0.92f, 0.9f};  // skirting board
  if (std::abs(p.y() + 0.4) < 0.45 && std::abs(along - std::round(along / 2.4) * 2.4) < 0.6) {
    const auto hue = static_cast<float>(0.5 + 0.5 * std::sin(5 * along + 4 * p.y()));
    return {0.2f + 0.6f * hue, 0.55f, 0.85f - 0.5f * hue};  // a picture on the wall
  }
  const auto light = static_cast<float>(0.78 - 0.05 * p.y());
  return light * cv::Vec3f(1.0f, 0.97f, 0.88f);
}

/// The colour of a surface point, by the surface it lies on.
cv::Vec3f paint(const Eigen::Vector3d& p, const cv::Vec3f& box) {
  constexpr double kNear = 1e-3;
  if (p.y() > 1.5 - kNear) return planks(p);
  if (p.y() < -1.5 + kNear) return {0.95f, 0.95f, 0.93f};
  if (std::abs(p.x()) > 3 - kNear) return wall(p, p.z());
  if (std::abs(p.z()) > 4 - kNear) return wall(p, p.x());
  return line(p.y() / 0.3, 0.02) * box;
}

void make(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "color");
  std::filesystem::create_directories(folder / "depth");
  std::vector<StampedPose> trajectory;
  const auto poses = box_world_walk(kFrames);
  for (int i = 0; i < kFrames; ++i) {
    View view = box_world_view(kCamera, poses[i]);
    for (int y = 0; y < kCamera.height; ++y) {
      for (int x = 0; x < kCamera.width; ++x) {
        const Eigen::Vector3d p = poses[i] * kCamera.lift(x, y, view.depth(y, x));
        view.color(y, x) = paint(p, view.color(y, x));
      }
    }
    char name[16];
    std::snprintf(name, sizeof name, "%05d", i);
    write_image(folder / "color" / (std::string(name) + ".jpg"), view.color);
    write_depth(folder / "depth" / (std::string(name) + ".png"), view.depth);
    trajectory.push_back({static_cast<double>(i), poses[i], "", {}});
  }
  write_trajectory(folder / "trajectory.txt", trajectory);
  write_intrinsics(folder / "intrinsics.json", kCamera);
}

}  // namespace
}  // namespace ps

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_sample FOLDER\n");
    return 2;
  }
  try {
    ps::make(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
