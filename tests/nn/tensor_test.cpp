// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/tensor.h"

#include <gtest/gtest.h>

#include <numeric>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

bool aligned(const float* p) { return reinterpret_cast<std::uintptr_t>(p) % 64 == 0; }

TEST(Tensor, is_zero_aligned_and_dense) {
  const Tensor tensor({2, 3, 5, 7});
  EXPECT_TRUE(aligned(tensor.data()));
  EXPECT_EQ(tensor.view().stride, 7u);
  EXPECT_EQ(reference::Values(tensor.view()).largest(), 0);
  EXPECT_EQ(tensor.shape().pixels(), 30u);
}

TEST(Tensor, may_be_empty_but_not_negative) {
  EXPECT_EQ(Tensor({0, 3, 5, 7}).shape().pixels(), 0u);
  EXPECT_EQ(Tensor({1, 3, 5, 0}).view().stride, 0u);
  EXPECT_THROW(Tensor({1, -3, 5, 7}), Error);
}

TEST(TensorView, slices_of_channels_and_images_are_the_same_memory) {
  const Tensor tensor({3, 2, 4, 10});
  std::iota(tensor.data(), tensor.data() + 240, 0.0f);
  const TensorView part = tensor.view().channels(3, 5).images(1, 2);
  EXPECT_EQ(part.shape, (Shape{2, 2, 4, 5}));
  EXPECT_EQ(part.pixel(1, 1, 2)[4], static_cast<float>(((2 * 2 + 1) * 4 + 2) * 10 + 7));
  EXPECT_EQ(part.pixel(0), tensor.view().pixel(1, 0, 0) + 3);
  EXPECT_EQ(tensor.view().channels(10, 0).shape.channels, 0);
}

TEST(TensorView, refuses_slices_outside) {
  const Tensor tensor({3, 2, 4, 10});
  for (const auto& [first, count] :
       std::vector<std::pair<int, int>>{{-1, 2}, {0, 11}, {9, 2}, {11, 0}, {2, -1}}) {
    EXPECT_THROW(tensor.view().channels(first, count), Error);
    EXPECT_THROW(tensor.view().images(first, count), Error);
  }
}

TEST(Workspace, gives_back_at_the_end_of_a_scope) {
  Workspace workspace;
  float* outer = workspace.take(std::size_t{100});
  float* inner = nullptr;
  {
    const Workspace::Scope scope(workspace);
    inner = workspace.take(std::size_t{50});
    EXPECT_GE(inner, outer + 100) << "two at once do not overlap";
    const Workspace::Scope nested(workspace);
    EXPECT_GE(workspace.take(std::size_t{50}), inner + 50);
  }
  EXPECT_EQ(workspace.take(std::size_t{50}), inner);
}

TEST(Workspace, what_was_taken_stays_where_it_is_when_it_grows) {
  Workspace workspace;
  const TensorView first = workspace.take(Shape{1, 8, 8, 3});
  EXPECT_TRUE(aligned(first.data));
  EXPECT_EQ(first.stride, 3u);
  std::fill_n(first.data, 192, 7.0f);
  for (const std::size_t count : {std::size_t{1} << 20, std::size_t{3}, std::size_t{1} << 22}) {
    float* p = workspace.take(count);
    EXPECT_TRUE(aligned(p));
    std::fill_n(p, count, 1.0f);
  }
  for (int i = 0; i < 192; ++i) EXPECT_EQ(first.data[i], 7.0f);
}

TEST(Workspace, does_not_grow_in_an_identical_second_run) {
  Workspace workspace;
  const auto run = [&] {
    const Workspace::Scope scope(workspace);
    for (int i = 0; i < 5; ++i) {
      workspace.take(Shape{1, 100, 100, 10 * i});
      const Workspace::Scope inner(workspace);
      workspace.take(Shape{1, 200, 100, 16});
      workspace.take(Shape{2, 1, 1, 3});
    }
  };
  run();
  const std::size_t bytes = workspace.bytes();
  EXPECT_GE(bytes, (100 * 100 * 100 + 200 * 100 * 16) * sizeof(float));
  for (int i = 0; i < 3; ++i) run();
  EXPECT_EQ(workspace.bytes(), bytes);
}

TEST(Planes, go_to_channels_last_and_back) {
  Random random(111);
  for (int i = 0; i < 30; ++i) {
    const Slice out(random.shape(), random.pick({0, 0, 3}));
    const Shape& s = out.shape();
    const std::vector<float> planes =
        random.reals(s.pixels() * static_cast<std::size_t>(s.channels));
    from_planes(planes.data(), out);
    EXPECT_TRUE(out.margins_untouched());
    std::size_t at = 0;
    for (int n = 0; n < s.images; ++n) {
      for (int c = 0; c < s.channels; ++c) {
        for (int y = 0; y < s.height; ++y) {
          for (int x = 0; x < s.width; ++x) EXPECT_EQ(out.view().pixel(n, y, x)[c], planes[at++]);
        }
      }
    }
    std::vector<float> back(planes.size());
    to_planes(out, back.data());
    EXPECT_EQ(back, planes);
  }
}

}  // namespace
}  // namespace ps::nn
