// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/softmax.h"

#include <gtest/gtest.h>

#include <limits>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

using reference::Values;

TEST(Softmax, is_its_reference) {
  Random random(31);
  for (int i = 0; i < 120; ++i) {
    Shape shape = random.shape();
    if (i % 10 == 0) shape.channels = 512;
    const float range = random.real(0, 50), temperature = random.real(0.3f, 2);
    const Slice in(shape, random.pick({0, 0, 5}), random, -range, range);
    const Values expected = reference::softmax(Values(in), temperature);
    on_every_isa([&] {
      const Slice out(shape, random.pick({0, 0, 3}));
      softmax(in, out, temperature);
      EXPECT_TRUE(near(out, expected, 5e-7));
      EXPECT_TRUE(out.margins_untouched());
      const Slice both(shape, 2);
      copy(in, both);
      softmax(both, both, temperature);
      EXPECT_TRUE(same_bytes(both, out));
    });
  }
}

TEST(Softmax, of_huge_and_infinite_values_is_finite) {
  const Tensor in({1, 1, 1, 3});
  in.data()[0] = 1e30f;
  in.data()[1] = 1e30f;
  in.data()[2] = -std::numeric_limits<float>::infinity();
  softmax(in, in);
  EXPECT_EQ(in.data()[0], 0.5f);
  EXPECT_EQ(in.data()[1], 0.5f);
  EXPECT_EQ(in.data()[2], 0.0f);
}

TEST(Softmax, refuses_misfit_shapes_and_temperatures) {
  const Tensor a({1, 2, 3, 4}), other({1, 3, 2, 4});
  EXPECT_THROW(softmax(a, other), Error);
  for (const float temperature : {0.0f, -1.0f, std::nanf("")}) {
    EXPECT_THROW(softmax(a, a, temperature), Error);
  }
}

}  // namespace
}  // namespace ps::nn
