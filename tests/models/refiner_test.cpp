// SPDX-License-Identifier: BSD-3-Clause
// The refinement network gives the published one's numbers (SPEC.md 8).
#include "libps/models/refiner.h"

#include <cmath>

#include "tests/models/support.h"
#include "tests/support/random_weights.h"

namespace ps::models {
namespace {

/// The image and, behind it, where it is not background.
nn::Tensor input_of(const nn::TensorView& image, const std::vector<std::uint8_t>& background) {
  nn::Shape shape = image.shape;
  shape.channels = 4;
  nn::Tensor input(shape);
  for (std::size_t i = 0; i < shape.pixels(); ++i) {
    std::copy_n(image.pixel(i), 3, input.view().pixel(i));
    input.view().pixel(i)[3] = background[i] == 0 ? 1.f : 0.f;
  }
  return input;
}

nn::Tensor waves(const nn::Shape& shape) {
  nn::Tensor tensor(shape);
  for (std::size_t i = 0; i < shape.pixels() * static_cast<std::size_t>(shape.channels); ++i) {
    tensor.data()[i] = std::sin(0.01f * static_cast<float>(i));
  }
  return tensor;
}

std::vector<float> noise_of(const Refiner& net, int images) {
  std::vector<float> noise(net.noise_count() * static_cast<std::size_t>(images));
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = std::cos(static_cast<float>(i));
  return noise;
}

class RefinerReference : public testing::TestWithParam<Setting> {};

TEST_P(RefinerReference, equals_the_published_network) {
  PS_NEED_SHARED("reference/f_refine.safetensors");
  const TensorMap reference = read_safetensors(shared("reference/f_refine.safetensors"));
  const Refiner net(reference_weights(), GetParam().options);
  nn::Workspace workspace;
  const bool exact = is_exact(GetParam());
  for (const std::string name : {"", "case2."}) {
    const nn::Tensor image = tensor_of(reference.at(name.empty() ? "combined" : "case2.input"));
    const auto noise = reference.at(name + "noise").as_floats();
    ASSERT_EQ(noise.size(), net.noise_count());
    nn::Tensor output(image.shape());
    net.forward(input_of(image, bytes_of(reference.at(name + "bg_dilated"))), noise.data(), output,
                workspace);
    expect_near(name + "output", output, tensor_of(reference.at(name + "output")),
                exact ? 1e-4 : 0.15, exact ? 1e-3 : 1);
  }
}

INSTANTIATE_TEST_SUITE_P(settings, RefinerReference, testing::ValuesIn(all_settings()), name_of);

TEST(Refiner, equals_its_golden) {
  const Refiner net(golden_weights());
  nn::Workspace workspace;
  const nn::Tensor image = golden_corner(), expected = tensor_of(goldens().at("refine.output"));
  nn::Tensor output(image.shape());
  net.forward(input_of(image, bytes_of(goldens().at("refine.bg_dilated"))),
              goldens().at("refine.noise").as_floats().data(), output, workspace);
  // These pixels do not see where the photo was cut.
  expect_near("output", corner_of(output, expected.shape().width), expected, 1e-4);
}

TEST(Refiner, adds_the_image_before_or_behind_tanh) {
  const nn::Weights weights = random_refiner(4);
  const Refiner inside(weights), outside(weights, {}, Refiner::Output::tanh_of_net);
  nn::Workspace workspace;
  const nn::Tensor input = waves({1, 12, 8, 4});
  const auto noise = noise_of(inside, 1);
  nn::Tensor a({1, 12, 8, 3}), b(a.shape());
  inside.forward(input, noise.data(), a, workspace);
  outside.forward(input, noise.data(), b, workspace);
  double largest = 0;
  for (std::size_t i = 0; i < a.shape().pixels(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double image = input.view().pixel(i)[c];
      const double net = std::atanh(static_cast<double>(a.view().pixel(i)[c])) - image;
      EXPECT_NEAR(std::tanh(net) + image, b.view().pixel(i)[c], 1e-4);
      largest = std::max(largest, std::abs(net));
    }
  }
  EXPECT_GT(largest, 0.05);
}

TEST(Refiner, treats_images_of_a_batch_alone_with_noise_of_their_own) {
  const Refiner net(random_refiner(2));
  nn::Workspace workspace;
  const nn::Tensor both = waves({2, 12, 20, 4});
  const auto noise = noise_of(net, 2);
  nn::Tensor out({2, 12, 20, 3}), alone({1, 12, 20, 3});
  net.forward(both, noise.data(), out, workspace);
  for (int i = 0; i < 2; ++i) {
    net.forward(both.view().images(i, 1), noise.data() + net.noise_count() * i, alone, workspace);
    EXPECT_EQ(difference(alone, out.view().images(i, 1)).worst, 0);
  }
  net.forward(both.view().images(0, 1), noise.data() + net.noise_count(), alone, workspace);
  EXPECT_GT(difference(alone, out.view().images(0, 1)).worst, 1e-4);
}

TEST(Refiner, needs_less_than_400_MiB_at_the_published_width) {
  const Refiner net(random_refiner());
  nn::Workspace workspace;
  const nn::Tensor input = waves({1, 256, 256, 4});
  nn::Tensor output({1, 256, 256, 3});
  net.forward(input, noise_of(net, 1).data(), output, workspace);
  std::printf("  workspace: %.1f MiB\n", static_cast<double>(workspace.bytes()) / (1 << 20));
  EXPECT_LT(workspace.bytes(), std::size_t{300} << 20);  // weights and what runs it are the rest
}

TEST(Refiner, refuses_what_does_not_fit) {
  const Refiner net(random_refiner(2));
  nn::Workspace workspace;
  const auto noise = noise_of(net, 1);
  nn::Tensor output({1, 8, 8, 3});
  const auto forward = [&](const nn::Shape& input) {
    return error_of([&] { net.forward(nn::Tensor(input), noise.data(), output, workspace); });
  };
  EXPECT_TRUE(has(forward({1, 10, 8, 4}), "multiples of 4"));
  EXPECT_TRUE(has(forward({1, 8, 8, 3}), "4 channels"));
  EXPECT_TRUE(has(forward({1, 12, 8, 4}), "output has the shape"));
  auto tensors = random_refiner(2).tensors();
  tensors["projector.eblocks.4.ch_a.3.bn.stored_var"].values[1] = NAN;
  EXPECT_TRUE(has(error_of([&] { Refiner(nn::Weights("w", tensors)); }),
                  "'projector.eblocks.4.ch_a.3.bn.stored_var' holds NaN"));
}

/// Weights with one tensor changed.
nn::Weights changed(const std::string& name, const nn::WeightTensor& tensor) {
  auto tensors = random_refiner(8).tensors();
  EXPECT_EQ(tensors.count(name), 1u) << name;
  tensors[name] = tensor;
  return nn::Weights("w", tensors);
}

TEST(Refiner, names_noise_layers_of_another_width_and_negative_variances) {
  const auto all = random_refiner(8).tensors();
  for (const auto& [name, tensor] : all) {
    const bool gain = name.find(".gain.weight") != std::string::npos;
    const bool first = name.find("eblocks.0.ch_a.0.gain") != std::string::npos;
    if (first || !(gain || name.find(".bias.weight") != std::string::npos)) continue;
    if (tensor.shape.size() != 2) continue;
    nn::WeightTensor narrow = {{tensor.shape[0], tensor.shape[1] / 2}, {}};
    narrow.values.resize(narrow.elements());
    EXPECT_TRUE(has(error_of([&] { Refiner(changed(name, narrow)); }), name)) << name;
  }
  const std::string name = "projector.eblocks.2.ch_a.3.bn.stored_var";
  nn::WeightTensor variance = all.at(name);
  variance.values[1] = -1;
  EXPECT_TRUE(has(error_of([&] { Refiner(changed(name, variance)); }), name));
}

}  // namespace
}  // namespace ps::models
