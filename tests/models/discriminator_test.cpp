// SPDX-License-Identifier: BSD-3-Clause
// The discriminator gives the published one's numbers (SPEC.md 9).
#include "libps/models/discriminator.h"

#include <cmath>

#include "tests/models/support.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

/// The mean of max(0, 1 + sign * D).
double hinge(const nn::TensorView& logits, double sign) {
  double sum = 0;
  for (std::size_t i = 0; i < logits.shape.pixels(); ++i) {
    sum += std::max(0.0, 1 + sign * *logits.pixel(i));
  }
  return sum / static_cast<double>(logits.shape.pixels());
}

class DiscriminatorReference : public testing::TestWithParam<Setting> {};

TEST_P(DiscriminatorReference, equals_the_published_network) {
  PS_NEED_SHARED("reference/g_disc.safetensors");
  const TensorMap reference = read_safetensors(shared("reference/g_disc.safetensors"));
  const Discriminator net(reference_weights(), GetParam().options);
  const bool exact = is_exact(GetParam());
  nn::Workspace workspace;
  nn::Tensor images({2, 256, 256, 3});
  nn::from_planes(reference.at("fake").as_floats().data(), images.view().images(0, 1));
  nn::from_planes(reference.at("real").as_floats().data(), images.view().images(1, 1));
  const auto shapes = net.shapes(images.shape());
  Discriminator::Maps maps;
  std::vector<nn::Tensor> memory;
  for (std::size_t s = 0; s < Discriminator::kScales; ++s) {
    for (std::size_t l = 2; l < Discriminator::kLayers; ++l) {
      maps[s][l] = memory.emplace_back(shapes[s][l]);
    }
  }
  net.forward(images, maps, workspace);
  for (std::size_t s = 0; s < Discriminator::kScales; ++s) {
    for (std::size_t l = 2; l < Discriminator::kLayers; ++l) {
      const std::string name = "scale" + std::to_string(s) + ".layer" + std::to_string(l);
      const nn::Tensor expected = tensor_of(reference.at(name));
      expect_near(name, maps[s][l].images(0, expected.shape().images), expected,
                  exact ? 1e-4 : 2e-2, exact ? 1e-3 : 1);
    }
  }
  float scores[2];
  net.score(images, scores, workspace);
  const double fake = reference.at("D_Fake").as_floats()[0],
               real = reference.at("D_real").as_floats()[0], bound = exact ? 1e-5 : 1e-2;
  std::printf("  D_Fake: off by %.1e\n", scores[0] - fake);
  EXPECT_NEAR(scores[0], fake, bound);
  // In training a real image's loss is of 1 - D.
  EXPECT_NEAR((hinge(maps[0][4].images(1, 1), -1) + hinge(maps[1][4].images(1, 1), -1)) / 2, real,
              bound);
}

INSTANTIATE_TEST_SUITE_P(settings, DiscriminatorReference, testing::ValuesIn(all_settings()),
                         name_of);

TEST(Discriminator, equals_its_golden) {
  // The file holds the second scale alone, where all that is special happens; the first has other
  // weights and the same layers.
  auto tensors = golden_weights().tensors();
  for (const auto& [name, tensor] : golden_weights().tensors()) {
    const std::string second = "netD.discriminator_1";
    if (name.compare(0, second.size(), second) == 0) {
      tensors["netD.discriminator_0" + name.substr(second.size())] = tensor;
    }
  }
  const Discriminator net(nn::Weights("golden", tensors));
  nn::Workspace workspace;
  const nn::Tensor picture = golden_picture();
  nn::Tensor logits(net.shapes(picture.shape())[1][4]);
  Discriminator::Maps maps;
  maps[1][4] = logits;
  net.forward(picture, maps, workspace);
  expect_near("logits", logits, tensor_of(goldens().at("discriminator.scale1")), 1e-4);
}

TEST(Discriminator, scores_images_of_a_batch_alone_by_both_scales) {
  const Discriminator net(random_discriminator(4));
  nn::Workspace workspace;
  nn::Tensor images({2, 45, 52, 3});
  for (std::size_t i = 0; i < images.shape().pixels() * 3; ++i) {
    images.data()[i] = std::sin(0.02f * static_cast<float>(i));
  }
  float both[2];
  net.score(images, both, workspace);
  Discriminator::Maps maps;
  for (int i = 0; i < 2; ++i) {
    const nn::TensorView image = images.view().images(i, 1);
    float alone;
    net.score(image, &alone, workspace);
    EXPECT_EQ(alone, both[i]);
    const auto shapes = net.shapes(image.shape);
    const nn::Tensor large(shapes[0][4]), small(shapes[1][4]);
    maps[0][4] = large;
    maps[1][4] = small;
    net.forward(image, maps, workspace);
    EXPECT_NEAR(alone, (hinge(large, 1) + hinge(small, 1)) / 2, 1e-5);
  }
  EXPECT_NE(both[0], both[1]);
}

TEST(Discriminator, refuses_what_does_not_fit) {
  const Discriminator net(random_discriminator(2));
  nn::Workspace workspace;
  float score;
  EXPECT_TRUE(has(error_of([&] {
                    net.score(nn::Tensor({1, 64, 64, 4}), &score, workspace);
                  }),
                  "3 channels"));
  const nn::Tensor wrong({1, 9, 9, 1});
  Discriminator::Maps maps;
  maps[1][4] = wrong;
  EXPECT_TRUE(has(error_of([&] {
                    net.forward(nn::Tensor({1, 64, 64, 3}), maps, workspace);
                  }),
                  "a map has the shape [1, 9, 9, 1]"));
  auto tensors = random_discriminator(2).tensors();
  tensors.erase("netD.discriminator_1.model3.0.0.weight");
  EXPECT_TRUE(has(error_of([&] { Discriminator(nn::Weights("w", tensors)); }),
                  "'netD.discriminator_1.model3.0.0.weight'"));
}

}  // namespace
}  // namespace ps::models
