// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/photo_matches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "libps/rooms/room.h"
#include "tests/support/pose_pairs.h"

namespace ps {
namespace {

Image room_photo(std::uint64_t seed) {
  const rooms::Room room(seed);
  rooms::CameraOptions options;
  options.width = 320;
  options.height = 240;
  return room_view(room, rooms::random_camera(room, seed, options)).color;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

TEST(MatchPhotos, finds_the_same_places_in_a_photo_turned_upside_down) {
  const Image photo = room_photo(3);
  Image turned;
  cv::rotate(photo, turned, cv::ROTATE_180);
  const std::vector<PixelMatch> matches = match_photos(photo, turned);
  ASSERT_GT(matches.size(), 50u);
  std::vector<double> across, down;
  for (const PixelMatch& m : matches) {
    across.push_back(m.first.x() + m.second.x() - (photo.cols - 1));
    down.push_back(m.first.y() + m.second.y() - (photo.rows - 1));
  }
  EXPECT_NEAR(median(across), 0, 0.05);
  EXPECT_NEAR(median(down), 0, 0.05);
}

TEST(MatchPhotos, knows_the_half_pixel_of_a_photo_of_another_size) {
  const Image photo = room_photo(3);
  Image half;
  cv::resize(photo, half, {}, 0.5, 0.5, cv::INTER_AREA);
  const std::vector<PixelMatch> matches = match_photos(photo, half);
  ASSERT_GT(matches.size(), 20u);
  std::vector<double> across, down;
  for (const PixelMatch& m : matches) {
    across.push_back((m.first.x() + 0.5) / 2 - 0.5 - m.second.x());
    down.push_back((m.first.y() + 0.5) / 2 - 0.5 - m.second.y());
  }
  EXPECT_NEAR(median(across), 0, 0.1);
  EXPECT_NEAR(median(down), 0, 0.1);
}

TEST(MatchPhotos, gives_the_same_bytes_each_time_and_for_any_number_of_threads) {
  const Image photo = room_photo(5);
  Image other;
  cv::rotate(photo, other, cv::ROTATE_90_CLOCKWISE);
  const std::vector<PixelMatch> once = match_photos(photo, other);
  ASSERT_GT(once.size(), 20u);
  const int threads = cv::getNumThreads();
  for (const int count : {1, 2}) {
    cv::setNumThreads(count);
    const std::vector<PixelMatch> again = match_photos(photo, other);
    ASSERT_EQ(again.size(), once.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
      EXPECT_EQ(again[i].first, once[i].first);
      EXPECT_EQ(again[i].second, once[i].second);
    }
  }
  cv::setNumThreads(threads);
}

TEST(MatchPhotos, no_pair_of_places_comes_twice) {
  const Image photo = room_photo(3);
  std::vector<std::array<double, 4>> pairs;
  for (const PixelMatch& m : match_photos(photo, photo)) {
    pairs.push_back({m.first.x(), m.first.y(), m.second.x(), m.second.y()});
  }
  std::sort(pairs.begin(), pairs.end());
  EXPECT_GT(pairs.size(), 100u);
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
}

TEST(MatchPhotos, finds_nothing_where_there_is_nothing) {
  const Image photo = room_photo(3);
  for (const Image& odd :
       {Image(), Image(1, 1, cv::Vec3f(1, 0, 0)), Image(200, 300, cv::Vec3f(0.5, 0.5, 0.5)),
        Image(8, 2000, cv::Vec3f(0, 0, 1)), Image(photo(cv::Rect(40, 40, 12, 12))),
        Image(200, 300, cv::Vec3f::all(std::numeric_limits<float>::quiet_NaN()))}) {
    EXPECT_TRUE(match_photos(photo, odd).empty()) << odd.size();
    EXPECT_TRUE(match_photos(odd, photo).empty()) << odd.size();
  }
}

}  // namespace
}  // namespace ps
