// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/random_weights.h"

#include <gtest/gtest.h>

namespace ps::models {
namespace {

/// In millions: what is trained, statistics left out.
double parameters(const nn::Weights& weights) {
  std::size_t count = 0;
  for (const auto& [name, tensor] : weights.tensors()) {
    const bool statistic = name.find("running_") != std::string::npos ||
                           name.find("stored_") != std::string::npos ||
                           name.find("embed") != std::string::npos;
    if (!statistic) count += tensor.elements();
  }
  return static_cast<double>(count) / 1e6;
}

/// SPEC.md 2 counts them; so the widths of all layers are the published ones.
TEST(RandomWeights, are_as_many_as_the_published_ones) {
  EXPECT_NEAR(parameters(random_depth_net()), 9.80, 0.005);
  EXPECT_NEAR(parameters(random_autoencoder()), 0.66 + 0.36, 0.01);
  EXPECT_NEAR(parameters(random_pixel_cnn()), 5.59, 0.005);
  EXPECT_NEAR(parameters(random_refiner()), 3.54, 0.005);
  EXPECT_NEAR(parameters(random_discriminator()), 5.53, 0.005);
  EXPECT_NEAR(parameters(random_classifier()), 11.36, 0.005);
}

TEST(RandomWeights, are_the_same_each_time) {
  const auto first = random_refiner(2), second = random_refiner(2);
  ASSERT_FALSE(first.tensors().empty());
  for (const auto& [name, tensor] : first.tensors()) {
    EXPECT_EQ(tensor.values, second.tensors().at(name).values) << name;
  }
}

}  // namespace
}  // namespace ps::models
