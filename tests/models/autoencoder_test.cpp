// SPDX-License-Identifier: BSD-3-Clause
// The VQ-VAE's top level gives the published one's numbers and codes (SPEC.md 5).
#include "libps/models/autoencoder.h"

#include <cmath>

#include "tests/models/support.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

constexpr float kClearGap = 1e-3f;  ///< between the two nearest codes: below it either may win

class AutoencoderReference : public testing::TestWithParam<Setting> {};

TEST_P(AutoencoderReference, equals_the_published_network) {
  PS_NEED_SHARED("reference/b_vqvae.safetensors");
  const TensorMap reference = read_safetensors(shared("reference/b_vqvae.safetensors"));
  const Autoencoder net(reference_weights(), GetParam().options);
  const bool exact = is_exact(GetParam());
  nn::Workspace workspace;
  for (const std::string name : {"1011.", "606.", "fsR."}) {
    const nn::Tensor expected = tensor_of(reference.at(name + "pre_quant"));
    nn::Tensor pre_quant(expected.shape());
    net.encode(tensor_of(reference.at(name + "input")), pre_quant, workspace);
    expect_near(name + "pre_quant", pre_quant, expected, exact ? 1e-4 : 2e-2, exact ? 1e-3 : 1);

    const auto codes = ints_of(reference.at(name + "codes"));
    const auto gap = reference.at(name + "gap").as_floats();
    std::vector<std::int32_t> nearest(codes.size());
    net.quantise(pre_quant, nearest.data());
    int unlike = 0, unclear = 0;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      unlike += nearest[i] != codes[i];
      unclear += gap[i] <= kClearGap;
      if (exact && gap[i] > kClearGap) {
        EXPECT_EQ(nearest[i], codes[i]) << name << i;
      }
    }
    std::printf("  %scodes: %d of %zu unlike, %d unclear\n", name.c_str(), unlike, codes.size(),
                unclear);

    const nn::Tensor image = tensor_of(reference.at(name + "decoded"));
    nn::Tensor decoded(image.shape());
    net.decode(codes.data(), decoded, workspace);
    expect_near(name + "decoded", decoded, image, exact ? 1e-4 : 2e-2, exact ? 1e-3 : 1);
  }
}

INSTANTIATE_TEST_SUITE_P(settings, AutoencoderReference, testing::ValuesIn(all_settings()),
                         name_of);

TEST(Autoencoder, equals_its_golden) {
  const Autoencoder net(golden_weights());
  nn::Workspace workspace;
  const nn::Tensor corner = golden_corner();
  nn::Tensor pre_quant(net.grid(corner.shape()));
  net.encode(corner, pre_quant, workspace);
  // These cells do not see where the photo was cut.
  const nn::Tensor expected = tensor_of(goldens().at("vq.pre_quant"));
  const nn::Tensor seen = corner_of(pre_quant, expected.shape().width);
  expect_near("pre_quant", seen, expected, 1e-4);
  const auto nearest = ints_of(goldens().at("vq.nearest"));
  const auto clear = bytes_of(goldens().at("vq.clear"));
  std::vector<std::int32_t> found(nearest.size());
  net.quantise(seen, found.data());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (clear[i] != 0) {
      EXPECT_EQ(found[i], nearest[i]) << i;
    }
  }
  nn::Tensor decoded({1, 256, 256, 3});
  net.decode(ints_of(goldens().at("vq.codes")).data(), decoded, workspace);
  expect_near("decoded", every(7, decoded), tensor_of(goldens().at("vq.decoded")), 1e-4);
}

TEST(Autoencoder, encodes_and_decodes_other_sizes_image_by_image) {
  const Autoencoder net(random_autoencoder(8, 4, 4, 16));
  nn::Workspace workspace;
  nn::Tensor both({2, 40, 24, 3}), decoded(both.shape()), alone({1, 40, 24, 3});
  for (std::size_t i = 0; i < both.shape().pixels() * 3; ++i) {
    both.data()[i] = std::sin(0.01f * static_cast<float>(i));
  }
  std::vector<std::int32_t> codes(2 * 5 * 3), one(5 * 3);
  net.encode(both, codes.data(), workspace);
  net.decode(codes.data(), decoded, workspace);
  for (int i = 0; i < 2; ++i) {
    net.encode(both.view().images(i, 1), one.data(), workspace);
    EXPECT_TRUE(std::equal(one.begin(), one.end(), codes.begin() + 15 * i));
    net.decode(one.data(), alone, workspace);
    EXPECT_EQ(difference(alone, decoded.view().images(i, 1)).worst, 0);
  }
}

TEST(Autoencoder, refuses_what_does_not_fit) {
  const Autoencoder net(random_autoencoder(8, 4, 4, 16));
  nn::Workspace workspace;
  const nn::Tensor odd({1, 20, 24, 3}), image({1, 16, 24, 3}), grid({1, 2, 2, 4});
  std::vector<std::int32_t> codes(6, 16);
  EXPECT_TRUE(has(error_of([&] { net.encode(odd, codes.data(), workspace); }), "multiples of 8"));
  EXPECT_TRUE(has(error_of([&] { net.encode(image, grid, workspace); }), "[1, 2, 3, 4]"));
  EXPECT_TRUE(has(error_of([&] { net.decode(codes.data(), image, workspace); }), "16"));
}

TEST(Autoencoder, reads_nothing_of_the_bottom_level_and_names_what_is_missing) {
  auto tensors = random_autoencoder(8, 4, 4, 16).tensors();
  tensors.erase("vqvae.dec.blocks.2.conv.3.bias");
  EXPECT_TRUE(has(error_of([&] { Autoencoder(nn::Weights("w", tensors)); }),
                  "'vqvae.dec.blocks.2.conv.3.bias' is missing"));
}

}  // namespace
}  // namespace ps::models
