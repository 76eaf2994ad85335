// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/hole_fill.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"

namespace ps {
namespace {

constexpr HoleFill kFills[] = {HoleFill::mean_colour, HoleFill::nearest, HoleFill::telea,
                               HoleFill::navier_stokes};

/// Red on the left, blue on the right of column 20; green in the hole.
struct Case {
  Image picture = Image(32, 40);
  Mask seen = Mask::ones(32, 40);
  Case() {
    picture(cv::Rect(0, 0, 20, 32)).setTo(cv::Scalar(1, 0, 0));
    picture(cv::Rect(20, 0, 20, 32)).setTo(cv::Scalar(0, 0, 1));
  }
  void hole(const cv::Rect& where) {
    picture(where).setTo(cv::Scalar(0, 1, 0));
    seen(where).setTo(0);
  }
};

TEST(HoleFill, what_is_seen_stays_and_nothing_of_a_hole_does) {
  Case c;
  c.hole({12, 8, 9, 11});
  for (const HoleFill fill : kFills) {
    const Image out = filled(c.picture, c.seen, fill);
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 40; ++x) {
        if (c.seen(y, x)) {
          EXPECT_EQ(out(y, x), c.picture(y, x));
        } else {
          EXPECT_LT(out(y, x)[1], 0.01f) << "no green";
          EXPECT_GT(out(y, x)[0] + out(y, x)[2], 0.9f) << "but red and blue";
        }
      }
    }
  }
}

TEST(HoleFill, nearest_takes_each_side_from_its_own_edge) {
  Case c;
  c.hole({10, 0, 21, 32});
  const Image out = filled(c.picture, c.seen, HoleFill::nearest);
  EXPECT_EQ(out(16, 12), cv::Vec3f(1, 0, 0));
  EXPECT_EQ(out(16, 28), cv::Vec3f(0, 0, 1));
}

TEST(HoleFill, the_mean_is_of_what_is_seen) {
  Case c;
  c.hole({10, 0, 30, 32});
  const Image out = filled(c.picture, c.seen, HoleFill::mean_colour);
  EXPECT_EQ(out(16, 30), cv::Vec3f(1, 0, 0));
}

TEST(HoleFill, where_nothing_is_seen_all_is_grey) {
  Case c;
  c.hole({0, 0, 40, 32});
  for (const HoleFill fill : kFills) {
    EXPECT_EQ(filled(c.picture, c.seen, fill)(5, 5), cv::Vec3f(.5f, .5f, .5f));
  }
}

TEST(HoleFill, refuses_a_mask_of_another_size) {
  EXPECT_THROW(filled(Image(4, 4), Mask(4, 5), HoleFill::nearest), Error);
}

}  // namespace
}  // namespace ps
