// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/resample.h"

#include <gtest/gtest.h>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

using reference::Values;

constexpr int kCases = 120;

/// Runs an operator over random shapes, into slices of wider tensors and dense ones.
void expect_operator(const std::function<void(const TensorView&, const TensorView&)>& run,
                     const std::function<Values(const Values&)>& reference_of, double bound) {
  Random random(21);
  for (int i = 0; i < kCases; ++i) {
    const Slice in(random.shape(), random.pick({0, 0, 5}), random);
    const Values expected = reference_of(Values(in));
    on_every_isa([&] {
      const Slice out(expected.shape, random.pick({0, 0, 3}));
      run(in, out);
      EXPECT_TRUE(near(out, expected, bound)) << "from " << text(in.shape());
      EXPECT_TRUE(out.margins_untouched());
    });
  }
}

TEST(Upsample, is_its_reference) {
  expect_operator(upsample_bilinear_2x, reference::upsample_bilinear_2x, 2e-7);
}

TEST(AveragePool, is_its_reference) {
  for (const bool count_padding : {false, true}) {
    expect_operator([&](const auto& in, const auto& out) { average_pool(in, out, count_padding); },
                    [&](const Values& in) { return reference::average_pool(in, count_padding); },
                    3e-7);
  }
}

TEST(AveragePool, halves_the_size_rounding_up) {
  EXPECT_EQ(half_size({2, 5, 6, 7}), (Shape{2, 3, 3, 7}));
  EXPECT_EQ(half_size({1, 1, 0, 7}), (Shape{1, 1, 0, 7}));
}

TEST(MaxPool, is_its_reference) {
  for (const MaxPool& pool :
       {MaxPool{3, 2, 1, false}, MaxPool{3, 2, 0, true}, MaxPool{3, 2, 0, false},
        MaxPool{2, 2, 0, false}, MaxPool{2, 2, 1, true}, MaxPool{1, 1, 0, false},
        MaxPool{5, 3, 2, true}, MaxPool{3, 5, 1, true}}) {
    expect_operator([&](const auto& in, const auto& out) { max_pool(in, out, pool); },
                    [&](const Values& in) { return reference::max_pool(in, pool); }, 0);
  }
}

TEST(MaxPool, sizes_are_those_of_the_reference) {
  for (int kernel = 1; kernel <= 6; ++kernel) {
    for (int stride = 1; stride <= 7; ++stride) {
      for (int padding = 0; padding <= kernel / 2; ++padding) {
        for (int size = 0; size <= 13; ++size) {
          for (const bool ceil : {false, true}) {
            const MaxPool pool = {kernel, stride, padding, ceil};
            const Values expected = reference::max_pool(Values(Shape{1, size, 20, 1}), pool);
            EXPECT_EQ(pooled_size({1, size, 20, 1}, pool), expected.shape)
                << kernel << " " << stride << " " << padding << " " << size << " " << ceil;
          }
        }
      }
    }
  }
}

TEST(MaxPool, of_values_below_0_is_not_the_padding) {
  const Tensor in({1, 2, 2, 3}), out({1, 1, 1, 3});
  std::fill_n(in.data(), 12, -5.0f);
  max_pool(in, out, {3, 2, 1, false});
  EXPECT_EQ(out.data()[0], -5);
}

TEST(GlobalAverage, is_its_reference) {
  Random random(22);
  for (int i = 0; i < kCases; ++i) {
    Shape shape = random.shape();
    shape.height = std::max(1, shape.height);
    shape.width = std::max(1, shape.width);
    const Slice in(shape, random.pick({0, 0, 5}), random);
    const Slice out({shape.images, 1, 1, shape.channels}, random.pick({0, 3}));
    global_average(in, out);
    EXPECT_TRUE(near(out, reference::global_average(Values(in)), 1e-7));
    EXPECT_TRUE(out.margins_untouched());
  }
}

TEST(Resampling, refuses_misfit_shapes_and_windows) {
  const Tensor in({1, 4, 4, 3});
  EXPECT_THROW(upsample_bilinear_2x(in, in), Error);
  EXPECT_THROW(average_pool(in, in, true), Error);
  EXPECT_THROW(max_pool(in, in, {}), Error);
  EXPECT_THROW(global_average(in, in), Error);
  for (const MaxPool& pool :
       {MaxPool{0, 1, 0}, MaxPool{3, 0, 0}, MaxPool{3, 2, 2}, MaxPool{3, 2, -1}}) {
    EXPECT_THROW(pooled_size(in.shape(), pool), Error);
  }
}

}  // namespace
}  // namespace ps::nn
