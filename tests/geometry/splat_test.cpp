// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/splat.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/geometry/point.h"
#include "libps/geometry/splat_kernel.h"
#include "tests/geometry/splat_reference.h"

namespace ps {
namespace {

struct Case {
  const char* name;
  int points;
  cv::Size size;
  float radius;
  int points_per_pixel;
  int depths;  ///< number of distinct depths; few = many ties
};

PlanePoints random_points(const Case& c, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  PlanePoints points;
  for (int i = 0; i < c.points; ++i) {
    points.u.push_back((unit(random) * 1.4f - 0.2f) * c.size.width);
    points.v.push_back((unit(random) * 1.4f - 0.2f) * c.size.height);
    const float z = 0.5f + std::floor(unit(random) * c.depths) / c.depths * 9;
    points.z.push_back(unit(random) < 0.05f ? -z : z);
    points.color.emplace_back(unit(random), unit(random), unit(random));
  }
  return points;
}

double max_abs(const cv::Mat& a, const cv::Mat& b) {
  return a.empty() ? 0 : cv::norm(a.reshape(1), b.reshape(1), cv::NORM_INF);
}

void expect_same_bytes(const Splat& a, const Splat& b) {
  EXPECT_EQ(max_abs(a.color, b.color), 0);
  EXPECT_EQ(max_abs(a.first_depth, b.first_depth), 0);
  EXPECT_EQ(max_abs(a.expected_depth, b.expected_depth), 0);
  EXPECT_EQ(max_abs(a.hit, b.hit), 0);
  EXPECT_EQ(max_abs(a.missing, b.missing), 0);
}

class SplatCases : public testing::TestWithParam<Case> {};

TEST_P(SplatCases, agrees_with_the_kd_tree_reference) {
  const Case& c = GetParam();
  for (const bool renormalise : {false, true}) {
    SplatOptions options;
    options.radius = c.radius;
    options.points_per_pixel = c.points_per_pixel;
    options.background = {0.2f, 0.5f, 0.9f};
    options.renormalise = renormalise;
    const PlanePoints points = random_points(c, 7);
    const Splat expected = splat_reference(points, c.size, options);
    const Splat fast = splat_plane(points, c.size, options);
    EXPECT_LE(max_abs(fast.color, expected.color), 1.0 / 510);
    EXPECT_EQ(max_abs(fast.hit, expected.hit), 0);
    EXPECT_EQ(max_abs(fast.missing, expected.missing), 0);
    EXPECT_EQ(max_abs(fast.first_depth, expected.first_depth), 0);
    EXPECT_LE(max_abs(fast.expected_depth, expected.expected_depth), 0.02);
    options.count_hits = true;
    const Splat counted = splat_plane(points, c.size, options);
    EXPECT_EQ(max_abs(counted.count, expected.count), 0);
    EXPECT_EQ(max_abs(counted.nearest, expected.nearest), 0);
    EXPECT_LE(max_abs(counted.color, expected.color), 2e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(sizes, SplatCases,
                         testing::Values(Case{"none", 0, {40, 30}, 4, 128, 100},
                                         Case{"one", 1, {1, 1}, 4, 128, 100},
                                         Case{"sparse", 60, {70, 45}, 4, 128, 100},
                                         Case{"dense", 9000, {70, 45}, 4, 128, 1 << 20},
                                         Case{"ties", 4000, {33, 65}, 4, 128, 3},
                                         Case{"all_ties", 3000, {31, 17}, 4, 128, 1},
                                         Case{"few_per_pixel", 4000, {64, 64}, 4, 3, 100},
                                         Case{"one_per_pixel", 4000, {64, 64}, 4, 1, 100},
                                         Case{"tiny_radius", 4000, {50, 50}, 0.3f, 128, 100},
                                         Case{"odd_radius", 3000, {50, 50}, 2.71828f, 128, 100},
                                         Case{"huge_radius", 300, {50, 50}, 40, 128, 100},
                                         Case{"row", 500, {300, 1}, 4, 128, 100},
                                         Case{"column", 500, {1, 300}, 4, 128, 100}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Splat, every_vector_width_gives_the_same_bytes) {
  using namespace splat_kernel;
  std::vector<Blend> widths = {blend_baseline};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) widths.push_back(blend_avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    widths.push_back(blend_avx512);
  }
#endif
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<TilePoint> points(700);
  for (TilePoint& p : points) {
    const float radius = 1 + 4 * unit(random);
    p = {unit(random) * 24 + 28, unit(random) * 24 + 44, 1 + unit(random), unit(random),
         unit(random),           unit(random),           radius,           1 / (radius * radius)};
  }
  for (const float deepest : {std::numeric_limits<float>::infinity(), 1.2f}) {
    const Params params = {32, 48, 1.0f / 1024, 100, deepest};
    std::vector<Tile> tiles(widths.size(), Tile{});
    for (std::size_t w = 0; w < widths.size(); ++w) {
      for (Gathered& block : tiles[w].blocks) {
        for (float& left : block.left) left = 1;
      }
      tiles[w].live = ~std::uint64_t{0};
      for (int i = 0; i < 700; i += 20) widths[w](&tiles[w], points.data() + i, 20, params);
      EXPECT_EQ(std::memcmp(tiles[w].blocks, tiles[0].blocks, sizeof tiles[0].blocks), 0);
      EXPECT_GT(tiles[w].blocks[5].count[3], 0);
    }
  }
}

TEST(Splat, what_is_behind_a_surface_can_be_hidden) {
  PlanePoints points;
  const auto add = [&](float z, const cv::Vec3f& color) {
    points.u.push_back(8.5f);
    points.v.push_back(8);
    points.z.push_back(z);
    points.color.push_back(color);
  };
  add(2.2f, {0, 0, 1});
  add(1, {1, 0, 0});
  add(1.04f, {0, 1, 0});
  SplatOptions options;
  options.radius = 1;
  const Splat open = splat_plane(points, {16, 16}, options);
  EXPECT_GT(open.color(8, 8)[2], .1f);
  options.thickness = .05f;
  const Splat hidden = splat_plane(points, {16, 16}, options);
  EXPECT_EQ(hidden.color(8, 8)[2], 0);
  EXPECT_GT(hidden.color(8, 8)[1], .1f);
  EXPECT_LT(hidden.expected_depth(8, 8), 1.04f);
}

TEST(Splat, points_may_have_radii_of_their_footprints) {
  const Intrinsics camera{90, 50, 100, 100, 44.5, 24.5};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  Cloud cloud;
  for (int i = 0; i < 25; ++i) {
    Point p;
    p.z = 1 + 2 * unit(random);
    p.x = (unit(random) - .5f) * .9f * p.z;
    p.y = (unit(random) - .5f) * .5f * p.z;
    p.footprint = .24f * unit(random) * unit(random);
    cloud.push_back(p);
  }
  cloud[3].footprint = 0;
  cloud[4].footprint = std::numeric_limits<float>::quiet_NaN();
  SplatOptions options;
  options.radius = 5;
  options.finest = 1.5f;
  const Splat drawn = splat(cloud, camera, Pose::Identity(), options);
  int widest = 0, narrowest = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      float nearest = 0;
      for (const Point& p : cloud) {
        const float wanted = p.footprint * 100 / p.z;
        const float radius = wanted > 1.5f ? std::min(wanted, 5.f) : 1.5f;
        const float u = 100 * p.x / p.z + 44.5f, v = 100 * p.y / p.z + 24.5f;
        const float dx = static_cast<float>(x) - u, dy = static_cast<float>(y) - v;
        if (dx * dx + dy * dy >= radius * radius) continue;
        widest += radius == 5;
        narrowest += radius == 1.5f;
        if (nearest == 0 || p.z < nearest) nearest = p.z;
      }
      EXPECT_EQ(drawn.hit(y, x) != 0, nearest > 0) << x << " " << y;
      EXPECT_NEAR(drawn.first_depth(y, x), nearest, 1e-5);
    }
  }
  EXPECT_GT(widest, 100);
  EXPECT_GT(narrowest, 20);
}

TEST(Splat, bytes_do_not_depend_on_threads) {
  const PlanePoints points = random_points({"", 50000, {200, 150}, 4, 128, 1 << 20}, 11);
  set_threads(1);
  const Splat one = splat_plane(points, {200, 150});
  for (const int count : {2, 7}) {
    set_threads(count);
    expect_same_bytes(one, splat_plane(points, {200, 150}));
  }
  set_threads(0);
}

TEST(Splat, any_pcl_cloud_lands_where_the_camera_projects_it) {
  const Intrinsics camera{60, 40, 50, 55, 29.5, 19.5};
  Pose world_from_cam = Pose::Identity();
  world_from_cam.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  world_from_cam.translation() = Eigen::Vector3d(1, -2, 0.5);
  Cloud cloud(1, 1);
  cloud[0].getVector3fMap() = (world_from_cam * camera.lift(22, 13, 2.5)).cast<float>();
  cloud[0].r = 255;
  cloud[0].g = 51;
  cloud[0].b = 0;
  SplatOptions options;
  options.radius = 3.9f;
  options.renormalise = true;
  const Splat out = splat(cloud, camera, world_from_cam, options);
  EXPECT_NEAR(out.first_depth(13, 22), 2.5, 1e-5);
  EXPECT_NEAR(out.expected_depth(13, 22), 2.5, 1e-5);
  EXPECT_LE(cv::norm(out.color(13, 22), cv::Vec3f(1, 0.2f, 0), cv::NORM_INF), 1e-5);
  EXPECT_EQ(cv::countNonZero(out.hit), 45);  // lattice points within 3.9 of one
}

TEST(Splat, points_behind_or_not_finite_are_skipped) {
  Cloud cloud(5, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  cloud[0].getVector3fMap() = Eigen::Vector3f(0, 0, -1);
  cloud[1].getVector3fMap() = Eigen::Vector3f(nan, 0, 1);
  cloud[2].getVector3fMap() = Eigen::Vector3f(0, 0, infinity);
  cloud[3].getVector3fMap() = Eigen::Vector3f(0, 0, 0);
  cloud[4].getVector3fMap() = Eigen::Vector3f(infinity, 0, 1);
  const Splat out = splat(cloud, {20, 20, 10, 10, 9.5, 9.5}, Pose::Identity());
  EXPECT_EQ(cv::countNonZero(out.hit), 0);
  EXPECT_EQ(cv::countNonZero(out.missing), 400);
  EXPECT_EQ(cv::countNonZero(out.color.reshape(1)), 0);
}

TEST(Splat, an_empty_cloud_is_all_missing) {
  const Splat out = splat(Cloud(), {7, 5, 10, 10, 3, 2}, Pose::Identity());
  EXPECT_EQ(cv::countNonZero(out.missing), 35);
}

TEST(Splat, coincident_points_are_one_surface) {
  PlanePoints many;
  for (int i = 0; i < 100000; ++i) {
    many.u.push_back(4);
    many.v.push_back(4);
    many.z.push_back(2);
    many.color.emplace_back(0.25f, 0.5f, 0.75f);
  }
  const Splat out = splat_plane(many, {9, 9});
  EXPECT_LE(cv::norm(out.color(4, 4), cv::Vec3f(0.25f, 0.5f, 0.75f), cv::NORM_INF), 1.0 / 510);
  EXPECT_EQ(out.first_depth(4, 4), 2);
}

TEST(Splat, unsound_cameras_are_refused) {
  Pose bad = Pose::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_THROW(splat(Cloud(), {8, 8, 10, 10, 4, 4}, bad), Error);
  bad = Pose::Identity();
  bad.linear() *= 2;
  EXPECT_THROW(splat(Cloud(), {8, 8, 10, 10, 4, 4}, bad), Error);
  EXPECT_THROW(splat(Cloud(), {65536, 65536, 10, 10, 4, 4}, Pose::Identity()), Error);
}

TEST(Splat, unsound_options_are_refused) {
  const auto with = [](auto change) {
    SplatOptions options;
    change(options);
    return splat_plane({}, {8, 8}, options);
  };
  EXPECT_THROW(with([](SplatOptions& o) { o.radius = 0; }), Error);
  EXPECT_THROW(with([](SplatOptions& o) { o.radius = std::nanf(""); }), Error);
  EXPECT_THROW(with([](SplatOptions& o) { o.radius = 65; }), Error);
  EXPECT_THROW(with([](SplatOptions& o) { o.finest = -1; }), Error);
  EXPECT_THROW(with([](SplatOptions& o) { o.finest = std::nanf(""); }), Error);
  EXPECT_THROW(with([](SplatOptions& o) { o.thickness = -1; }), Error);
  EXPECT_THROW(with([](SplatOptions& o) { o.dilation = 4; }), Error);
  EXPECT_THROW(with([](SplatOptions& o) { o.points_per_pixel = 0; }), Error);
  EXPECT_THROW(splat_plane({}, {0, 8}), Error);
  EXPECT_THROW(splat_plane({{1}, {}, {}, {}}, {8, 8}), Error);
}

}  // namespace
}  // namespace ps
