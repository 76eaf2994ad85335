// SPDX-License-Identifier: BSD-3-Clause
// The parts of the budget against obvious loops over everything.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "libps/core/random.h"
#include "libps/scene/cell_table.h"
#include "libps/scene/merge.h"
#include "libps/scene/sample.h"
#include "tests/support/box_world.h"

namespace ps {
namespace {

float random_in(float low, float high, std::uint32_t i, std::uint32_t what) {
  return low + (high - low) * static_cast<float>(random_unit(3, {i, what, 0, 0}));
}

/// Points all around, most of them near the middle.
Cloud random_cloud(std::uint32_t count) {
  Cloud cloud;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float size = std::pow(10.f, random_in(-2, 1, i, 9));
    Point p;
    p.x = random_in(-size, size, i, 0);
    p.y = random_in(-size, size, i, 1);
    p.z = random_in(-size, size, i, 2);
    p.origin = i % 5 == 0;
    cloud.push_back(p);
  }
  return cloud;
}

TEST(SeenSamples, know_the_finest_view_as_a_loop_over_all_views_does) {
  const Cloud cloud = random_cloud(20000);
  std::vector<PlannedView> views;
  for (const Pose& pose : box_world_walk(40)) {
    const double f = 60 + 7.0 * static_cast<double>(views.size());
    views.push_back({{160, 120, f, 1.1 * f, 70, 50}, pose});
  }
  std::vector<std::uint32_t> unseen;
  const std::vector<Sample> samples = seen_samples(cloud, views, 4, &unseen);
  EXPECT_EQ(samples.size() + unseen.size(), cloud.size());
  EXPECT_GT(samples.size(), 1000u);
  EXPECT_GT(unseen.size(), 1000u);
  std::vector<float> pixel(cloud.size(), std::numeric_limits<float>::infinity());
  for (const Sample& s : samples) pixel[s.point] = s.pixel;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    double finest = std::numeric_limits<double>::infinity();
    for (const PlannedView& view : views) {
      const Eigen::Vector3d p =
          view.world_from_cam.inverse() * cloud[i].getVector3fMap().cast<double>();
      const Eigen::Vector2d uv = view.intrinsics.project(p);
      const bool seen =
          p.z() > 1e-3 && uv.x() >= -4 && uv.y() >= -4 && uv.x() <= 163 && uv.y() <= 123;
      if (seen) finest = std::min(finest, p.z() / view.intrinsics.fy);
    }
    EXPECT_EQ(pixel[i], static_cast<float>(finest)) << i;
  }
}

/// Samples of a thin sheet whose pixel grows with the distance from its middle, over many powers of
/// two.
std::vector<Sample> random_samples(std::uint32_t count) {
  std::vector<Sample> samples;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float r = std::pow(10.f, random_in(-1, 1, i, 0)), angle = random_in(0, 6.2832f, i, 1);
    Sample s;
    s.position = {r * std::cos(angle), r * std::sin(angle), random_in(-0.01f, 0.01f, i, 2) * r};
    s.pixel = 0.02f * r;
    s.point = i;
    s.origin = i % 5 == 0;
    samples.push_back(s);
  }
  return samples;
}

TEST(SampleGrid, lists_all_neighbours_that_a_loop_over_all_samples_finds) {
  const std::vector<Sample> samples = random_samples(8000);
  const SampleGrid grid(samples, 1);
  std::size_t cells = 0, owned = 0, neighbours = 0;
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    std::vector<std::uint32_t> around;
    grid.list_around(cell, &around);
    const std::set<std::uint32_t> listed(around.begin(), around.end());
    EXPECT_EQ(listed.size(), around.size());
    for (const std::uint32_t i : grid.own(cell)) {
      ++owned;
      for (std::uint32_t j = 0; j < samples.size(); ++j) {
        const float apart = (samples[i].position - samples[j].position).norm();
        if (samples[j].origin != samples[i].origin || apart > samples[i].pixel) continue;
        EXPECT_EQ(listed.count(j), 1u) << i << " " << j;
        neighbours += i != j;
      }
    }
    cells += grid.own(cell).size() > 0;
  }
  EXPECT_EQ(owned, samples.size());
  EXPECT_GT(neighbours, 1000u);
  EXPECT_GT(cells, 100u);
}

TEST(CellTable, finds_the_cells_around_that_a_loop_over_all_finds) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(-6, 5), grid(0, 1);
  CellTable table;
  std::vector<CellTable::Key> keys;
  for (int i = 0; i < 900; ++i) {
    const CellTable::Key key = {place(random), place(random), place(random), 256 * grid(random)};
    const auto known = std::find(keys.begin(), keys.end(), key);
    const auto number = static_cast<std::uint32_t>(known - keys.begin());
    if (known == keys.end()) keys.push_back(key);
    ASSERT_EQ(table.find_or_add(key), number);
  }
  EXPECT_EQ(table.keys(), keys);
  for (const CellTable::Key& key : keys) {
    const CellTable::Around around = table.around(key);
    for (int i = 0; i < 27; ++i) {
      const CellTable::Key there = {key[0] + i % 3 - 1, key[1] + i / 3 % 3 - 1, key[2] + i / 9 - 1,
                                    key[3]};
      const auto known = std::find(keys.begin(), keys.end(), there);
      const auto number = static_cast<std::uint32_t>(known - keys.begin());
      EXPECT_EQ(around[static_cast<std::size_t>(i)],
                known == keys.end() ? CellTable::kNone : number);
    }
  }
}

TEST(SampleGrid, blocks_go_over_every_cell_once) {
  const std::vector<Sample> samples = random_samples(8000);
  const SampleGrid grid(samples, 1);
  std::vector<int> visits(grid.cells(), 0);
  grid.for_each_block([&](const SampleGrid::Span& cells) {
    for (const std::uint32_t cell : cells) ++visits[cell];
  });
  EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), static_cast<int>(grid.cells()));
}

TEST(Merged, those_left_are_apart_and_speak_for_all) {
  const std::vector<Sample> samples = random_samples(8000);
  const SampleGrid grid(samples, 1);
  const std::vector<Sample> left = merged(samples, grid, std::vector<float>(samples.size(), 1));
  EXPECT_LT(left.size(), samples.size() * 19 / 20);
  float weight = 0;
  for (const Sample& a : left) {
    weight += a.weight;
    for (const Sample& b : left) {
      if (a.point == b.point || a.origin != b.origin) continue;
      EXPECT_GT((a.position - b.position).norm(),
                std::min(samples[a.point].pixel, samples[b.point].pixel));
    }
  }
  EXPECT_EQ(weight, static_cast<float>(samples.size()));
  for (const Sample& s : samples) {
    const bool spoken_for = std::any_of(left.begin(), left.end(), [&](const Sample& l) {
      return l.origin == s.origin &&
             (l.position - s.position).norm() <= samples[l.point].pixel * 1.00001f;
    });
    EXPECT_TRUE(spoken_for) << s.point;
  }
}

TEST(Merged, a_sample_of_the_least_reach_is_taken_by_none_of_longer_reach) {
  const std::vector<Sample> samples = random_samples(8000);
  const SampleGrid grid(samples, 2);
  std::vector<float> reach(samples.size(), 2);
  std::size_t still = 0;
  for (std::size_t i = 0; i < reach.size(); i += 7, ++still) reach[i] = 0;
  std::size_t found = 0;
  for (const Sample& s : merged(samples, grid, reach)) found += s.point % 7 == 0;
  EXPECT_EQ(found, still);
}

}  // namespace
}  // namespace ps
