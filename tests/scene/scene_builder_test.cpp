// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/scene_builder.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/image_metrics.h"
#include "libps/geometry/point.h"
#include "libps/scene/camera_path.h"
#include "libps/scene/strategies.h"
#include "libps/scene/view_renderer.h"
#include "tests/support/box_world.h"
#include "tests/support/random_networks.h"
#include "tests/support/same_points.h"

namespace ps {
namespace {

SceneOptions few_samples() {
  SceneOptions options;
  options.outpaint.samples = 2;
  return options;
}

const Intrinsics kLens = intrinsics_from_fov(320, 256, 65);

View input_view() { return box_world_view(kLens, pose_at(0, 0, -1, 0.1)); }

Pose turned(const Pose& start, double radians) {
  return start * Pose(Eigen::AngleAxisd(radians, Eigen::Vector3d::UnitY()));
}

SceneBuilder observed_scene(const SceneOptions& options = few_samples()) {
  SceneBuilder scene(random_networks().all(), kLens, options);
  scene.observe(input_view(), 0);
  return scene;
}

std::size_t outpainted_in(const Cloud& cloud) {
  std::size_t count = 0;
  for (const Point& point : cloud) count += point.origin == 1;
  return count;
}

TEST(SceneBuilder, where_nothing_is_missing_nothing_is_invented) {
  SceneBuilder scene = observed_scene();
  const SupportView support = scene.outpaint(input_view().world_from_cam, 1);
  EXPECT_EQ(support.report.best, -1);
  EXPECT_EQ(cv::countNonZero(support.pixels), 0);
  const std::size_t before = scene.cloud().size();
  EXPECT_EQ(scene.add(support, 1).added, 0u);
  EXPECT_EQ(scene.cloud().size(), before);
}

TEST(SceneBuilder, outpainting_leaves_what_was_observed_as_it_was) {
  SceneBuilder scene = observed_scene();
  const Cloud before = scene.cloud();
  const SupportView support = scene.outpaint(turned(input_view().world_from_cam, 0.5), 1);
  EXPECT_GT(support.report.missing_share, 0.2);
  EXPECT_GT(scene.add(support, 1).added, 10000u);
  const Cloud& after = scene.cloud();
  ASSERT_GT(after.size(), before.size());
  EXPECT_TRUE(same_points(before, after, before.size()));
  EXPECT_EQ(outpainted_in(before), 0u);
  EXPECT_EQ(outpainted_in(after), after.size() - before.size());
}

double most_colorful(const Image& image) {
  double most = 0;
  for (const cv::Vec3f& c : image) {
    const auto [low, high] = std::minmax({c[0], c[1], c[2]});
    most = std::max(most, static_cast<double>(high - low));
  }
  return most;
}

TEST(SceneBuilder, what_is_outpainted_of_a_grey_photo_is_grey) {
  View grey = input_view();
  for (cv::Vec3f& c : grey.color) c = cv::Vec3f::all(c[1]);
  const Pose beside = turned(grey.world_from_cam, 0.4);
  for (const bool colorful : {false, true}) {
    SceneBuilder scene(random_networks().all(), kLens, few_samples());
    if (colorful) grey.color(cv::Rect(0, 0, 60, 60)).setTo(cv::Scalar(1, 0, 0));
    if (!colorful) grey.color(0, 0) = {1, 0, 0};  // one pixel makes no colour photo
    scene.observe(grey, 0);
    const SupportView support = scene.outpaint(beside, 1);
    ViewRenderer renderer(random_networks().all().outpaint.refiner);
    const RenderedView view = renderer.render(scene.cloud(), kLens, beside);
    ASSERT_GT(view.missing_share, .1);
    if (colorful) {
      EXPECT_GT(most_colorful(support.view.color), .1);
      EXPECT_GT(most_colorful(view.color), .1);
    } else {
      EXPECT_LT(most_colorful(support.view.color), 1e-5);
      Image painted = view.color.clone();
      painted.setTo(cv::Scalar::all(0), view.splat.hit);
      EXPECT_LT(most_colorful(painted), .02) << "but for the seam";
    }
  }
}

TEST(SceneBuilder, invented_points_never_stand_before_what_was_observed) {
  SceneBuilder scene = observed_scene();
  const View input = input_view();
  // Beside the turn, a step aside: what the input saw is seen from elsewhere, with holes behind it.
  for (int i = 0; i < 2; ++i) {
    Pose pose = turned(input.world_from_cam, i == 0 ? 0.4 : -0.4);
    pose.translation() += Eigen::Vector3d(i == 0 ? -0.4 : 0.4, 0, 0.2);
    scene.add(scene.outpaint(pose, static_cast<std::uint16_t>(1 + i)),
              static_cast<std::uint16_t>(1 + i));
  }
  std::size_t invented = 0, before = 0;
  const Pose cam_from_world = input.world_from_cam.inverse();
  Depth nearest;  // a silhouette may be a pixel off
  cv::erode(input.depth, nearest, {});
  for (const Point& point : scene.cloud()) {
    if (point.origin == 0) continue;
    ++invented;
    const Eigen::Vector3d p = cam_from_world * point.getVector3fMap().cast<double>();
    if (p.z() <= 0) continue;
    const Eigen::Vector2d at = kLens.project(p);
    const int x = static_cast<int>(std::lround(at.x())), y = static_cast<int>(std::lround(at.y()));
    if (x < 0 || y < 0 || x >= kLens.width || y >= kLens.height) continue;
    before += p.z() < 0.95 * nearest(y, x);
  }
  EXPECT_GT(invented, 10000u);
  EXPECT_LT(static_cast<double>(before), 0.01 * static_cast<double>(invented));
}

TEST(SceneBuilder, depth_that_is_asked_for_again_is_as_good_as_depth_that_is_held) {
  const Intrinsics small = intrinsics_from_fov(80, 64, 65);  // enlarged when it is observed
  const Pose start = pose_at(0, 0, -1, 0.1);
  Pose aside = turned(start, -0.2);
  aside.translation() += Eigen::Vector3d(-0.4, 0, 0.2);
  const std::vector<View> views = {box_world_view(small, start), box_world_view(small, aside),
                                   box_world_view(small, turned(start, 3.1))};
  SceneBuilder held(random_networks().all(), small, few_samples());
  SceneBuilder asked(random_networks().all(), small, few_samples());
  std::vector<int> calls(views.size(), 0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto number = static_cast<std::uint16_t>(i);
    held.observe(views[i], number);
    asked.observe(views[i], number, [&, i] {
      ++calls[i];
      return views[i].depth;
    });
  }
  Pose pose = turned(start, -0.3);
  pose.translation() += Eigen::Vector3d(0.4, 0, 0.2);
  const SupportView a = held.outpaint(pose, 3), b = asked.outpaint(pose, 3);
  EXPECT_GT(a.report.refused, 0u);
  EXPECT_EQ(a.report.refused, b.report.refused);
  EXPECT_EQ(cv::countNonZero(a.pixels != b.pixels), 0);
  EXPECT_EQ(calls, (std::vector<int>{1, 1, 0}));  // the last one looks the other way
}

TEST(SceneBuilder, what_is_outpainted_once_is_not_outpainted_again) {
  SceneBuilder scene = observed_scene();
  const Pose pose = turned(input_view().world_from_cam, 0.5);
  const SupportView first = scene.outpaint(pose, 1);
  scene.add(first, 1);
  const SupportView again = scene.outpaint(pose, 2);
  EXPECT_LT(again.report.missing_share, 0.05 * first.report.missing_share);
}

TEST(SceneBuilder, the_same_bytes_come_from_any_number_of_threads) {
  std::vector<Cloud> clouds;
  for (const int threads : {1, 3}) {
    set_threads(threads);
    SceneBuilder scene = observed_scene();
    scene.add(scene.outpaint(turned(input_view().world_from_cam, -0.5), 1), 1);
    clouds.push_back(scene.cloud());
  }
  set_threads(0);
  EXPECT_TRUE(same_points(clouds[0], clouds[1]));
}

TEST(SceneBuilder, stops_when_told_to_and_the_cloud_stays) {
  SceneOptions options = few_samples();
  options.outpaint.progress = [](double) { return false; };
  SceneBuilder scene = observed_scene(options);
  const std::size_t before = scene.cloud().size();
  const SupportView support = scene.outpaint(turned(input_view().world_from_cam, 0.5), 1);
  EXPECT_TRUE(support.view.color.empty());
  EXPECT_EQ(scene.add(support, 1).added, 0u);
  EXPECT_EQ(scene.cloud().size(), before);
}

TEST(ShowScene, views_whose_outpainting_was_stopped_are_of_the_cloud_alone) {
  SceneOptions options = few_samples();
  options.outpaint.progress = [](double) { return false; };
  const View input = input_view();
  for (const Strategy strategy : {Strategy::support, Strategy::sequential, Strategy::independent}) {
    PlanOptions plan;
    plan.strategy = strategy;
    plan.directions = {"left"};
    ShownScene shown = show_scene(input, plan_scene(input.world_from_cam, plan), strategy,
                                  random_networks().all(), options, {});
    EXPECT_EQ(outpainted_in(shown.scene.cloud()), 0u);
    ASSERT_FALSE(shown.views.empty());
    for (const ShownView& view : shown.views) {
      EXPECT_FALSE(view.image.empty()) << view.plan.name;
      EXPECT_EQ(view.report.best, -1);
    }
  }
}

TEST(SceneBuilder, a_tiny_photo_leaves_no_holes_in_its_own_view) {
  const Intrinsics tiny = intrinsics_from_fov(16, 16, 60);
  SceneBuilder scene(random_networks().all(), tiny, few_samples());
  const View view = box_world_view(tiny, pose_at(0, 0, -1, 0.1));
  scene.observe(view, 0);
  EXPECT_EQ(scene.outpaint(view.world_from_cam, 1).report.missing_share, 0);
}

TEST(ViewRenderer, without_a_network_a_view_is_what_the_cloud_shows) {
  SceneBuilder scene = observed_scene();
  const View input = input_view();
  SplatOptions options;
  options.renormalise = true;
  const RenderedView view =
      ViewRenderer(nullptr).render(scene.cloud(), kLens, input.world_from_cam);
  const Splat shown = closed_splat(scene.cloud(), kLens, input.world_from_cam, options);
  EXPECT_EQ(cv::norm(view.color, shown.color, cv::NORM_INF), 0);
}

TEST(ViewRenderer, what_is_known_is_shown_as_it_is) {
  SceneBuilder scene = observed_scene();
  const View input = input_view();
  const RenderedView view =
      ViewRenderer(&random_networks().refiner).render(scene.cloud(), kLens, input.world_from_cam);
  EXPECT_LT(view.missing_share, 0.001);
  SplatOptions narrow;
  narrow.radius = kFinestSplat;
  const Mask known = splat(scene.cloud(), kLens, input.world_from_cam, narrow).hit;
  EXPECT_GT(psnr(view.color, input.color, known), 40) << "it is the photo";
  EXPECT_GT(psnr(view.color, input.color), 32) << "with the edges, whose pixels are not lifted";
}

TEST(ViewRenderer, the_network_paints_only_what_is_missing) {
  SceneBuilder scene = observed_scene();
  const Pose pose = turned(input_view().world_from_cam, 0.4);
  const Image truth = box_world_view(kLens, pose).color;
  ViewRendererOptions bare;
  bare.as_published = true;
  const RenderedView view =
      ViewRenderer(&random_networks().refiner).render(scene.cloud(), kLens, pose);
  const RenderedView published =
      ViewRenderer(&random_networks().refiner, bare).render(scene.cloud(), kLens, pose);
  EXPECT_GT(view.missing_share, 0.1);
  EXPECT_LT(view.missing_share, 0.7);
  EXPECT_GT(psnr(view.color, truth, view.splat.hit), 25);
  EXPECT_GT(psnr(view.color, truth, view.splat.hit),
            psnr(published.color, truth, view.splat.hit) + 6);
  EXPECT_TRUE(cv::checkRange(view.color, true, nullptr, 0, 1.0001));
}

TEST(ViewRenderer, a_surface_that_comes_near_has_no_gaps) {
  SceneBuilder scene = observed_scene();
  Pose pose = input_view().world_from_cam;
  pose.translation() += pose.linear().col(2) * 1.2;  // a step towards what is ahead
  const RenderedView view =
      ViewRenderer(&random_networks().refiner).render(scene.cloud(), kLens, pose);
  const cv::Rect middle(60, 50, kLens.width - 120, kLens.height - 100);
  const Image truth = box_world_view(kLens, pose).color;
  EXPECT_GT(psnr(view.color(middle), truth(middle)), 25);
}

}  // namespace
}  // namespace ps
