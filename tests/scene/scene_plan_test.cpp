// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/scene_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libps/core/error.h"

namespace ps {
namespace {

double angle_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

std::vector<std::string> names_of(const std::vector<ViewPlan>& views, bool outpainted_alone) {
  std::vector<std::string> names;
  for (const ViewPlan& view : views) {
    if (view.outpaint || !outpainted_alone) names.push_back(view.name);
  }
  return names;
}

TEST(ScenePlan, support_outpaints_the_extremes_alone) {
  const auto views = plan_scene(Pose::Identity());
  EXPECT_EQ(views.size(), 17u);
  EXPECT_EQ(names_of(views, true), direction_names());
  EXPECT_EQ(views.front().name, "input");
  EXPECT_FALSE(views.front().outpaint);
}

TEST(ScenePlan, extremes_are_those_of_the_paper) {
  for (const ViewPlan& view : plan_scene(Pose::Identity())) {
    const double angle = angle_between(Pose::Identity(), view.world_from_cam);
    if (view.name == "left" || view.name == "right") {
      EXPECT_NEAR(angle, 0.6, 1e-9);
    }
    if (view.name == "up" || view.name == "down") {
      EXPECT_NEAR(angle, 0.3, 1e-9);
    }
    if (view.name == "left_1") {
      EXPECT_NEAR(angle, 0.3, 1e-9);
    }
    if (view.name == "up-left") {
      const Eigen::Vector3d forward = view.world_from_cam.linear().col(2);
      EXPECT_NEAR(std::atan2(forward.x(), forward.z()), -0.3, 1e-9);
      EXPECT_NEAR(std::asin(-forward.y()), 0.15, 1e-9);
    }
  }
}

TEST(ScenePlan, sequential_outpaints_every_view_the_nearest_of_all_directions_first) {
  PlanOptions options;
  options.strategy = Strategy::sequential;
  options.directions = {"left", "up"};
  options.views_per_direction = 3;
  EXPECT_EQ(names_of(plan_scene(Pose::Identity(), options), true),
            (std::vector<std::string>{"left_1", "up_1", "left_2", "up_2", "left", "up"}));
  options.strategy = Strategy::independent;
  EXPECT_EQ(names_of(plan_scene(Pose::Identity(), options), true).size(), 6u);
}

TEST(ScenePlan, views_turn_about_a_point_ahead_when_asked_to) {
  PlanOptions options;
  options.range.orbit_radius = 2;
  const Eigen::Vector3d ahead(0, 0, 2);
  for (const ViewPlan& view : plan_scene(Pose::Identity(), options)) {
    EXPECT_LT((view.world_from_cam * ahead - ahead).norm(), 1e-9) << view.name;
  }
}

TEST(ScenePlan, unsound_options_are_refused) {
  const auto plan = [](const auto& change) {
    PlanOptions options;
    change(options);
    return plan_scene(Pose::Identity(), options);
  };
  EXPECT_THROW(plan([](auto& o) { o.directions = {"back"}; }), Error);
  EXPECT_THROW(plan([](auto& o) { o.directions = {"up", "up"}; }), Error);
  EXPECT_THROW(plan([](auto& o) { o.views_per_direction = 0; }), Error);
  EXPECT_THROW(plan([](auto& o) { o.range.range_vertical = 4; }), Error);
  EXPECT_THROW(strategy_of("best"), Error);
  EXPECT_EQ(plan([](auto& o) { o.directions = {}; }).size(), 1u) << "the input alone";
  EXPECT_EQ(strategy_of("independent"), Strategy::independent);
}

}  // namespace
}  // namespace ps
