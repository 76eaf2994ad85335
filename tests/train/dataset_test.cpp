// SPDX-License-Identifier: BSD-3-Clause
// Which examples are drawn.
#include "libps/train/dataset.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <set>

#include "libps/train/parameters.h"
#include "libps/train/stage.h"
#include "tests/train/support.h"

namespace ps::train {
namespace {

/// Pairs of grey pictures of 16 x 16 pixels, turned by so many radians; without poses when `posed`
/// is false.
TensorMap shard_of(const std::vector<float>& turns, bool posed = true) {
  const std::size_t n = turns.size();
  const auto bytes = [](std::vector<std::size_t> shape) {
    std::size_t count = 1;
    for (const std::size_t side : shape) count *= side;
    return FileTensor::of(std::vector<std::uint8_t>(count, 128), std::move(shape));
  };
  TensorMap shard = {{"color", bytes({2 * n, 16, 16, 3})},
                     {"kind", bytes({2 * n})},
                     {"splat", bytes({n, 16, 16, 3})},
                     {"flags", bytes({n, 16, 16})}};
  shard["depth"] = {"F16", {2 * n, 16, 16}, std::vector<std::byte>(n * 1024)};
  shard["focal"] = FileTensor::of(std::vector<float>(2 * n, 1), {2 * n});
  std::vector<std::int32_t> order;
  std::vector<float> pose;
  for (const float turn : turns) {
    for (int cell = 0; cell < 4; ++cell) order.push_back(cell);
    const float c = std::cos(turn), s = std::sin(turn);
    for (const float value : {c, 0.f, s, .1f, 0.f, 1.f, 0.f, 0.f, -s, 0.f, c, 0.f}) {
      pose.push_back(value);
    }
  }
  shard["order"] = FileTensor::of(order, {n, 4});
  if (!posed) return shard;
  shard["pose"] = FileTensor::of(pose, {n, 12});
  shard["lens"] = FileTensor::of(std::vector<float>(8 * n, 16), {2 * n, 4});
  return shard;
}

std::set<std::int64_t> drawn(const Dataset& data, bool targets, double most_turn) {
  const auto all = data.draw(400, std::vector<double>(data.groups().size(), 1), targets,
                             generator_of(1, 2), most_turn);
  EXPECT_EQ(all.size(), 400u);
  return {all.begin(), all.end()};
}

TEST(Dataset, draws_no_pair_that_is_turned_more_than_the_limit_and_all_that_are_less) {
  const Folder folder;
  write_shard(folder, "rooms-0000", shard_of({.5f, .1f, -.3f}));
  write_shard(folder, "rooms-0001", shard_of({.2f, 0.f}));
  const Dataset data(folder.path());
  EXPECT_NEAR(data.most_turn(), .5, 1e-6);
  using Set = std::set<std::int64_t>;
  EXPECT_EQ(drawn(data, true, .25), (Set{3, 7, 9}));
  EXPECT_EQ(drawn(data, false, .25), (Set{2, 3, 6, 7, 8, 9}));
  EXPECT_EQ(drawn(data, true, .35), (Set{3, 5, 7, 9}));
  EXPECT_EQ(drawn(data, true, data.most_turn()), (Set{1, 3, 5, 7, 9}));
  EXPECT_EQ(drawn(data, true, Dataset::kAnyTurn), (Set{1, 3, 5, 7, 9}));
}

TEST(Dataset, draws_the_least_turned_of_a_group_where_all_are_turned_more) {
  const Folder folder;
  write_shard(folder, "frames-0000", shard_of({.6f, .4f}));
  write_shard(folder, "rooms-0000", shard_of({.1f}));
  EXPECT_EQ(drawn(Dataset(folder.path()), true, .2), (std::set<std::int64_t>{3, 5}));
}

TEST(Dataset, old_examples_know_no_turn_and_are_drawn_as_ever) {
  const Folder folder;
  write_shard(folder, "rooms-0000", shard_of({.6f, .4f, .1f}, false));
  const Dataset data(folder.path());
  EXPECT_EQ(data.most_turn(), 0);
  EXPECT_FALSE(data.posed());
  for (const bool targets : {false, true}) {
    EXPECT_EQ(data.draw(50, {1}, targets, generator_of(3, 0), 0),
              data.draw(50, {1}, targets, generator_of(3, 0)));
  }
}

TEST(Curriculum, grows_from_one_part_to_all_in_equal_steps_of_equal_length) {
  std::map<double, int> lengths;
  double last = 0;
  for (int step = 0; step < 100; ++step) {
    const double limit = turn_limit(step, 100, 5, .75);
    EXPECT_GE(limit, last);
    ++lengths[last = limit];
  }
  ASSERT_EQ(lengths.size(), 5u);
  double expected = 0;
  for (const auto& [limit, length] : lengths) {
    EXPECT_NEAR(limit, expected += .15, 1e-12);
    EXPECT_EQ(length, 20);
  }
  EXPECT_EQ(last, .75);  // exactly: the pair that is turned most is drawn at the end
  EXPECT_EQ(turn_limit(0, 100, 0, .75), Dataset::kAnyTurn);
}

}  // namespace
}  // namespace ps::train
