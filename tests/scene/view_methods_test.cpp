// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/view_methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/image_metrics.h"
#include "libps/models/color_codes.h"
#include "tests/support/box_world.h"
#include "tests/support/random_networks.h"

namespace ps {
namespace {

const Intrinsics kLens = intrinsics_from_fov(320, 256, 65);
const Intrinsics kOther = intrinsics_from_fov(280, 240, 58);

View input_view() { return box_world_view(kLens, pose_at(0, 0, -1, 0.1)); }

Pose turned_pose() { return pose_at(0.1, 0, -1, 0.55); }

/// Likes bright pictures.
outpaint::Scorer brightness(bool higher_is_better) {
  return {"brightness", higher_is_better, [](const nn::TensorView& image, nn::Workspace&) {
            double sum = 0;
            const std::size_t count = image.shape.pixels() * 3;
            for (std::size_t i = 0; i < count; ++i) sum += image.data[i];
            return sum / static_cast<double>(count);
          }};
}

MethodNetworks method_networks() {
  MethodNetworks networks;
  networks.scene = random_networks().all();
  networks.scorers = {{"classifier", brightness(false)}, {"discriminator", brightness(true)}};
  static const models::Autoencoder kColors(models::color_codes());
  static const models::PixelCnn kOfColors(models::random_pixel_cnn(11, kColors.codes()));
  networks.rgb.autoencoder = &kColors;
  networks.rgb.pixel_cnn = &kOfColors;
  return networks;
}

ViewMethodOptions few_samples() {
  ViewMethodOptions options;
  options.scene.outpaint.samples = 2;
  return options;
}

MethodView shown_by(const std::string& name, const ViewMethodOptions& options = few_samples(),
                    const Intrinsics& lens = kOther) {
  return make_view_method(name, method_networks(), options)
      ->show(input_view(), lens, turned_pose());
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

class EachViewMethod : public testing::TestWithParam<std::string> {};

TEST_P(EachViewMethod, shows_what_is_seen_as_it_is_and_leaves_no_hole) {
  const MethodView view = shown_by(GetParam());
  ASSERT_EQ(view.color.size(), cv::Size(kOther.width, kOther.height));
  ASSERT_EQ(view.seen.size(), view.color.size());
  EXPECT_TRUE(cv::checkRange(view.color, true, nullptr, 0, 1.0001));
  const double seen = cv::mean(view.seen)[0];
  if (GetParam() == "copy") {
    EXPECT_EQ(seen, 0);
    return;
  }
  EXPECT_GT(seen, 0.4);
  EXPECT_LT(seen, 0.9);
  const Image truth = box_world_view(kOther, turned_pose()).color;
  // The network's whole picture is softer than the cloud.
  EXPECT_GT(psnr(view.color, truth, view.seen), GetParam() == "independent" ? 18 : 25);
}

INSTANTIATE_TEST_SUITE_P(ViewMethods, EachViewMethod, testing::ValuesIn(view_method_names()),
                         [](const auto& method) {
                           std::string name = method.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(ViewMethods, give_the_same_bytes_from_any_number_of_threads) {
  for (const char* name : {"ours", "independent", "no-outpainter", "telea", "nearest"}) {
    set_threads(1);
    const MethodView one = shown_by(name);
    set_threads(3);
    const MethodView three = shown_by(name);
    set_threads(0);
    EXPECT_TRUE(same_bytes(one.color, three.color)) << name;
    EXPECT_TRUE(same_bytes(one.seen, three.seen)) << name;
  }
}

TEST(ViewMethods, a_copy_through_the_same_lens_is_the_input) {
  EXPECT_TRUE(same_bytes(shown_by("copy", few_samples(), kLens).color, input_view().color));
}

TEST(ViewMethods, a_copy_through_another_lens_has_its_field_of_view) {
  const View wider = box_world_view(kLens, turned_pose());
  const Image truth = box_world_view(kOther, turned_pose()).color;
  const MethodView view = make_view_method("copy", {}, {})->show(wider, kOther, turned_pose());
  EXPECT_GT(psnr(view.color, truth), 30);
}

TEST(ViewMethods, each_scorer_chooses_by_itself) {
  ViewMethodOptions options = few_samples();
  options.scene.outpaint.samples = 6;
  const auto brightness_of = [&](const char* name) {
    return cv::sum(cv::mean(shown_by(name, options).color))[0];
  };
  // Of the same six completions one keeps the darkest, the other the brightest.
  EXPECT_LT(brightness_of("by-classifier"), brightness_of("by-discriminator"));
}

TEST(ViewMethods, one_completion_is_ours_with_one_sample) {
  ViewMethodOptions one = few_samples();
  one.scene.outpaint.samples = 1;
  ViewMethodOptions settled;
  settled.scene.outpaint.until_settled = true;
  EXPECT_TRUE(same_bytes(shown_by("one-completion", settled).color, shown_by("ours", one).color));
}

TEST(ViewMethods, a_step_of_less_than_fifteen_degrees_is_not_divided) {
  const Pose near = pose_at(0, 0, -1, 0.3);
  const auto at = [&](const char* name) {
    return make_view_method(name, method_networks(), few_samples())
        ->show(input_view(), kOther, near)
        .color;
  };
  EXPECT_TRUE(same_bytes(at("sequential"), at("ours")));
  EXPECT_FALSE(same_bytes(shown_by("sequential").color, shown_by("ours").color));
}

TEST(ViewMethods, a_method_shows_the_same_again) {
  const auto method = make_view_method("ours", method_networks(), few_samples());
  const Image first = method->show(input_view(), kOther, turned_pose()).color;
  method->show(input_view(), kOther, pose_at(0, 0, -1, -0.3));
  EXPECT_TRUE(same_bytes(method->show(input_view(), kOther, turned_pose()).color, first));
}

TEST(ViewMethods, stop_when_told_to) {
  ViewMethodOptions options = few_samples();
  options.scene.outpaint.progress = [](double) { return false; };
  EXPECT_TRUE(shown_by("ours", options).color.empty());
}

std::string message_of(const std::string& name, const MethodNetworks& networks) {
  try {
    make_view_method(name, networks, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ViewMethods, an_unknown_name_is_told_the_choices) {
  const std::string message = message_of("best", {});
  EXPECT_NE(message.find("'best'"), std::string::npos);
  for (const std::string& name : view_method_names()) {
    EXPECT_NE(message.find(name), std::string::npos) << name;
  }
  EXPECT_THROW(needs_networks("best"), Error);
}

TEST(ViewMethods, missing_networks_are_told_and_others_do_without) {
  for (const std::string& name : view_method_names()) {
    EXPECT_EQ(message_of(name, {}).empty(), !needs_networks(name)) << name;
  }
  MethodNetworks networks = method_networks();
  networks.rgb = {};
  networks.scorers.clear();
  EXPECT_NE(message_of("rgb", networks).find("rgb.safetensors"), std::string::npos);
  EXPECT_NE(message_of("by-classifier", networks).find("no classifier"), std::string::npos);
  EXPECT_NE(message_of("by-both", networks).find("no classifier"), std::string::npos);
  EXPECT_EQ(message_of("by-likelihood", networks), "");
}

}  // namespace
}  // namespace ps
