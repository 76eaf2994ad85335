// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/norm.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

using reference::Values;

constexpr int kCases = 120;
constexpr double kBound = 5e-7;

TEST(InstanceNorm, is_its_reference) {
  Random random(11);
  for (int i = 0; i < kCases; ++i) {
    const Shape shape = random.shape();
    const float middle = random.real(-4, 4);
    const Slice in(shape, random.pick({0, 0, 5}), random, middle - 1, middle + 1);
    const Values normalised = reference::instance_norm(Values(in));
    for (const float slope : {1.0f, 0.2f}) {
      const Values expected = reference::activation(normalised, slope);
      on_every_isa([&] {
        const Slice out(shape, random.pick({0, 0, 3}));
        instance_norm(in, out, {slope});
        EXPECT_TRUE(near(out, expected, kBound));
        EXPECT_TRUE(out.margins_untouched());
        const Slice both(shape, 2);
        copy(in, both);
        instance_norm(both, both, {slope});
        EXPECT_TRUE(same_bytes(both, out));
      });
    }
  }
}

TEST(InstanceNorm, of_values_far_from_0_is_as_good) {
  Random random(12);
  const Slice in({2, 17, 9, 20}, 0, random, 9999, 10001);
  on_every_isa([&] {
    const Slice out(in.shape(), 0);
    instance_norm(in, out);
    EXPECT_TRUE(near(out, reference::instance_norm(Values(in)), kBound));
  });
}

TEST(InstanceNorm, of_one_pixel_or_of_equal_pixels_is_0) {
  for (const Shape& shape : {Shape{2, 1, 1, 33}, Shape{1, 5, 7, 3}}) {
    const Tensor in(shape), out(shape);
    std::fill_n(in.data(), shape.pixels() * static_cast<std::size_t>(shape.channels), 1.7f);
    instance_norm(in, out);
    EXPECT_EQ(Values(out.view()).largest(), 0);
  }
}

TEST(PositionalNorm, is_its_reference) {
  Random random(13);
  for (int i = 0; i < kCases; ++i) {
    const Shape shape = random.shape();
    const float middle = random.real(-4, 4);
    const Slice in(shape, random.pick({0, 0, 5}), random, middle - 1, middle + 1);
    const Values expected = reference::positional_norm(Values(in));
    on_every_isa([&] {
      const Slice out(shape, random.pick({0, 0, 3}));
      positional_norm(in, out);
      EXPECT_TRUE(near(out, expected, kBound));
      EXPECT_TRUE(out.margins_untouched());
      const Slice both(shape, 2);
      copy(in, both);
      positional_norm(both, both);
      EXPECT_TRUE(same_bytes(both, out));
    });
  }
}

TEST(PositionalNorm, of_values_far_from_0_is_as_good) {
  Random random(14);
  const Slice in({1, 9, 9, 80}, 0, random, 9999, 10001), out(in.shape(), 0);
  positional_norm(in, out);
  EXPECT_TRUE(near(out, reference::positional_norm(Values(in)), kBound));
}

TEST(PositionalNorm, of_one_channel_is_0) {
  Random random(15);
  const Slice in({1, 3, 4, 1}, 0, random), out(in.shape(), 0);
  positional_norm(in, out);
  EXPECT_EQ(Values(out.view()).largest(), 0);
}

TEST(PositionalNorm, of_a_pixel_does_not_depend_on_the_others) {
  Random random(16);
  const Slice in({1, 1, 50, 80}, 0, random), all(in.shape(), 0);
  positional_norm(in, all);
  for (int x = 0; x < 50; ++x) {
    const Slice one({1, 1, 1, 80}, 3), out(one.shape(), 1);
    std::copy_n(in.view().pixel(0, 0, x), 80, one.view().data);
    positional_norm(one, out);
    EXPECT_EQ(std::memcmp(out.view().data, all.view().pixel(0, 0, x), 80 * sizeof(float)), 0);
  }
}

TEST(Norms, refuse_shapes_that_differ) {
  const Tensor a({1, 2, 3, 4}), other({1, 3, 2, 4});
  EXPECT_THROW(instance_norm(a, other), Error);
  EXPECT_THROW(positional_norm(a, other), Error);
}

}  // namespace
}  // namespace ps::nn
