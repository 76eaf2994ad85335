// SPDX-License-Identifier: BSD-3-Clause
// The PixelCNN gives the published one's logits (SPEC.md 7).
#include "libps/models/pixel_cnn.h"

#include <numeric>

#include "tests/models/support.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

constexpr int kSide = 32;

LocalMasks masks_of(const TensorMap& tensors, const std::string& prefix) {
  return {bytes_of(tensors.at(prefix + "mask_init")),
          bytes_of(tensors.at(prefix + "mask_undilated")),
          bytes_of(tensors.at(prefix + "mask_dilated"))};
}

/// Masks of an order: neighbour k is visible iff it comes earlier, in the first layer not the cell
/// itself (SPEC.md 6).
LocalMasks masks_of(const std::vector<int>& rank, int height, int width) {
  LocalMasks masks;
  const auto fill = [&](int dilation, bool self) {
    std::vector<std::uint8_t> mask;
    for (int t = 0; t < 9; ++t) {
      for (int i = 0; i < height * width; ++i) {
        const int y = i / width + (t / 3 - 1) * dilation, x = i % width + (t % 3 - 1) * dilation;
        const bool inside = y >= 0 && y < height && x >= 0 && x < width;
        mask.push_back(t == 4 ? self : inside && rank[y * width + x] < rank[i]);
      }
    }
    return mask;
  };
  masks.first = fill(1, false);
  masks.later = fill(1, true);
  masks.dilated = fill(2, true);
  return masks;
}

class PixelCnnReference : public testing::TestWithParam<Setting> {};

TEST_P(PixelCnnReference, equals_the_published_network) {
  PS_NEED_SHARED("reference/d_pixelcnn.safetensors");
  const TensorMap reference = read_safetensors(shared("reference/d_pixelcnn.safetensors"));
  const TensorMap orders = read_safetensors(shared("reference/c_order.safetensors"));
  const PixelCnn net(reference_weights(), GetParam().options);
  nn::Workspace workspace;
  const double bound = is_exact(GetParam()) ? 5e-3 : 5;
  for (const std::string name : {"R.", "holes."}) {
    const LocalMasks masks = masks_of(orders, name);
    auto codes = ints_of(reference.at(name + "codes"));
    nn::Tensor logits({1, kSide, kSide, net.codes()});
    net.forward(codes.data(), masks, logits, workspace);
    expect_near(name + "logits_full", logits, tensor_of(reference.at(name + "logits_full")), 1,
                bound);
    const auto missing = bytes_of(reference.at(name + "missing"));
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (missing[i] != 0) codes[i] = -1;
    }
    net.forward(codes.data(), masks, logits, workspace);
    expect_near(name + "logits_masked", logits, tensor_of(reference.at(name + "logits_masked")), 1,
                bound);
  }
}

INSTANTIATE_TEST_SUITE_P(settings, PixelCnnReference,
                         testing::Values(all_settings().front(), all_settings().back()), name_of);

TEST(PixelCnn, equals_its_golden) {
  const PixelCnn net(golden_weights());
  nn::Workspace workspace;
  auto codes = ints_of(goldens().at("pixelcnn.codes"));
  const LocalMasks masks = masks_of(goldens(), "pixelcnn.");
  nn::Tensor logits({1, kSide, kSide, net.codes()});
  net.forward(codes.data(), masks, logits, workspace);
  expect_near("logits_full", every(16, logits), tensor_of(goldens().at("pixelcnn.logits_full")), 1,
              5e-3);
  const auto missing = bytes_of(goldens().at("pixelcnn.missing"));
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (missing[i] != 0) codes[i] = -1;
  }
  net.forward(codes.data(), masks, logits, workspace);
  expect_near("logits_masked", every(8, logits), tensor_of(goldens().at("pixelcnn.logits_masked")),
              1, 5e-3);
}

/// SPEC.md 7: what a cell computes depends only on cells earlier in the order.
TEST(PixelCnn, sees_nothing_that_comes_later_in_the_order) {
  constexpr int kHeight = 5, kWidth = 7, kCells = kHeight * kWidth, kCodes = 6;
  const PixelCnn net(random_pixel_cnn(4, kCodes));
  nn::Workspace workspace;
  std::vector<int> rank(kCells);
  std::iota(rank.begin(), rank.end(), 0);
  for (int i = 0; i < kCells; ++i) std::swap(rank[i], rank[(i * 17 + 5) % kCells]);
  const LocalMasks masks = masks_of(rank, kHeight, kWidth);
  std::vector<std::int32_t> codes(kCells);
  for (int i = 0; i < kCells; ++i) codes[i] = i % kCodes;
  nn::Tensor before({1, kHeight, kWidth, kCodes}), after(before.shape());
  net.forward(codes.data(), masks, before, workspace);
  int changed = 0;
  for (int i = 0; i < kCells; ++i) {
    std::vector<std::int32_t> other = codes;
    other[i] = i % 2 ? -1 : (codes[i] + 1) % kCodes;
    net.forward(other.data(), masks, after, workspace);
    for (int j = 0; j < kCells; ++j) {
      const bool same = std::equal(before.view().pixel(j), before.view().pixel(j) + kCodes,
                                   after.view().pixel(j));
      if (rank[j] <= rank[i]) {
        EXPECT_TRUE(same) << i << " " << j;
      } else {
        changed += !same;
      }
    }
  }
  EXPECT_GT(changed, kCells);
}

TEST(PixelCnn, treats_completions_of_a_batch_alone) {
  constexpr int kSize = 6, kCells = kSize * kSize, kCodes = 5;
  const PixelCnn net(random_pixel_cnn(4, kCodes));
  nn::Workspace workspace;
  std::vector<int> rank(kCells);
  std::iota(rank.begin(), rank.end(), 0);
  const LocalMasks masks = masks_of(rank, kSize, kSize);
  std::vector<std::int32_t> codes(3 * kCells);
  for (int i = 0; i < 3 * kCells; ++i) codes[i] = i * i % (kCodes + 1) - 1;
  nn::Tensor all({3, kSize, kSize, kCodes}), alone({1, kSize, kSize, kCodes});
  net.forward(codes.data(), masks, all, workspace);
  for (int i = 0; i < 3; ++i) {
    net.forward(codes.data() + i * kCells, masks, alone, workspace);
    EXPECT_EQ(difference(alone, all.view().images(i, 1)).worst, 0);
  }
}

TEST(PixelCnn, refuses_what_does_not_fit) {
  const PixelCnn net(random_pixel_cnn(2, 4));
  nn::Workspace workspace;
  nn::Tensor logits({1, 2, 2, 4}), narrow({1, 2, 2, 3});
  LocalMasks masks = masks_of({0, 1, 2, 3}, 2, 2);
  std::vector<std::int32_t> codes = {0, 1, 4, -1};
  const auto forward = [&](const nn::Tensor& out) {
    return error_of([&] { net.forward(codes.data(), masks, out, workspace); });
  };
  EXPECT_TRUE(has(forward(logits), "code 2 is 4; expected codes below 4"));
  EXPECT_TRUE(has(forward(narrow), "logits"));
  masks.dilated.pop_back();
  EXPECT_TRUE(has(forward(logits), "a mask has 35 values"));
  auto tensors = random_pixel_cnn(2, 4).tensors();
  tensors.erase("outpaint2.down_layers.1.u_stream.2.nin_skip.lin_a.weight_g");
  EXPECT_TRUE(has(error_of([&] { PixelCnn(nn::Weights("w", tensors)); }),
                  "'outpaint2.down_layers.1.u_stream.2.nin_skip.lin_a.weight_g'"));
}

}  // namespace
}  // namespace ps::models
