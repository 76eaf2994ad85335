// SPDX-License-Identifier: BSD-3-Clause
// Poses between real RGB-D frames (../shared/rgbd/walk; skipped where that is not there).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "io/rgbd_folder.h"
#include "libps/core/error.h"
#include "libps/geometry/overlap.h"
#include "libps/geometry/relative_pose.h"
#include "tests/support/pose_pairs.h"

namespace ps {
namespace {

class SecondPoseWalk : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path path = PS_SHARED_DIR "/rgbd/walk";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    folder_ = open_rgbd_folder(path);
  }

  View frame(std::size_t i) const {
    return load_frame(folder_, folder_.frames[i % folder_.frames.size()]);
  }

  RgbdFolder folder_;
};

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST_F(SecondPoseWalk, frames_near_each_other_are_found_with_measured_and_with_guessed_depth) {
  for (const double wrong : {0.0, 0.15}) {
    std::vector<double> degrees, metres, scale;
    for (std::size_t i = 0; i + 5 < folder_.frames.size(); i += 36) {
      View first = frame(i);
      const View second = frame(i + 5);
      if (wrong > 0) first.depth = guessed_depth(first.depth, wrong, i);
      try {
        const SecondPose found =
            find_second_pose(first, second.color, second.intrinsics, second.depth);
        const PoseError error = pose_error(found.world_from_cam, second.world_from_cam);
        degrees.push_back(error.degrees);
        metres.push_back(error.metres);
        scale.push_back(found.depth_scale);
      } catch (const Error&) {
        continue;  // blurred, or turned away: the frames are few and the walk is fast
      }
    }
    ASSERT_GE(degrees.size(), 6u);
    std::printf("depth wrong by %.2f: %zu pairs, median %.2f degrees, %.3f m, depth scale %.3f\n",
                wrong, degrees.size(), middle(degrees), middle(metres), middle(scale));
    EXPECT_LT(middle(degrees), wrong > 0 ? 1.5 : 0.6);
    EXPECT_LT(middle(metres), wrong > 0 ? 0.15 : 0.04);
    EXPECT_NEAR(middle(scale), 1, wrong > 0 ? 0.15 : 0.01);
  }
}

TEST_F(SecondPoseWalk, frames_that_share_nothing_are_refused) {
  int unrelated = 0;
  for (std::size_t k = 0; unrelated < 24; ++k) {
    const View first = frame(7919 * k), second = frame(104729 * k + 50);
    // Neither sees a place of the other, near the surface that is there.
    const auto meets = [](const View& a, const View& b) {
      const std::vector<DepthRatio> ratios = depth_ratios(a, b, 5000);
      return std::any_of(ratios.begin(), ratios.end(),
                         [](const DepthRatio& r) { return std::abs(r.log_ratio) < 0.3; });
    };
    if (meets(first, second) || meets(second, first)) continue;
    ++unrelated;
    EXPECT_THROW(find_second_pose(first, second.color, second.intrinsics), Error) << k;
  }
}

}  // namespace
}  // namespace ps
