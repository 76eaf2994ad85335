// SPDX-License-Identifier: BSD-3-Clause
// Geometric consistency on real RGB-D frames (../shared/rgbd/walk; skipped where that is not
// there).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "io/rgbd_folder.h"
#include "libps/eval/depth_metrics.h"
#include "libps/eval/image_metrics.h"
#include "libps/geometry/splat.h"
#include "libps/scene/fuse.h"
#include "tests/support/same_points.h"

namespace ps {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kFrames = 40;  // sanitizers are slow
#else
constexpr std::size_t kFrames = 373;
#endif

class Walk : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path path = PS_SHARED_DIR "/rgbd/walk";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    folder_ = open_rgbd_folder(path);
    folder_.frames.resize(std::min(kFrames, folder_.frames.size()));
  }

  ViewSource source(const std::vector<RgbdFrame>& frames) const {
    return {frames.size(), [=](std::size_t i) { return load_frame(folder_, frames[i]); }};
  }

  RgbdFolder folder_;
};

TEST_F(Walk, lifting_then_projecting_returns_each_pixel) {
  for (std::size_t i = 0; i < folder_.frames.size(); i += 60) {
    const View view = load_frame(folder_, folder_.frames[i]);
    LiftOptions keep_all;
    keep_all.edge_footprints = 0;
    const Mask pixels = liftable(view.depth, view.intrinsics, keep_all);
    const Cloud cloud = lift(view, pixels, 0, Origin::observed);
    const Pose cam_from_world = view.world_from_cam.inverse();
    std::size_t at = 0;
    double worst = 0;
    for (int y = 0; y < pixels.rows; ++y) {
      for (int x = 0; x < pixels.cols; ++x) {
        if (!pixels(y, x)) continue;
        const Eigen::Vector3d p = cam_from_world * cloud[at++].getVector3fMap().cast<double>();
        worst = std::max(worst, (view.intrinsics.project(p) - Eigen::Vector2d(x, y)).norm());
      }
    }
    EXPECT_EQ(at, cloud.size());
    EXPECT_GT(at, 50000u);
    EXPECT_LT(worst, 1e-3) << folder_.frames[i].depth;
  }
}

TEST_F(Walk, the_same_frame_twice_adds_nothing) {
  for (std::size_t i = 0; i < folder_.frames.size(); i += 60) {
    const View view = load_frame(folder_, folder_.frames[i]);
    SceneCloud scene;
    scene.add(view, 0);
    const std::size_t before = scene.size();
    const AddReport report = scene.add(view, 1);
    EXPECT_EQ(report.added, 0u) << folder_.frames[i].depth;
    EXPECT_EQ(scene.size(), before);
  }
}

TEST_F(Walk, every_tenth_frame_is_rendered_from_the_others) {
  std::vector<RgbdFrame> kept, held_back;
  for (std::size_t i = 0; i < folder_.frames.size(); ++i) {
    (i % 10 == 5 ? held_back : kept).push_back(folder_.frames[i]);
  }
  const Cloud cloud = fuse(source(kept));
  SplatOptions options;
  options.radius = 1.5f;
  options.renormalise = true;
  std::vector<double> errors, quality;
  for (const RgbdFrame& frame : held_back) {
    const View truth = load_frame(folder_, frame);
    const Splat picture = splat(cloud, truth.intrinsics, truth.world_from_cam, options);
    const Mask visible = picture.hit & (truth.depth > 0);
    EXPECT_GT(cv::countNonZero(visible), 0.9 * cv::countNonZero(truth.depth > 0)) << frame.color;
    const DepthErrors depth = depth_errors(picture.first_depth, truth.depth, visible);
    EXPECT_LT(depth.median_rel, 0.02) << frame.color;
    errors.push_back(depth.median_rel);
    quality.push_back(psnr(picture.color, truth.color, visible));
  }
  std::sort(errors.begin(), errors.end());
  std::sort(quality.begin(), quality.end());
  EXPECT_LT(errors[errors.size() / 2], 0.005);
  EXPECT_GT(quality[quality.size() / 2], 17);
  EXPECT_GT(quality.front(), 10);
  RecordProperty("median_of_median_relative_depth_error",
                 std::to_string(errors[errors.size() / 2]));
  RecordProperty("median_psnr_dB", std::to_string(quality[quality.size() / 2]));
  std::printf(
      "%zu held-back frames: median relative depth error %.4f (worst %.4f), "
      "PSNR %.2f dB (worst %.2f)\n",
      errors.size(), errors[errors.size() / 2], errors.back(), quality[quality.size() / 2],
      quality.front());
}

}  // namespace
}  // namespace ps
