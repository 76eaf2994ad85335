// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/scene_cloud.h"

#include <gtest/gtest.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <limits>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "tests/support/box_world.h"
#include "tests/support/same_points.h"

namespace ps {
namespace {

const Intrinsics kCamera{160, 120, 130, 130, 79.5, 59.5};

View plane_at(float depth, const cv::Vec3f& color, const Intrinsics& k = kCamera) {
  View view;
  view.intrinsics = k;
  view.color = Image(k.height, k.width, color);
  view.depth = Depth(k.height, k.width, depth);
  return view;
}

TEST(SceneCloud, the_first_view_is_lifted_whole) {
  const View view = box_world_view(kCamera, pose_at(0, 0, -2, 0));
  SceneCloud scene;
  const AddReport report = scene.add(view, 7);
  const Cloud lifted = lift(view, 7);
  EXPECT_EQ(report.added, lifted.size());
  EXPECT_EQ(report.lifted, lifted.size());
  EXPECT_TRUE(same_points(scene.cloud(), lifted));
}

TEST(SceneCloud, the_same_view_twice_adds_nothing_and_moves_nothing) {
  const View view = box_world_view(kCamera, pose_at(0, 0, -2, 0));
  SceneCloud scene;
  scene.add(view, 0);
  const Cloud before = scene.cloud();
  const AddReport report = scene.add(view, 1);
  EXPECT_EQ(report.added, 0u);
  EXPECT_EQ(report.replaced, 0u);
  EXPECT_EQ(report.explained, report.lifted);
  const Cloud after = scene.cloud();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT((before[i].getVector3fMap() - after[i].getVector3fMap()).norm(), 1e-5);
  }
}

TEST(SceneCloud, a_view_beside_adds_only_what_was_not_seen) {
  SceneCloud scene;
  scene.add(box_world_view(kCamera, pose_at(0, 0, -2, 0)), 0);
  const AddReport report = scene.add(box_world_view(kCamera, pose_at(0, 0, -2, 0.3)), 1);
  EXPECT_GT(report.explained, report.lifted / 2);
  EXPECT_GT(report.added, 1000u);
  // What it adds lies outside the first camera's image, or was hidden in it.
  const View first = box_world_view(kCamera, pose_at(0, 0, -2, 0));
  std::size_t seen_before = 0;
  for (const Point& point : scene.cloud()) {
    if (point.view != 1) continue;
    const Eigen::Vector3d p =
        first.world_from_cam.inverse() * point.getVector3fMap().cast<double>();
    const Eigen::Vector2d uv = kCamera.project(p);
    const int x = static_cast<int>(std::lround(uv.x())), y = static_cast<int>(std::lround(uv.y()));
    const bool inside = p.z() > 0 && x >= 1 && y >= 1 && x < 159 && y < 119;
    seen_before += inside && std::abs(first.depth(y, x) - p.z()) < 0.01;
  }
  EXPECT_LT(seen_before, report.added / 50);
}

TEST(SceneCloud, no_two_points_of_one_surface_are_nearer_than_the_spacing) {
  for (const double spacing : {0.0, 0.08}) {
    SceneCloudOptions options;
    options.spacing = spacing;
    options.average = false;  // averaging moves points after the check
    SceneCloud scene(options);
    for (int i = 0; i < 4; ++i) {
      scene.add(box_world_view(kCamera, pose_at(0.1 * i, 0, -2, 0.1 * i)), i);
    }
    const Cloud cloud = scene.cloud();
    pcl::PointCloud<pcl::PointXYZ>::Ptr places(new pcl::PointCloud<pcl::PointXYZ>);
    for (const Point& point : cloud) places->push_back({point.x, point.y, point.z});
    pcl::KdTreeFLANN<pcl::PointXYZ> tree;
    tree.setInputCloud(places);
    std::size_t crowded = 0, checked = 0;
    for (const Point& point : cloud) {
      if (point.view == 0 && spacing == 0)
        continue;  // one view's own pixels are at their own distance
      pcl::Indices index(2);
      std::vector<float> distance2(2);
      tree.nearestKSearch({point.x, point.y, point.z}, 2, index, distance2);
      const double apart = std::max(spacing, 0.99 * point.footprint);
      crowded += point.view != cloud[index[1]].view && distance2[1] < apart * apart;
      if (spacing > 0) crowded += distance2[1] < spacing * spacing * 0.9999;
      ++checked;
    }
    EXPECT_GT(checked, 100u);
    EXPECT_EQ(crowded, 0u) << spacing;
  }
}

TEST(SceneCloud, a_much_closer_view_replaces_what_it_sees_better) {
  SceneCloud scene;
  scene.add(plane_at(4, {1, 0, 0}), 0);
  View close = plane_at(2, {0, 1, 0});
  close.world_from_cam.translation().z() = 2;
  const AddReport report = scene.add(close, 1);
  // At the image's edge, points just outside it still stand for its outermost pixels.
  EXPECT_GT(report.added, report.lifted * 97 / 100);
  EXPECT_NEAR(static_cast<double>(report.replaced), kCamera.width * kCamera.height / 4.0, 400);
  // The far view comes again: it has nothing to say about the part that was seen better.
  const AddReport again = scene.add(plane_at(4, {1, 0, 0}), 2);
  EXPECT_EQ(again.added, 0u);
  EXPECT_EQ(again.replaced, 0u);
}

TEST(SceneCloud, averaging_halves_the_noise_of_many_views) {
  const auto noise_of = [](bool average) {
    SceneCloudOptions options;
    options.average = average;
    SceneCloud scene(options);
    cv::RNG random(5);
    for (int i = 0; i < 10; ++i) {
      View view = plane_at(2, {0.5f, 0.5f, 0.5f});
      Depth noise(view.depth.size());
      random.fill(noise, cv::RNG::NORMAL, 0, 0.01);
      view.depth += noise;
      scene.add(view, i);
    }
    double sum2 = 0;
    for (const Point& point : scene.cloud()) sum2 += (point.z - 2.0) * (point.z - 2.0);
    return std::sqrt(sum2 / static_cast<double>(scene.size()));
  };
  EXPECT_LT(noise_of(true), 0.5 * noise_of(false));
}

TEST(SceneCloud, what_later_views_see_through_is_removed) {
  SceneCloud scene;
  View ghost = plane_at(3, {0.5f, 0.5f, 0.5f});
  ghost.depth(cv::Rect(60, 40, 20, 20)) = 1.5;  // a thing that only the first view sees
  scene.add(ghost, 0);
  for (int i = 1; i < 4; ++i) scene.add(plane_at(3, {0.5f, 0.5f, 0.5f}), i);
  EXPECT_EQ(scene.remove_contradicted(), 400u);
  for (const Point& point : scene.cloud()) EXPECT_GT(point.z, 2.9);
}

TEST(SceneCloud, what_was_observed_is_never_changed_by_what_is_outpainted) {
  SceneCloud scene;
  scene.add(plane_at(3, {0.2f, 0.4f, 0.6f}), 0);
  const Cloud before = scene.cloud();
  View invented = plane_at(3.02f, {1, 1, 1});
  invented.world_from_cam.translation().x() = 0.5;
  const AddReport report = scene.add(invented, 1, Origin::outpainted);
  EXPECT_GT(report.added, 0u);
  const Cloud after = scene.cloud();
  ASSERT_GT(after.size(), before.size());
  EXPECT_TRUE(same_points(before, after, before.size()));
  // And what is observed at last takes the place of what was outpainted.
  View observed = plane_at(3, {0, 0, 0});
  observed.world_from_cam.translation().x() = 0.5;
  EXPECT_GE(scene.add(observed, 2).replaced, report.added * 9 / 10);
}

TEST(SceneCloud, what_is_outpainted_does_not_contradict_what_was_observed) {
  SceneCloud scene;
  scene.add(plane_at(1.5f, {0.5f, 0.5f, 0.5f}), 0);
  for (int i = 1; i < 4; ++i) scene.add(plane_at(3, {1, 1, 1}), i, Origin::outpainted);
  EXPECT_EQ(scene.remove_contradicted(), 0u);
}

TEST(SceneCloud, depths_of_nothing_are_no_points) {
  View view = plane_at(2, {0.5f, 0.5f, 0.5f});
  view.depth.row(0) = 1e-12f;
  view.depth.row(1) = std::numeric_limits<float>::denorm_min();
  SceneCloud scene;
  EXPECT_EQ(scene.add(view, 0).added, view.depth.total() - 2 * view.depth.cols);
  EXPECT_EQ(scene.cloud().size(), scene.size());
}

TEST(SceneCloud, only_chosen_pixels_are_added) {
  SceneCloud scene;
  Mask pixels(kCamera.height, kCamera.width, std::uint8_t{0});
  pixels(cv::Rect(10, 20, 30, 40)) = 1;
  EXPECT_EQ(scene.add(plane_at(3, {0, 0, 0}), 0, Origin::outpainted, pixels).added, 1200u);
  EXPECT_THROW(scene.add(plane_at(3, {0, 0, 0}), 0, Origin::observed, Mask(3, 3, 1)), Error);
}

TEST(SceneCloud, bytes_do_not_depend_on_threads) {
  const auto fused = [](int count) {
    set_threads(count);
    SceneCloud scene;
    int number = 0;
    for (const Pose& pose : box_world_walk(8)) {
      View view = box_world_view(kCamera, pose);
      cv::RNG random(number);
      Depth noise(view.depth.size());
      random.fill(noise, cv::RNG::NORMAL, 0, 0.005);
      view.depth += noise;
      scene.add(view, number++);
    }
    scene.remove_contradicted();
    return scene.cloud();
  };
  const Cloud one = fused(1);
  EXPECT_GT(one.size(), 20000u);
  EXPECT_TRUE(same_points(one, fused(2)));
  EXPECT_TRUE(same_points(one, fused(6)));
  set_threads(0);
}

TEST(SceneCloud, nearly_coincident_points_do_no_harm) {
  // A camera so long that all its points fall within a tenth of a millimetre.
  const Intrinsics tele{60, 40, 1e6, 1e6, 29.5, 19.5};
  SceneCloud scene;
  for (int i = 0; i < 3; ++i) {
    View view = plane_at(1, {0.5f, 0.5f, 0.5f}, tele);
    view.world_from_cam.translation().x() = 1e-4 * i;
    scene.add(view, i);
  }
  EXPECT_GT(scene.size(), 0u);
  EXPECT_LE(scene.size(), 7200u);
}

TEST(SceneCloud, pixels_that_floats_cannot_tell_apart_are_refused) {
  SceneCloud scene;
  EXPECT_THROW(scene.add(plane_at(1, {0, 0, 0}, {60, 40, 1e8, 1e8, 29.5, 19.5}), 0), Error);
  View far_away = plane_at(2, {0, 0, 0});
  far_away.world_from_cam.translation().x() = 5e5;  // as in UTM coordinates
  EXPECT_THROW(scene.add(far_away, 0), Error);
  EXPECT_EQ(scene.size(), 0u);
}

TEST(SceneCloud, unsound_views_are_refused_and_change_nothing) {
  SceneCloud scene;
  scene.add(plane_at(3, {0, 0, 0}), 0);
  const Cloud before = scene.cloud();
  View bad = plane_at(3, {0, 0, 0});
  bad.world_from_cam.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(scene.add(bad, 1), Error);
  bad = plane_at(3, {0, 0, 0});
  bad.world_from_cam.linear() *= 2;
  EXPECT_THROW(scene.add(bad, 1), Error);
  EXPECT_THROW(scene.add(plane_at(0, {0, 0, 0}), 1), Error);
  EXPECT_TRUE(same_points(before, scene.cloud()));
  SceneCloudOptions options;
  options.spacing = -1;
  EXPECT_THROW(SceneCloud{options}, Error);
}

}  // namespace
}  // namespace ps
