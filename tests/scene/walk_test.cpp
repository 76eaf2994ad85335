// SPDX-License-Identifier: BSD-3-Clause
// Geometric consistency on real RGB-D frames (../shared/rgbd/walk; skipped where that is not
// there).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "io/rgbd_folder.h"
#include "libps/core/parallel.h"
#include "libps/eval/cloud_metrics.h"
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

/// Every `step`th frame.
std::vector<RgbdFrame> thinned(const std::vector<RgbdFrame>& frames, std::size_t step) {
  std::vector<RgbdFrame> some;
  for (std::size_t i = 0; i < frames.size(); i += step) some.push_back(frames[i]);
  return some;
}

TEST_F(Walk, threads_change_no_byte) {
  const std::vector<RgbdFrame> frames = thinned(folder_.frames, 10);
  set_threads(1);
  const Cloud one = fuse(source(frames));
  set_threads(3);
  const Cloud three = fuse(source(frames));
  set_threads(0);
  EXPECT_GT(one.size(), 50000u);
  EXPECT_TRUE(same_points(one, three));
}

TEST_F(Walk, the_order_of_frames_does_not_change_the_surface) {
  std::vector<RgbdFrame> frames = thinned(folder_.frames, 20);
  const Cloud forwards = fuse(source(frames));
  std::reverse(frames.begin(), frames.end());
  const Cloud backwards = fuse(source(frames));
  EXPECT_NEAR(static_cast<double>(forwards.size()) / static_cast<double>(backwards.size()), 1, 0.1);
  const CloudScore score = cloud_scores(forwards, backwards, {0.02}).front();
  std::printf("forwards %zu points, backwards %zu: F-score at 2 cm %.4f\n", forwards.size(),
              backwards.size(), score.f_score);
  EXPECT_GT(score.f_score, 0.98);
}

/// A splat at one camera, warped by a homography, against the splat at another: PSNR where both
/// have points, dB.
double psnr_through(const cv::Matx33d& homography, const Splat& from, const Splat& to) {
  Image warped;
  Mask covered, all = from.hit * 255;
  cv::warpPerspective(from.color, warped, homography, from.color.size());
  cv::warpPerspective(all, covered, homography, all.size());
  covered = (covered == 255) & (to.hit * 255);
  EXPECT_GT(cv::countNonZero(covered), static_cast<int>(covered.total()) / 3);
  return psnr(warped, to.color, covered);
}

TEST_F(Walk, pure_rotations_are_related_by_the_homography) {
  const View view = load_frame(folder_, folder_.frames[30]);
  const Cloud cloud = lift(view);
  const Intrinsics& k = view.intrinsics;
  SplatOptions options;
  options.radius = 1.5f;
  options.renormalise = true;
  const auto turned = [&](double yaw, double pitch) {
    Pose pose = view.world_from_cam;
    pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()));
    return pose;
  };
  const Pose left = turned(-0.12, 0.03), right = turned(0.15, -0.05);
  const Splat from = splat(cloud, k, left, options), to = splat(cloud, k, right, options);
  Eigen::Matrix3d lens;
  lens << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1;
  const Eigen::Matrix3d h = lens * right.linear().transpose() * left.linear() * lens.inverse();
  const auto shifted = [&](double pixels) {
    return cv::Matx33d(1, 0, pixels, 0, 1, 0, 0, 0, 1) * cv::Matx33d(h(0, 0), h(0, 1), h(0, 2),
                                                                     h(1, 0), h(1, 1), h(1, 2),
                                                                     h(2, 0), h(2, 1), h(2, 2));
  };
  const double exact = psnr_through(shifted(0), from, to);
  std::printf("PSNR through the homography %.2f dB, one pixel beside %.2f and %.2f dB\n", exact,
              psnr_through(shifted(1), from, to), psnr_through(shifted(-1), from, to));
  EXPECT_GT(exact, 25);
  EXPECT_GT(exact, psnr_through(shifted(1), from, to) + 2);
  EXPECT_GT(exact, psnr_through(shifted(-1), from, to) + 2);
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
