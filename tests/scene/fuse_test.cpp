// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/fuse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/cloud_metrics.h"
#include "libps/eval/depth_metrics.h"
#include "libps/eval/image_metrics.h"
#include "libps/geometry/splat.h"
#include "tests/support/box_world.h"
#include "tests/support/same_points.h"

namespace ps {
namespace {

const Intrinsics kCamera{200, 150, 160, 160, 99.5, 74.5};
constexpr int kSteps = 24;

ViewSource box_world_source(const std::vector<Pose>& poses) {
  return {poses.size(), [poses](std::size_t i) { return box_world_view(kCamera, poses[i]); }};
}

TEST(Fuse, a_view_left_out_is_rendered_from_the_others) {
  std::vector<Pose> poses = box_world_walk(kSteps), held_back, kept;
  for (int i = 0; i < kSteps; ++i) (i % 10 == 5 ? held_back : kept).push_back(poses[i]);
  FuseReport report;
  const Cloud cloud = fuse(box_world_source(kept), {}, &report);
  EXPECT_EQ(report.points, cloud.size());
  EXPECT_EQ(report.views, kept.size());
  EXPECT_EQ(report.pixels.lifted,
            report.pixels.explained + report.pixels.duplicates + report.pixels.added);
  EXPECT_LT(cloud.size(), report.pixels.lifted / 4);
  SplatOptions options;
  options.radius = 1.5f;
  options.renormalise = true;
  for (const Pose& pose : held_back) {
    const View truth = box_world_view(kCamera, pose);
    const Splat picture = splat(cloud, kCamera, pose, options);
    EXPECT_GT(cv::countNonZero(picture.hit), 0.97 * static_cast<double>(picture.hit.total()));
    EXPECT_GT(psnr(picture.color, truth.color, picture.hit), 30);
    // The nearest hit lies up to a radius beside the pixel: nearer, where the surface slants.
    const DepthErrors first = depth_errors(picture.first_depth, truth.depth, picture.hit);
    EXPECT_LT(first.median_rel, 0.012);
    const DepthErrors expected = depth_errors(picture.expected_depth, truth.depth, picture.hit);
    EXPECT_LT(expected.median_rel, 0.005);
    EXPECT_LT(expected.abs_rel, 0.02);
  }
}

TEST(Fuse, every_point_lies_on_a_true_surface) {
  const Cloud cloud = fuse(box_world_source(box_world_walk(kSteps)));
  Cloud truth;
  for (const Pose& pose : box_world_walk(kSteps)) truth += lift(box_world_view(kCamera, pose));
  // Three centimetres off the nearest true point; two of the largest footprints (8 m / 160 pixels)
  // between points.
  const auto scores = cloud_scores(cloud, truth, {0.03, 0.1});
  EXPECT_GT(scores[0].accuracy, 0.999);
  EXPECT_GT(scores[1].completeness, 0.999);
}

TEST(Fuse, averaging_keeps_points_of_exact_views_in_their_plane) {
  // All of the far wall: z = 4, seen at a slant from many places.
  for (const Point& point : fuse(box_world_source(box_world_walk(kSteps)))) {
    const bool on_wall = point.z > 3.9f && std::abs(point.x) < 2.8f && std::abs(point.y) < 1.3f;
    if (on_wall) {
      EXPECT_NEAR(point.z, 4, 2e-5);
    }
  }
}

TEST(Fuse, the_order_of_the_views_does_not_matter_to_the_surface) {
  std::vector<Pose> poses = box_world_walk(kSteps);
  const Cloud forwards = fuse(box_world_source(poses));
  std::reverse(poses.begin(), poses.end());
  const Cloud backwards = fuse(box_world_source(poses));
  EXPECT_NEAR(static_cast<double>(forwards.size()) / static_cast<double>(backwards.size()), 1, 0.1);
  for (const CloudScore& score : cloud_scores(forwards, backwards, {0.1})) {
    EXPECT_GT(score.f_score, 0.999);
  }
}

TEST(Fuse, bytes_do_not_depend_on_threads) {
  const auto poses = box_world_walk(8);
  set_threads(1);
  const Cloud one = fuse(box_world_source(poses));
  set_threads(3);
  const Cloud three = fuse(box_world_source(poses));
  set_threads(0);
  EXPECT_TRUE(same_points(one, three));
}

TEST(Fuse, pure_rotations_are_related_by_the_homography) {
  const View view = box_world_view(kCamera, pose_at(0, 0, -2, 0));
  const Pose turned = pose_at(0, 0, -2, 0.4, 0.15);
  SplatOptions options;
  options.radius = 1.2f;
  options.renormalise = true;
  const Cloud cloud = lift(view);
  const Splat picture = splat(cloud, kCamera, turned, options);
  Eigen::Matrix3d k;
  k << kCamera.fx, 0, kCamera.cx, 0, kCamera.fy, kCamera.cy, 0, 0, 1;
  const Eigen::Matrix3d homography =
      k * turned.linear().transpose() * view.world_from_cam.linear() * k.inverse();
  const Pose cam_from_world = turned.inverse();
  for (std::size_t i = 0; i < cloud.size(); i += 7) {
    const Eigen::Vector3d world = cloud[i].getVector3fMap().cast<double>();
    const Eigen::Vector2d before = kCamera.project(view.world_from_cam.inverse() * world);
    const Eigen::Vector2d after = kCamera.project(cam_from_world * world);
    const Eigen::Vector3d warped = homography * before.homogeneous();
    EXPECT_LT((warped.hnormalized() - after).norm(), 1e-3);
  }
  // And the pictures agree where the warp of the photo falls.
  double worst = 0;
  int compared = 0;
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const Eigen::Vector2d source =
          (homography.inverse() * Eigen::Vector3d(x, y, 1)).hnormalized();
      const int u = static_cast<int>(std::lround(source.x()));
      const int v = static_cast<int>(std::lround(source.y()));
      if (u < 3 || v < 3 || u >= kCamera.width - 3 || v >= kCamera.height - 3) continue;
      double low, high;
      cv::minMaxLoc(view.depth(cv::Rect(u - 2, v - 2, 5, 5)), &low, &high);
      if (high > 1.05 * low || !picture.hit(y, x)) continue;  // at an edge colours mix
      worst = std::max(worst, cv::norm(picture.color(y, x), view.color(v, u), cv::NORM_INF));
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_LT(worst, 0.06);  // half a pixel of these colours, and their rounding to 8 bits
}

TEST(Fuse, empty_views_are_passed_over_and_counted) {
  const auto poses = box_world_walk(5);
  const auto gappy = [&](std::size_t i) {
    return i % 2 == 1 ? View() : box_world_view(kCamera, poses[i]);
  };
  FuseReport report;
  const Cloud cloud = fuse({poses.size(), gappy}, {}, &report);
  EXPECT_EQ(report.views, 3u);
  EXPECT_EQ(report.empty, 2u);
  // Views keep their numbers.
  const Cloud expected = fuse(box_world_source({poses[0], poses[2], poses[4]}));
  ASSERT_EQ(cloud.size(), expected.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(cloud[i].getVector3fMap(), expected[i].getVector3fMap());
    EXPECT_EQ(cloud[i].view, 2 * expected[i].view);
  }
  const Cloud none = fuse({2, [](std::size_t) { return View(); }}, {}, &report);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(report.views, 0u);
}

TEST(Fuse, errors_of_a_source_are_passed_on_and_stopping_is_an_error) {
  ViewSource broken = box_world_source(box_world_walk(4));
  const auto load = broken.load;
  broken.load = [load](std::size_t i) {
    if (i == 2) throw Error("depth/2.png", "is empty");
    return load(i);
  };
  EXPECT_THROW(fuse(broken), Error);
  const auto stop = [](std::size_t done, std::size_t) { return done < 2; };
  EXPECT_THROW(fuse(box_world_source(box_world_walk(4)), {}, nullptr, stop), Error);
  EXPECT_TRUE(fuse(ViewSource{}).empty());
  EXPECT_THROW(fuse(ViewSource{3, {}}), Error);
  EXPECT_THROW(fuse(ViewSource{65537, [](std::size_t) -> View { std::abort(); }}), Error);
}

}  // namespace
}  // namespace ps
