// SPDX-License-Identifier: BSD-3-Clause
// The depth U-Net gives the published one's numbers (SPEC.md 3).
#include "libps/models/depth_net.h"

#include <cmath>

#include "tests/models/support.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

class DepthNetReference : public testing::TestWithParam<Setting> {};

TEST_P(DepthNetReference, equals_the_published_network) {
  PS_NEED_SHARED("reference/a_unet.safetensors");
  const TensorMap reference = read_safetensors(shared("reference/a_unet.safetensors"));
  const DepthNet net(reference_weights(), GetParam().options);
  nn::Workspace workspace;
  for (const std::string image : {"1011", "606"}) {
    const nn::Tensor expected = tensor_of(reference.at("raw_" + image));
    nn::Tensor raw(expected.shape());
    net.forward(tensor_of(reference.at("input_" + image)), raw, workspace);
    const bool exact = is_exact(GetParam());
    expect_near("raw " + image, raw, expected, exact ? 1e-4 : 2e-2, exact ? 1e-3 : 1);
    depth_of_raw(raw, 1, 100, raw);
    expect_near("depth " + image, raw, tensor_of(reference.at("depth_" + image)),
                exact ? 1e-4 : 2e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(settings, DepthNetReference, testing::ValuesIn(all_settings()), name_of);

TEST(DepthNet, equals_its_golden) {
  nn::Tensor raw({1, 256, 256, 1});
  nn::Workspace workspace;
  DepthNet(golden_weights()).forward(golden_picture(), raw, workspace);
  expect_near("raw", every(5, raw), tensor_of(goldens().at("depth.raw")), 1e-4);
}

TEST(DepthNet, treats_images_of_a_batch_alone_and_takes_other_sizes) {
  ModelOptions options;
  options.method = nn::Method::winograd;  // `automatic` may choose by the number of pixels
  const DepthNet net(random_depth_net(4), options);
  nn::Workspace workspace;
  nn::Tensor both({2, 256, 512, 3}), raw({2, 256, 512, 1}), alone({1, 256, 512, 1});
  for (std::size_t i = 0; i < both.shape().pixels() * 3; ++i) {
    both.data()[i] = std::sin(0.001f * static_cast<float>(i));
  }
  net.forward(both, raw, workspace);
  for (int i = 0; i < 2; ++i) {
    net.forward(both.view().images(i, 1), alone, workspace);
    const Difference d = difference(alone, raw.view().images(i, 1));
    EXPECT_EQ(d.worst, 0);
    EXPECT_GT(d.largest, 0.1);
    EXPECT_LT(d.largest, 100);
  }
}

TEST(DepthNet, writes_into_a_slice_of_channels) {
  const DepthNet net(random_depth_net(2));
  nn::Workspace workspace;
  nn::Tensor image({1, 256, 256, 3}), raw({1, 256, 256, 1}), wide({1, 256, 256, 3});
  net.forward(image, raw, workspace);
  net.forward(image, wide.view().channels(1, 1), workspace);
  EXPECT_EQ(difference(wide.view().channels(1, 1), raw).worst, 0);
  EXPECT_EQ(difference(wide.view().channels(0, 1), nn::Tensor(raw.shape())).worst, 0);
  EXPECT_EQ(difference(wide.view().channels(2, 1), nn::Tensor(raw.shape())).worst, 0);
}

TEST(DepthNet, refuses_what_does_not_fit) {
  const DepthNet net(random_depth_net(2));
  nn::Workspace workspace;
  const nn::Tensor raw({1, 256, 256, 1});
  const auto forward = [&](const nn::Shape& image) {
    return error_of([&] { net.forward(nn::Tensor(image), raw, workspace); });
  };
  EXPECT_TRUE(has(forward({1, 128, 256, 3}), "multiples of 256"));
  EXPECT_TRUE(has(forward({1, 256, 256, 4}), "3 channels"));
  EXPECT_TRUE(has(forward({2, 256, 256, 3}), "raw has the shape"));
  EXPECT_TRUE(has(forward({0, 256, 256, 3}), "[0, 256, 256, 3]"));
}

TEST(DepthNet, names_the_tensor_that_is_missing_or_misshapen) {
  const nn::Weights whole = random_depth_net(2);
  auto tensors = whole.tensors();
  tensors.erase("pts_regressor.batch_norm8_6.running_var");
  EXPECT_TRUE(has(error_of([&] { DepthNet(nn::Weights("w.safetensors", tensors)); }),
                  "w.safetensors: tensor 'pts_regressor.batch_norm8_6.running_var'"));
  tensors = whole.tensors();
  tensors["pts_regressor.dconv3.weight"].shape = {32, 16, 3, 3};
  tensors["pts_regressor.dconv3.weight"].values.resize(32 * 16 * 9);
  EXPECT_TRUE(has(error_of([&] { DepthNet(nn::Weights("w.safetensors", tensors)); }),
                  "'pts_regressor.dconv3.weight' has the shape [32, 16, 3, 3]"));
}

}  // namespace
}  // namespace ps::models
