// SPDX-License-Identifier: BSD-3-Clause
// A network in training and the same weights in libps/models give the same numbers.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <numeric>
#include <vector>

#include "libps/models/autoencoder.h"
#include "libps/models/classifier.h"
#include "libps/models/depth_net.h"
#include "libps/models/discriminator.h"
#include "libps/models/lpips.h"
#include "libps/models/pixel_cnn.h"
#include "libps/models/refiner.h"
#include "libps/outpaint/order.h"
#include "libps/outpaint/sampler.h"
#include "libps/train/autoencoder.h"
#include "libps/train/classifier.h"
#include "libps/train/completions.h"
#include "libps/train/depth_net.h"
#include "libps/train/discriminator.h"
#include "libps/train/layers.h"
#include "libps/train/lpips.h"
#include "libps/train/pixel_cnn.h"
#include "libps/train/refiner.h"
#include "libps/train/upsample.h"
#include "tests/support/random_weights.h"
#include "tests/train/support.h"

namespace ps::train {
namespace {

/// Statistics and small weights as after some training, so that none of them could be left out.
void disturb(const Parameters& parameters) {
  const torch::NoGradGuard guard;
  torch::Generator generator = generator_of(5, 0);
  for (const auto& [name, tensor] : parameters.named()) {
    if (name.find("embed") != std::string::npos) {
      tensor.copy_(torch::randn(tensor.sizes(), generator));
    } else if (tensor.dim() < 2) {
      const Tensor by = torch::rand(tensor.sizes(), generator);
      tensor.copy_(name.find("var") != std::string::npos ? by + .5 : tensor + .2 * (by - .5));
    }
  }
}

nn::Tensor to_ours(const Tensor& x) {
  const Tensor dense = x.detach().permute({0, 2, 3, 1}).contiguous();
  nn::Tensor out({static_cast<int>(dense.size(0)), static_cast<int>(dense.size(1)),
                  static_cast<int>(dense.size(2)), static_cast<int>(dense.size(3))});
  std::copy_n(dense.data_ptr<float>(), dense.numel(), out.data());
  return out;
}

/// The largest difference over the largest value.
double difference(const nn::Tensor& ours, const Tensor& theirs) {
  const nn::Tensor other = to_ours(theirs);
  EXPECT_TRUE(ours.shape() == other.shape());
  double most = 0, largest = 0;
  const std::size_t count = ours.shape().pixels() * static_cast<std::size_t>(ours.shape().channels);
  for (std::size_t i = 0; i < count; ++i) {
    most = std::max<double>(most, std::abs(ours.data()[i] - other.data()[i]));
    largest = std::max<double>(largest, std::abs(other.data()[i]));
  }
  EXPECT_GT(largest, 0);
  return most / largest;
}

Tensor picture(int n, int side, int channels = 3) {
  return torch::rand({n, channels, side, side}, generator_of(7, 0)) * 2 - 1;
}

bool all_gradients_finite(const Parameters& parameters) {
  for (const auto& [name, tensor] : parameters.trained()) {
    if (!tensor.grad().defined() || !torch::isfinite(tensor.grad()).all().item<bool>()) {
      ADD_FAILURE() << name;
      return false;
    }
  }
  return true;
}

TEST(TrainedDepthNet, gives_what_models_depth_net_gives) {
  const DepthNet net(4, 1);
  disturb(net.parameters);
  const Tensor image = picture(2, 256);
  nn::Tensor raw({2, 256, 256, 1});
  nn::Workspace workspace;
  models::DepthNet(weights_of(net.parameters)).forward(to_ours(image), raw, workspace);
  EXPECT_LT(difference(raw, net.forward(image, false)), 1e-5);
}

double most_apart(const Tensor& a, const Tensor& b) { return (a - b).abs().max().item<double>(); }

TEST(Upsampling, gives_what_libtorch_gives_and_its_gradients) {
  for (const auto& [h, w] : {std::make_pair(5, 3), std::make_pair(1, 1), std::make_pair(8, 16)}) {
    const Tensor x = torch::rand({2, 3, h, w}, generator_of(1, 0)).requires_grad_();
    const Tensor weight = torch::rand({2, 3, 2 * h, 2 * w}, generator_of(2, 0));
    const Tensor ours = upsample_2x(x);
    const Tensor other = torch::upsample_bilinear2d(x, {2 * h, 2 * w}, false);
    EXPECT_LT(most_apart(ours, other), 1e-6);
    const auto gradient = [&](const Tensor& y) {
      return torch::autograd::grad({(y * weight).sum()}, {x})[0];
    };
    EXPECT_LT(most_apart(gradient(ours), gradient(other)), 1e-5);
  }
}

TEST(NarrowProducts, change_digits_where_they_are_asked_for_and_nowhere_else) {
  const DepthNet net(4, 1);
  const Tensor image = picture(1, 256), exact = net.forward(image, false);
  {
    const NarrowProducts on(true);
    const Tensor narrow = net.forward(image, false);
    EXPECT_EQ(narrow.scalar_type(), torch::kFloat32);
    EXPECT_GT(most_apart(narrow, exact), 0);
    EXPECT_LT(most_apart(narrow, exact), .05 * exact.abs().max().item<double>());
    const NarrowProducts off(false);
    EXPECT_EQ(most_apart(net.forward(image, false), exact), 0);
  }
  EXPECT_EQ(most_apart(net.forward(image, false), exact), 0);
}

TEST(TrainedAutoencoder, gives_what_models_autoencoder_gives) {
  const Autoencoder net({16, 8, 8, 32}, 1);
  disturb(net.parameters);
  const Tensor image = picture(2, 64);
  const Tensor pre_quant = net.encode(image), codes = net.nearest(pre_quant);
  const models::Autoencoder ours(weights_of(net.parameters));
  nn::Workspace workspace;
  nn::Tensor our_pre_quant({2, 8, 8, 8}), our_image({2, 64, 64, 3});
  ours.encode(to_ours(image), our_pre_quant, workspace);
  EXPECT_LT(difference(our_pre_quant, pre_quant), 1e-5);
  std::vector<std::int32_t> our_codes(128);
  ours.quantise(our_pre_quant, our_codes.data());
  for (std::int64_t i = 0; i < 128; ++i) {
    EXPECT_EQ(codes.flatten()[i].item<std::int64_t>(), our_codes[static_cast<std::size_t>(i)]);
  }
  ours.decode(our_codes.data(), our_image, workspace);
  EXPECT_LT(difference(our_image, net.decode(net.embed(codes))), 1e-5);
}

TEST(TrainedPixelCnn, gives_what_models_pixel_cnn_gives) {
  const PixelCnn net(12, 32, 1);
  disturb(net.parameters);
  cv::Mat1b background(96, 96, static_cast<uchar>(0));
  background.colRange(50, 96).setTo(1);
  const outpaint::Order order = outpaint::order_of(background);
  const Tensor codes = torch::randint(32, {2, 12, 12}, generator_of(3, 0));
  std::vector<std::int64_t> cells(order.cells.begin(), order.cells.end());
  const Tensor both = torch::tensor(cells).unsqueeze(0).repeat({2, 1});
  const Tensor logits = net.forward(codes, both).view({2, 12, 12, 32}).permute({0, 3, 1, 2});
  std::vector<std::int32_t> our_codes;
  for (std::int64_t i = 0; i < 288; ++i) {
    our_codes.push_back(codes.flatten()[i].item<std::int32_t>());
  }
  nn::Tensor ours({2, 12, 12, 32});
  nn::Workspace workspace;
  models::PixelCnn(weights_of(net.parameters))
      .forward(our_codes.data(), order.masks, ours, workspace);
  EXPECT_LT(difference(ours, logits), 1e-4);
}

TEST(TrainedPixelCnn, has_the_gradients_of_finite_differences_and_all_finite) {
  const PixelCnn net(6, 8, 1);
  const Tensor codes = torch::randint(8, {2, 5, 5}, generator_of(3, 0));
  const Tensor order = torch::stack({torch::randperm(25, generator_of(4, 0)), torch::arange(25)});
  const auto loss = [&] {
    const Tensor each = torch::log_softmax(net.forward(codes, order), 1);
    return -each.gather(1, codes.view({-1, 1})).mean();
  };
  loss().backward();
  ASSERT_TRUE(all_gradients_finite(net.parameters));
  const torch::NoGradGuard guard;
  for (const char* name : {"up_layers.0.u_stream.0.conv_input.weight", "downsize_u_stream.0.weight",
                           "down_layers.2.u_stream.1.conv_out.weight", "u_init.weight"}) {
    const Tensor weight = net.parameters[name].detach();
    const Tensor direction = torch::randn(weight.sizes(), generator_of(9, 0));
    const double expected = (net.parameters[name].grad() * direction).sum().item<double>();
    constexpr double kStep = 1e-3;
    weight.add_(direction, kStep);
    const double above = loss().item<double>();
    weight.add_(direction, -2 * kStep);
    const double below = loss().item<double>();
    weight.add_(direction, kStep);
    EXPECT_NEAR((above - below) / (2 * kStep), expected, 2e-2 * std::abs(expected) + 2e-3) << name;
  }
}

TEST(TrainedRefiner, gives_what_models_refiner_gives) {
  const Refiner net(4, 1);
  disturb(net.parameters);
  const Tensor input = picture(1, 32, 4);
  const models::Refiner ours(weights_of(net.parameters));
  // Both draw their noise layer by layer.
  torch::Generator generator = generator_of(11, 0), same = generator_of(11, 0);
  std::vector<float> noise;
  while (noise.size() < ours.noise_count()) {
    const Tensor drawn = torch::randn({1, Refiner::kNoise}, same);
    noise.insert(noise.end(), drawn.data_ptr<float>(), drawn.data_ptr<float>() + drawn.numel());
  }
  nn::Tensor output({1, 32, 32, 3});
  nn::Workspace workspace;
  ours.forward(to_ours(input), noise.data(), output, workspace);
  EXPECT_LT(difference(output, net.forward(input, generator, false)), 1e-5);
}

TEST(TrainedDiscriminator, gives_what_models_discriminator_gives) {
  Discriminator net(4, 1);
  const Tensor image = picture(2, 64);
  for (int i = 0; i < 5; ++i) net.forward(image, true);
  const auto maps = net.forward(image, false);
  const Tensor score = (torch::relu(1 + maps[0].back()).mean({1, 2, 3}) +
                        torch::relu(1 + maps[1].back()).mean({1, 2, 3})) /
                       2;
  float ours[2];
  nn::Workspace workspace;
  models::Discriminator(weights_of(net.parameters)).score(to_ours(image), ours, workspace);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(ours[i], score[i].item<float>(), 1e-4);
}

TEST(TrainedClassifier, gives_what_models_classifier_gives) {
  const Classifier net(8, 5, 1);
  disturb(net.parameters);
  for (const int side : {64, 75}) {
    const Tensor image = picture(2, side);
    nn::Tensor input = to_ours(image), logits({2, 1, 1, 5});
    models::Classifier::normalise(input, input);
    nn::Workspace workspace;
    models::Classifier(weights_of(net.parameters)).forward(input, logits, workspace);
    const Tensor theirs = net.forward(image, false).view({2, 5, 1, 1});
    EXPECT_LT(difference(logits, theirs), 1e-4) << side;
  }
}

/// Weights by chance, in a file as the published ones are.
TensorMap random_features() {
  TensorMap file;
  const nn::Weights weights = models::random_lpips(8);
  for (const auto& [name, tensor] : weights.tensors()) {
    file[name] = FileTensor::of(tensor.values, tensor.shape);
  }
  return file;
}

TEST(TrainingLpips, gives_what_models_lpips_gives_and_gradients_to_the_first_picture) {
  const Folder folder;
  write_shard(folder, "weights", random_features());
  const Lpips net(folder.path() / "weights.safetensors", torch::kCPU);
  const models::Lpips ours(models::random_lpips(8));
  nn::Workspace workspace;
  for (const int side : {64, 75}) {
    Tensor a = picture(2, side).requires_grad_(true);
    const Tensor b = (picture(2, side).flip({3}) + .1).clamp(-1, 1);
    float distances[2];
    ours.distance(to_ours(a), to_ours(b), distances, workspace);
    const Tensor theirs = net.distance(a, b);
    const double expected = (distances[0] + distances[1]) / 2.;
    EXPECT_GT(expected, .01);
    EXPECT_NEAR(theirs.item<double>(), expected, 1e-4 * expected) << side;
    theirs.backward();
    EXPECT_GT(a.grad().abs().sum().item<double>(), 0);
  }
  EXPECT_EQ(net.distance(picture(1, 64), picture(1, 64)).item<double>(), 0);
}

TEST(TrainingLpips, names_the_tensor_that_is_missing) {
  const Folder folder;
  TensorMap file = random_features();
  file.erase("lin4.model.1.weight");
  write_shard(folder, "weights", file);
  const Lpips net(folder.path() / "weights.safetensors", torch::kCPU);
  const std::string message = error_of([&] { net.distance(picture(1, 64), picture(1, 64)); });
  EXPECT_NE(message.find("there is no tensor lin4.model.1.weight"), std::string::npos);
}

TEST(Completions, keep_what_is_seen_differ_elsewhere_and_are_the_sampler_s) {
  const PixelCnn net(12, 32, 1);
  cv::Mat1b background(96, 96, static_cast<uchar>(0));
  background.colRange(50, 96).setTo(1);
  const outpaint::Order order = outpaint::order_of(background);
  const std::vector<std::int64_t> cells(order.cells.begin(), order.cells.end()),
      missing(order.missing.begin(), order.missing.end());
  const Tensor codes = torch::randint(32, {12, 12}, generator_of(3, 0));
  const Tensor unseen = torch::tensor(missing).to(torch::kFloat32);
  const Tensor made = completions(net.parameters, codes, torch::tensor(cells), unseen, 8);
  ASSERT_EQ(made.sizes(), torch::IntArrayRef({8, 12, 12}));
  const Tensor off = (made != codes).flatten(1).to(torch::kFloat32);
  EXPECT_EQ((off * (1 - unseen)).sum().item<double>(), 0);
  EXPECT_GT(unseen.sum().item<double>(), 40);
  EXPECT_FALSE(torch::equal(made[0], made[1]));
  const models::PixelCnn ours(weights_of(net.parameters));
  std::vector<std::int32_t> known;
  for (std::int64_t i = 0; i < 144; ++i) known.push_back(codes.flatten()[i].item<std::int32_t>());
  const auto expected = outpaint::Sampler(ours, order, known).sample(0, 8);
  for (std::int64_t i = 0; i < 144; ++i) {
    EXPECT_EQ(made[7].flatten()[i].item<std::int32_t>(),
              expected[7].codes[static_cast<std::size_t>(i)]);
  }
  // Where nothing is missing, there is nothing to make.
  const Tensor whole = completions(net.parameters, codes, torch::tensor(cells), unseen * 0, 2);
  EXPECT_TRUE(torch::equal(whole[1], codes));
}

TEST(PublishedWidths, have_the_published_numbers_of_parameters) {
  const double millions = 1e6;
  EXPECT_NEAR(static_cast<double>(DepthNet(32, 0).parameters.count()) / millions, 9.80, .01);
  EXPECT_NEAR(static_cast<double>(Autoencoder({}, 0).parameters.count()) / millions, .66 + .36,
              .01);
  EXPECT_NEAR(static_cast<double>(PixelCnn(80, 512, 0).parameters.count()) / millions, 5.59, .01);
  EXPECT_NEAR(static_cast<double>(Refiner(64, 0).parameters.count()) / millions, 3.54, .02);
  EXPECT_NEAR(static_cast<double>(Discriminator(64, 0).parameters.count()) / millions, 5.53, .01);
  EXPECT_NEAR(static_cast<double>(Classifier(64, 365, 0).parameters.count()) / millions, 11.36,
              .01);
}

}  // namespace
}  // namespace ps::train
