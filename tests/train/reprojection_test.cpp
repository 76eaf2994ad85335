// SPDX-License-Identifier: BSD-3-Clause
// Depth is judged by what it makes of the other view of a pair.
#include "libps/train/reprojection.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "libps/train/augmentation.h"
#include "libps/train/parameters.h"
#include "libps/train/room_examples.h"
#include "libps/train/train.h"
#include "tests/train/support.h"

namespace ps::train {
namespace {

const Wanted kPartners = {false, true};

/// Four pairs of one room's views, all from two places.
class Reprojection : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::vector<ExamplePair> pairs;
    for (ExamplePair& pair : room_pairs(3, {}, 12)) {
      const bool moved = pair.first_from_second.translation().norm() > .3;
      if (moved && pairs.size() < 4) pairs.push_back(std::move(pair));
    }
    ASSERT_EQ(pairs.size(), 4u);
    write_shard(folder(), "rooms-0000", to_shard(pairs));
  }
  static Folder& folder() {
    static Folder made;
    return made;
  }
  static Batch batch() {
    std::vector<std::int64_t> rows(8);
    std::iota(rows.begin(), rows.end(), 0);
    return Dataset(folder().path()).batch(rows, kPartners, torch::kCPU);
  }
  static TrainOptions options(const std::string& out) {
    TrainOptions o;
    o.stage = "depth";
    o.train = o.test = folder().path();
    o.out = folder().path() / out;
    o.width = 4;
    o.batch = 4;
    o.test_every = 1000;
    return o;
  }
};

Tensor metres(const Batch& batch) {
  const Tensor focal = (batch.lens.select(1, 0) * batch.lens.select(1, 1)).abs().sqrt();
  return batch.depth * (focal / static_cast<double>(batch.depth.size(3))).view({-1, 1, 1, 1});
}

float at(const Tensor& t, std::int64_t n, std::int64_t c, std::int64_t y, std::int64_t x) {
  return t[n][c][y][x].item<float>();
}

/// Bilinear, by hand.
double sampled(const Tensor& picture, std::int64_t n, std::int64_t c, double u, double v) {
  const auto x = static_cast<std::int64_t>(u), y = static_cast<std::int64_t>(v);
  const double a = u - static_cast<double>(x), b = v - static_cast<double>(y);
  return (1 - a) * (1 - b) * at(picture, n, c, y, x) + a * (1 - b) * at(picture, n, c, y, x + 1) +
         (1 - a) * b * at(picture, n, c, y + 1, x) + a * b * at(picture, n, c, y + 1, x + 1);
}

TEST(Warp, equals_lifting_moving_and_projecting_pixel_by_pixel) {
  const Tensor depth = torch::rand({2, 1, 9, 12}, generator_of(1, 0)) * 3 + .2;
  const Tensor partner = torch::rand({2, 3, 9, 12}, generator_of(2, 0));
  const Tensor lens = torch::tensor({{10.f, 11.f, 5.f, 4.f}, {-9.f, 8.f, 6.5f, 3.f}});
  const Tensor partner_lens = torch::tensor({{7.f, 9.f, 6.f, 4.5f}, {12.f, 10.f, 5.f, 4.f}});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(.4, Eigen::Vector3d(1, 3, -1).normalized()));
  pose.pretranslate(Eigen::Vector3d(.2, -.1, -.8));
  const Tensor moves = torch::zeros({2, 3, 4});
  for (int i = 0; i < 12; ++i) moves.select(1, i / 4).select(1, i % 4).fill_(pose(i / 4, i % 4));
  const Warped warped = warp(depth, partner, lens, partner_lens, moves);
  int inside = 0, outside = 0;
  for (std::int64_t i = 0; i < 2 * 9 * 12; ++i) {
    const std::int64_t n = i / 108, y = i / 12 % 9, x = i % 12;
    const double z = at(depth, n, 0, y, x);
    const auto k = [&](const Tensor& of, int which) { return of[n][which].item<double>(); };
    const Eigen::Vector3d there =
        pose * Eigen::Vector3d((static_cast<double>(x) - k(lens, 2)) / k(lens, 0) * z,
                               (static_cast<double>(y) - k(lens, 3)) / k(lens, 1) * z, z);
    const double u = k(partner_lens, 0) * there.x() / there.z() + k(partner_lens, 2);
    const double v = k(partner_lens, 1) * there.y() / there.z() + k(partner_lens, 3);
    const bool seen = there.z() > .05 && u >= 0 && u <= 11 && v >= 0 && v <= 8;
    ASSERT_EQ(at(warped.inside, n, 0, y, x), seen ? 1 : 0) << n << " " << y << " " << x;
    ++(seen ? inside : outside);
    if (!seen) continue;
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(at(warped.color, n, c, y, x), sampled(partner, n, c, u, v), 1e-4);
    }
  }
  EXPECT_GT(inside, 30);
  EXPECT_GT(outside, 40);
}

TEST_F(Reprojection, true_depth_finds_each_pixel_in_the_partner) {
  const torch::NoGradGuard guard;
  const Batch b = batch();
  const Tensor z = metres(b), known = (b.depth > 0).to(torch::kFloat32);
  const auto look = [&](const Tensor& depth, const Tensor& at_partner) {
    return warp(depth.clamp_min(.1), at_partner, b.lens, b.partner_lens, b.partner_from_view);
  };
  // Seen from there too: the partner's own depth puts the point where it is.
  const Tensor partners = z.view({4, 2, 1, 256, 256}).flip({1}).reshape(z.sizes());
  const Tensor x = torch::arange(256).view({1, 1, 1, 256}), y = x.transpose(2, 3);
  const auto each = [&](int i) { return b.lens.select(1, i).view({-1, 1, 1, 1}); };
  const Tensor row = b.partner_from_view.select(1, 2);
  const auto of_row = [&](int i) { return row.select(1, i).view({-1, 1, 1, 1}); };
  const Tensor z_there = of_row(0) * (x - each(2)) / each(0) * z +
                         of_row(1) * (y - each(3)) / each(1) * z + of_row(2) * z + of_row(3);
  const Warped depth_there = look(z, partners);
  const Tensor same = ((depth_there.color / z_there - 1).abs() < .01).to(torch::kFloat32);
  const Tensor visible = known * depth_there.inside * same;
  EXPECT_GT(visible.mean().item<double>(), .3);
  const auto error = [&](const Tensor& depth) {
    const Tensor off = (look(depth, b.partner).color - b.plain).abs().mean(1, true) / 2;
    return (off * visible).sum().item<double>() / visible.sum().item<double>();
  };
  const double right = error(z), wrong = error(z * 1.2);
  std::printf("  mean difference of colours: %.4f; 20 %% too far: %.4f\n", right, wrong);
  EXPECT_LT(right, .02);
  EXPECT_GT(wrong, 2 * right);
}

TEST_F(Reprojection, true_depth_has_the_least_loss_cropped_and_mirrored_too) {
  const torch::NoGradGuard guard;
  for (const bool augmented : {false, true}) {
    Batch b = batch();
    if (augmented) augment(b, {true, true, true}, generator_of(4, 0));
    const Tensor truth = torch::where(b.depth > 0, b.depth, torch::full_like(b.depth, 20));
    const auto loss = [&](const Tensor& depth) {
      return reprojection_loss(b, depth.expand_as(truth)).mean().item<double>();
    };
    const double least = loss(truth);
    const Tensor middle = std::get<0>(truth.flatten(1).median(1)).view({-1, 1, 1, 1});
    EXPECT_GT(loss(truth * 1.1), least);
    EXPECT_GT(loss(truth * .9), least);
    EXPECT_GT(loss(middle), 1.4 * least);
    EXPECT_GT(loss(truth * 2), 2 * least);
  }
}

TEST_F(Reprojection, examples_without_pose_count_nothing_and_harm_nothing) {
  Batch b = batch();
  b.posed.zero_();
  b.lens.fill_(1);
  Tensor depth = torch::full_like(b.depth, 3).requires_grad_(true);
  const Tensor loss = reprojection_loss(b, depth);
  EXPECT_EQ(loss.abs().sum().item<double>(), 0);
  loss.sum().backward();
  EXPECT_EQ(depth.grad().abs().sum().item<double>(), 0);
}

TEST_F(Reprojection, cropping_and_mirroring_keep_the_ray_of_each_pixel) {
  Batch b = batch();
  // Pictures that say where each pixel was.
  const Tensor x = (2 * torch::arange(256) + 1).to(torch::kFloat32).div(256).sub(1);
  b.color = torch::stack({x.expand({256, 256}), x.view({256, 1}).expand({256, 256}),
                          torch::zeros({256, 256})})
                .repeat({8, 1, 1, 1});
  const Tensor before = b.lens.clone();
  augment(b, {true, true, false}, generator_of(6, 0));
  const Tensor pixel = torch::arange(256).to(torch::kFloat32);
  int mirrored = 0;
  for (std::int64_t n = 0; n < 8; ++n) {
    const auto lens = [&](const Tensor& of, int i) { return of[n][i].item<double>(); };
    const Tensor u = ((b.color[n][0][128] + 1) * 256 - 1) / 2;
    const Tensor v = ((b.color[n][1].select(1, 128) + 1) * 256 - 1) / 2;
    const Tensor off_x =
        (u - lens(before, 2)) / lens(before, 0) - (pixel - lens(b.lens, 2)) / lens(b.lens, 0);
    const Tensor off_y =
        (v - lens(before, 3)) / lens(before, 1) - (pixel - lens(b.lens, 3)) / lens(b.lens, 1);
    EXPECT_LT(off_x.abs().max().item<double>(), 1e-3);
    EXPECT_LT(off_y.abs().max().item<double>(), 1e-3);
    mirrored += lens(b.lens, 0) < 0 ? 1 : 0;
  }
  EXPECT_GT(mirrored, 0);
  EXPECT_LT(mirrored, 8);
}

TEST_F(Reprojection, teaches_depth_and_its_scale_from_poses_alone) {
  TrainOptions untrained = options("untrained"), taught = options("taught");
  untrained.supervision = taught.supervision = "poses";
  untrained.steps = 1;
  untrained.learning_rate = 1e-12;
  taught.steps = 40;
  taught.learning_rate = 4e-3;
  const auto before = train(untrained, {}).scores, after = train(taught, {}).scores;
  std::printf("  reprojection %.3f -> %.3f, AbsRel unscaled %.3f -> %.3f\n",
              before.at("rooms_reprojection"), after.at("rooms_reprojection"),
              before.at("rooms_abs_rel_raw"), after.at("rooms_abs_rel_raw"));
  EXPECT_LT(after.at("rooms_reprojection"), .6 * before.at("rooms_reprojection"));
  EXPECT_LT(after.at("rooms_abs_rel_raw"), .3 * before.at("rooms_abs_rel_raw"));
}

TEST_F(Reprojection, old_examples_without_poses_load_and_teach_what_they_know) {
  const Folder old;
  TensorMap shard = read_safetensors(folder().path() / "rooms-0000.safetensors");
  shard.erase("pose");
  shard.erase("lens");
  write_shard(old, "rooms-0000", shard);
  TrainOptions o = options("old");
  o.train = old.path();
  o.steps = 1;
  o.supervision = "poses";
  EXPECT_NE(message_of(o).find("no pair's pose is known"), std::string::npos);
  o.supervision = "depth";
  EXPECT_EQ(train(o, {}).steps, 1);
  // Beside others: each teaches what it knows.
  std::filesystem::copy(folder().path() / "rooms-0000.safetensors",
                        old.path() / "rooms-0001.safetensors");
  const Batch both = Dataset(old.path()).batch({0, 8}, kPartners, torch::kCPU);
  EXPECT_EQ(both.posed[0].item<float>(), 0);
  EXPECT_EQ(both.posed[1].item<float>(), 1);
  o.out = folder().path() / "mixed";
  o.supervision = "both";
  EXPECT_EQ(train(o, {}).steps, 1);
}

TEST_F(Reprojection, examples_without_depth_are_trained_on_by_poses_and_not_scored) {
  const Folder blind;
  TensorMap shard = read_safetensors(folder().path() / "rooms-0000.safetensors");
  std::fill(shard["depth"].bytes.begin(), shard["depth"].bytes.end(), std::byte{0});
  write_shard(blind, "posed-0000", shard);
  TrainOptions o = options("blind");
  o.train = o.test = blind.path();
  o.steps = 2;
  o.supervision = "both";
  const auto scores = train(o, {}).scores;
  EXPECT_EQ(scores.count("posed_abs_rel"), 0u);
  EXPECT_GT(scores.at("posed_reprojection"), 0);
}

TEST_F(Reprojection, unsound_geometry_is_named) {
  const Folder bad;
  const TensorMap sound = read_safetensors(folder().path() / "rooms-0000.safetensors");
  const auto message = [&](const char* field, int value, float to) {
    TensorMap shard = sound;
    std::memcpy(shard[field].bytes.data() + 4 * value, &to, 4);
    write_shard(bad, "rooms-0000", shard);
    return error_of([&] { Dataset data(bad.path()); });
  };
  EXPECT_NE(message("pose", 0, 2).find("a pose is not rigid"), std::string::npos);
  EXPECT_NE(message("pose", 5, std::nanf("")).find("a pose is not rigid"), std::string::npos);
  EXPECT_NE(message("pose", 3, INFINITY).find("a pose is not rigid"), std::string::npos);
  EXPECT_NE(message("lens", 0, -1).find("a lens is unsound"), std::string::npos);
  EXPECT_NE(message("lens", 2, std::nanf("")).find("a lens is unsound"), std::string::npos);
  TensorMap half = sound;
  half.erase("lens");
  write_shard(bad, "rooms-0000", half);
  EXPECT_NE(error_of([&] { Dataset data(bad.path()); }).find("there is no lens"),
            std::string::npos);
}

}  // namespace
}  // namespace ps::train
