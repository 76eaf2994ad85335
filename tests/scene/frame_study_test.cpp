// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/frame_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

const Intrinsics kCamera{100, 75, 80, 80, 49.5, 37};

std::vector<View> frames() {
  std::vector<View> views;
  for (const Pose& pose : box_world_walk(10)) views.push_back(box_world_view(kCamera, pose));
  return views;
}

ViewSource source_of(const std::vector<View>& views) {
  return {views.size(), [&views](std::size_t i) { return views[i]; }};
}

TEST(FrameStudy, finds_nothing_wrong_with_exact_frames) {
  FrameStudyOptions options;
  options.scales = true;
  const std::vector<View> views = frames();
  const FrameStudy study = study_frames(source_of(views), options);
  EXPECT_LT(study.spread, .007) << "so that the tolerance stays";
  for (const FrameWord& word : study.words) {
    EXPECT_FALSE(word.refused);
    EXPECT_LT(word.contradicted, .02);
    EXPECT_NEAR(word.scale, 1, 5e-3);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(word.gain[c], 1, .02);
  }
}

TEST(FrameStudy, gains_undo_exposures_and_heeding_applies_them) {
  const std::vector<View> exact = frames();
  std::vector<View> views = frames();
  for (std::size_t i = 0; i < views.size(); ++i) views[i].color *= i % 2 == 0 ? .8 : 1 / .8;
  const FrameStudy study = study_frames(source_of(views));
  const std::vector<FrameWord>& words = study.words;
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_NEAR(words[i].gain[1], i % 2 == 0 ? 1 / .8 : .8, .05) << i;
  }
  const View heeded = heeding(source_of(views), study).load(3);
  EXPECT_LT(cv::norm(heeded.color, exact[3].color, cv::NORM_L1) /
                static_cast<double>(3 * exact[3].color.total()),
            .02);
  EXPECT_NEAR(views[3].color(10, 10)[0], exact[3].color(10, 10)[0] / .8, 1e-6)
      << "the source's own frame stays";
}

TEST(FrameStudy, scales_undo_factors_of_depth) {
  std::vector<View> views = frames();
  for (std::size_t i = 0; i < views.size(); ++i) views[i].depth *= i % 2 == 0 ? 1.05 : 1 / 1.05;
  FrameStudyOptions options;
  options.scales = true;
  const FrameStudy study = study_frames(source_of(views), options);
  const std::vector<FrameWord>& words = study.words;
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_NEAR(words[i].scale, i % 2 == 0 ? 1 / 1.05 : 1.05, .015) << i;
  }
}

TEST(FrameStudy, a_lost_frame_is_refused_and_no_other) {
  std::vector<View> views = frames();
  views[0].world_from_cam.translation().z() -= .8;  // even where it is the first
  views[0].world_from_cam.rotate(Eigen::AngleAxisd(.5, Eigen::Vector3d::UnitY()));
  const FrameStudy study = study_frames(source_of(views));
  const std::vector<FrameWord>& words = study.words;
  EXPECT_TRUE(words[0].refused) << words[0].contradicted;
  for (std::size_t i = 1; i < words.size(); ++i) EXPECT_FALSE(words[i].refused) << i;
  const ViewSource heeded = heeding(source_of(views), study);
  EXPECT_TRUE(heeded.load(0).depth.empty());
  EXPECT_FALSE(heeded.load(1).depth.empty());
}

/// Turned by 20 degrees and moved, each in a direction of its own.
void lose(View* view, int number) {
  const double angle = 2.4 * number;
  const Eigen::Vector3d axis(std::cos(angle), std::sin(angle), .3 * std::sin(3 * angle));
  view->world_from_cam.translation() += .4 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle));
  view->world_from_cam.rotate(Eigen::AngleAxisd(.35, axis.normalized()));
}

TEST(FrameStudy, two_fifths_of_the_frames_may_be_lost) {
  std::vector<View> views = frames();
  for (const int i : {1, 3, 6, 7}) lose(&views[static_cast<std::size_t>(i)], i);
  const FrameStudy study = study_frames(source_of(views));
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(study.words[i].refused, i == 1 || i == 3 || i == 6 || i == 7)
        << i << ": " << study.words[i].contradicted;
  }
}

/// As where tracking jumps: they agree with each other.
TEST(FrameStudy, frames_lost_together_at_an_end_are_refused) {
  std::vector<View> views;
  for (const Pose& pose : box_world_walk(40)) views.push_back(box_world_view(kCamera, pose));
  const Pose jump =
      Eigen::Translation3d(0, 0, -.8) * Pose(Eigen::AngleAxisd(.5, Eigen::Vector3d::UnitY()));
  for (std::size_t i = 0; i < 6; ++i) views[i].world_from_cam = jump * views[i].world_from_cam;
  const FrameStudy study = study_frames(source_of(views));
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(study.words[i].refused, i < 6) << i << ": " << study.words[i].contradicted;
  }
}

TEST(FrameStudy, camps_that_differ_in_scale_alone_are_evened_out) {
  std::vector<View> views = frames();
  const double scales[] = {.85, 1, 1.18};
  for (std::size_t i = 0; i < views.size(); ++i) views[i].depth *= scales[i % 3];
  FrameStudyOptions options;
  options.scales = false;
  EXPECT_TRUE(study_frames(source_of(views), options).gave_up);
  options.scales = true;
  const FrameStudy study = study_frames(source_of(views), options);
  EXPECT_FALSE(study.gave_up);
  double sum = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_FALSE(study.words[i].refused);
    sum += std::log(study.words[i].scale);
    EXPECT_NEAR(study.words[i].scale * scales[i % 3], study.words[0].scale * scales[0], .03) << i;
  }
  EXPECT_NEAR(sum, 0, 1e-6) << "on the average they stay";
}

TEST(FrameStudy, says_nothing_where_nearly_all_frames_are_lost) {
  std::vector<View> views = frames();
  for (int i = 0; i < 8; ++i) lose(&views[static_cast<std::size_t>(i)], i);
  const FrameStudy study = study_frames(source_of(views));
  EXPECT_TRUE(study.gave_up);
  EXPECT_EQ(study.spread, 0) << "so that the tolerance stays";
  for (const FrameWord& word : study.words) {
    EXPECT_FALSE(word.refused);
    EXPECT_EQ(word.scale, 1);
    EXPECT_GT(word.contradicted, .1) << "of all pairs";
  }
}

/// Has something stand before this share of the pixels, from that one on.
void cover(View* view, double share, double from) {
  const auto total = static_cast<double>(view->depth.total());
  for (int k = 0; k < static_cast<int>(share * total); ++k) {
    const int i = (static_cast<int>(from * total) + k) % static_cast<int>(total);
    view->depth(i / view->depth.cols, i % view->depth.cols) *= .6f;
  }
}

bool any_refused(const FrameStudy& study) {
  return std::any_of(study.words.begin(), study.words.end(),
                     [](const FrameWord& word) { return word.refused; });
}

TEST(FrameStudy, gives_up_where_half_would_be_refused) {
  std::vector<View> views = frames();
  // Each stands out once the worse ones are gone.
  const double shares[] = {.6, .3, .15, .08, .04};
  for (std::size_t i = 0; i < 5; ++i) cover(&views[2 * i], shares[i], .3);
  FrameStudyOptions options;
  options.contradicted = 0;
  const FrameStudy study = study_frames(source_of(views), options);
  EXPECT_TRUE(study.gave_up);
  EXPECT_FALSE(any_refused(study));
  EXPECT_EQ(study.spread, 0);
  options.refuse = false;
  const FrameStudy all = study_frames(source_of(views), options);
  EXPECT_FALSE(all.gave_up);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(study.words[i].gain, cv::Vec3f(1, 1, 1));
    EXPECT_EQ(study.words[i].scale, 1);
    EXPECT_EQ(study.words[i].contradicted, all.words[i].contradicted)
        << "of all pairs, not of those that refusing had left";
  }
  for (std::size_t i = 2; i < 5; ++i) views[2 * i] = frames()[2 * i];
  EXPECT_TRUE(any_refused(study_frames(source_of(views)))) << "two of ten are not half";
}

TEST(FrameStudy, frames_without_depth_or_whose_partners_are_refused_are_not_alone) {
  std::vector<View> views = frames();
  views[2] = View();
  for (const int i : {1, 6}) lose(&views[static_cast<std::size_t>(i)], i);
  const FrameStudy study = study_frames(source_of(views));
  EXPECT_TRUE(any_refused(study));
  for (const FrameWord& word : study.words) EXPECT_FALSE(word.alone);
}

TEST(FrameStudy, a_frame_far_from_the_others_is_alone) {
  std::vector<View> views = frames();
  views[6].world_from_cam.translation().x() += 50;
  const FrameStudy study = study_frames(source_of(views));
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(study.words[i].alone, i == 6) << i;
}

TEST(FrameStudy, frames_without_a_pair_are_not_what_is_usual) {
  std::vector<View> views = frames();
  for (std::size_t i = 0; i < views.size(); ++i) {
    cover(&views[i], .3, .1 * static_cast<double>(i));
  }
  views.resize(30);
  const FrameStudy study = study_frames(source_of(views));
  EXPECT_GT(study.words[5].contradicted, FrameStudyOptions().contradicted);
  EXPECT_FALSE(any_refused(study)) << "none is worse than the others";
  EXPECT_FALSE(study.gave_up);
}

TEST(FrameStudy, spread_is_that_of_noise_and_widens_the_tolerance) {
  std::vector<View> views = frames();
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (int y = 0; y < kCamera.height; ++y) {
      for (int x = 0; x < kCamera.width; ++x) {
        const double any = std::sin(12.9898 * x + 78.233 * y + 3.7 * static_cast<double>(i));
        views[i].depth(y, x) *= static_cast<float>(1 + .06 * any);
      }
    }
  }
  const FrameStudy study = study_frames(source_of(views));
  EXPECT_GT(study.spread, .02);
  EXPECT_LT(study.spread, .1);
  EXPECT_EQ(heeding(FuseOptions(), study).cloud.tolerance_relative, 2 * study.spread);
  EXPECT_EQ(heeding(FuseOptions(), FrameStudy()).cloud.tolerance_relative,
            FuseOptions().cloud.tolerance_relative);
}

TEST(FrameStudy, words_do_not_depend_on_threads) {
  const std::vector<View> views = frames();
  FrameStudyOptions options;
  options.scales = true;
  set_threads(1);
  const std::vector<FrameWord> one = study_frames(source_of(views), options).words;
  set_threads(3);
  const std::vector<FrameWord> three = study_frames(source_of(views), options).words;
  set_threads(0);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].gain, three[i].gain);
    EXPECT_EQ(one[i].scale, three[i].scale);
    EXPECT_EQ(one[i].contradicted, three[i].contradicted);
  }
}

TEST(FrameStudy, takes_empty_frames_and_none_at_all) {
  EXPECT_TRUE(study_frames(ViewSource{}).words.empty());
  EXPECT_EQ(study_frames(ViewSource{}).spread, 0);
  std::vector<View> views = frames();
  views.resize(3);
  views[1] = View();
  const FrameStudy study = study_frames(source_of(views));
  const std::vector<FrameWord>& words = study.words;
  EXPECT_EQ(words[1].gain, cv::Vec3f(1, 1, 1));
  EXPECT_FALSE(words[1].refused);
  EXPECT_TRUE(heeding(source_of(views), study).load(1).depth.empty());
}

TEST(FrameStudy, a_frame_of_lone_depths_alone_is_left_out) {
  std::vector<View> views = frames();
  Depth& depth = views[4].depth;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      // Of 25 depths around a pixel no two agree within 5 %.
      depth(y, x) = static_cast<float>(.5 * std::pow(1.12, 5 * (y % 5) + x % 5));
    }
  }
  const ViewSource source = source_of(views);
  const FrameStudy study = study_frames(source);
  EXPECT_TRUE(heeding(source, study).load(4).depth.empty());
  FuseReport report;
  EXPECT_FALSE(fuse(heeding(source, study), FuseOptions(), &report).empty());
  EXPECT_EQ(report.empty, 1u);
  EXPECT_EQ(report.views, views.size() - 1);
}

TEST(FrameStudy, unsound_options_and_words_are_refused) {
  const std::vector<View> views = frames();
  FrameStudyOptions options;
  options.width = 1;
  EXPECT_THROW(study_frames(source_of(views), options), Error);
  EXPECT_THROW(study_frames(ViewSource{2, {}}), Error);
  EXPECT_THROW(heeding(source_of(views), FrameStudy()), Error);
}

}  // namespace
}  // namespace ps
