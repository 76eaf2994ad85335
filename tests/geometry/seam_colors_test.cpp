// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/seam_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr int kSide = 160, kSeam = 60;

/// A wavy picture, of which what is right of a column is missing.
struct Case {
  Image seen = Image(kSide, kSide);
  Mask missing = Mask::zeros(kSide, kSide);

  Case() {
    missing(cv::Rect(kSeam, 0, kSide - kSeam, kSide)) = 1;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const auto wave = [&](float f) { return 0.5f + 0.2f * std::sin(f * x) * std::cos(f * y); };
        seen(y, x) = {wave(0.05f), wave(0.07f), wave(0.03f)};
      }
    }
  }

  /// Painted with an error.
  Image painted(const cv::Vec3f& error) const {
    Image picture = seen.clone();
    for (cv::Vec3f& color : picture) color += error;
    return picture;
  }
};

/// The mean difference over a column.
double apart(const Image& a, const Image& b, int column) {
  return cv::norm(a.col(column), b.col(column), cv::NORM_L1) / (3 * a.rows);
}

TEST(SeamColors, an_error_is_gone_at_the_seam_and_stays_far_from_it) {
  const Case c;
  const Image painted = c.painted({0.1f, -0.1f, 0.1f});
  SeamColorOptions options;
  options.decay = 12;
  const Image out = continue_colors(c.seen, painted, c.missing, options);
  EXPECT_LT(apart(out, c.seen, kSeam), 0.02);
  EXPECT_GT(apart(out, c.seen, kSide - 1), 0.098);
  double last = apart(out, c.seen, kSeam + 3);
  for (int x = kSeam + 4; x < kSide; ++x) {
    EXPECT_GE(apart(out, c.seen, x), last - 1e-3) << x;
    last = apart(out, c.seen, x);
  }
}

TEST(SeamColors, an_edge_at_the_seam_stays_one) {
  Case c;
  c.seen = cv::Vec3f(0.1f, 0.1f, 0.1f);
  const Image painted = c.painted({0.8f, 0.8f, 0.8f});
  const Image out = continue_colors(c.seen, painted, c.missing);
  EXPECT_LT(apart(out, painted, kSeam), 0.05);
}

TEST(SeamColors, what_is_seen_stays_and_values_stay_colours) {
  const Case c;
  const Image out =
      continue_colors(c.seen, c.painted({0.35f, -0.35f, 0.0f}), c.missing, {8, 5, 10});
  const cv::Rect left(0, 0, kSeam, kSide);
  EXPECT_EQ(cv::norm(out(left), c.painted({0.35f, -0.35f, 0})(left), cv::NORM_INF), 0);
  EXPECT_TRUE(
      cv::checkRange(out(cv::Rect(kSeam, 0, kSide - kSeam, kSide)), true, nullptr, 0, 1.001));
}

TEST(SeamColors, without_a_seam_nothing_changes) {
  const Case c;
  const Image painted = c.painted({0.1f, 0, 0});
  for (const int value : {0, 1}) {
    const Mask missing(kSide, kSide, static_cast<std::uint8_t>(value));
    EXPECT_EQ(cv::norm(continue_colors(c.seen, painted, missing), painted, cv::NORM_INF), 0);
  }
}

TEST(SeamColors, are_the_same_bytes_for_any_number_of_threads) {
  const Case c;
  set_threads(1);
  const Image one = continue_colors(c.seen, c.painted({0.1f, 0, 0}), c.missing);
  set_threads(3);
  const Image three = continue_colors(c.seen, c.painted({0.1f, 0, 0}), c.missing);
  set_threads(0);
  EXPECT_EQ(std::memcmp(one.data, three.data, one.total() * sizeof(cv::Vec3f)), 0);
}

TEST(SeamColors, errors_say_what_is_wrong) {
  const Case c;
  EXPECT_THROW(continue_colors(Image(), Image(), Mask()), Error);
  EXPECT_THROW(continue_colors(c.seen, c.seen, Mask::zeros(3, 3)), Error);
  EXPECT_THROW(continue_colors(c.seen, c.seen, c.missing, {0, 3, 0.2}), Error);
  EXPECT_THROW(continue_colors(c.seen, c.seen, c.missing, {8, 0, 0.2}), Error);
  EXPECT_THROW(continue_colors(c.seen, c.seen, c.missing, {8, 3, 0}), Error);
}

}  // namespace
}  // namespace ps
