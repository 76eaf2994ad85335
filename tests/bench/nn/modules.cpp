// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/nn/modules.h"

#include <memory>
#include <random>

#include "libps/models/autoencoder.h"
#include "libps/models/classifier.h"
#include "libps/models/depth_net.h"
#include "libps/models/discriminator.h"
#include "libps/models/pixel_cnn.h"
#include "libps/models/refiner.h"
#include "libps/outpaint/order.h"
#include "tests/support/random_weights.h"

namespace ps::bench {
namespace {

using models::ModelOptions;
using Forward = std::function<void(nn::Workspace&)>;

constexpr int kSide = 256;

/// Smooth patches with some noise, in [-1, 1]: more like a photo than noise alone.
std::shared_ptr<nn::Tensor> picture(int channels) {
  auto image = std::make_shared<nn::Tensor>(nn::Shape{1, kSide, kSide, channels});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(-0.1f, 0.1f);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int c = 0; c < channels; ++c) {
        image->view().pixel(0, y, x)[c] = 0.8f * std::sin(0.05f * static_cast<float>(x + 10 * c)) *
                                              std::cos(0.03f * static_cast<float>(y)) +
                                          noise(random);
      }
    }
  }
  return image;
}

std::shared_ptr<std::vector<std::int32_t>> some_codes() {
  auto codes = std::make_shared<std::vector<std::int32_t>>();
  for (int i = 0; i < 1024; ++i) codes->push_back(i * 7 % 512);
  return codes;
}

/// Published at 128 channels, else as the trainer makes them.
nn::Weights autoencoder_weights(int width) {
  return models::random_autoencoder(width, width / 2, width < 128 ? width / 2 : 32);
}

Forward depth(int width, const ModelOptions& options, nn::Tensor* out) {
  const auto net = std::make_shared<models::DepthNet>(models::random_depth_net(width), options);
  const auto in = picture(3);
  *out = nn::Tensor({1, kSide, kSide, 1});
  return [=](nn::Workspace& workspace) { net->forward(*in, *out, workspace); };
}

Forward vq_encode(int width, const ModelOptions& options, nn::Tensor* out) {
  const auto net = std::make_shared<models::Autoencoder>(autoencoder_weights(width), options);
  const auto in = picture(3);
  *out = nn::Tensor(net->grid(in->shape()));
  return [=](nn::Workspace& workspace) {
    std::int32_t codes[1024];
    net->encode(*in, *out, workspace);
    net->quantise(*out, codes);
  };
}

Forward vq_decode(int width, const ModelOptions& options, nn::Tensor* out) {
  const auto net = std::make_shared<models::Autoencoder>(autoencoder_weights(width), options);
  const auto codes = some_codes();
  *out = nn::Tensor({1, kSide, kSide, 3});
  return [=](nn::Workspace& workspace) { net->decode(codes->data(), *out, workspace); };
}

Forward pixel_cnn(int width, const ModelOptions& options, nn::Tensor* out) {
  const auto net = std::make_shared<models::PixelCnn>(models::random_pixel_cnn(width), options);
  cv::Mat1b background(kSide, kSide, std::uint8_t{0});
  background(cv::Rect(144, 0, 112, kSide)) = 1;
  const auto order = std::make_shared<outpaint::Order>(outpaint::order_of(background));
  const auto codes = some_codes();
  *out = nn::Tensor({1, 32, 32, 512});
  return
      [=](nn::Workspace& workspace) { net->forward(codes->data(), order->masks, *out, workspace); };
}

Forward refine(int width, const ModelOptions& options, nn::Tensor* out) {
  const auto net = std::make_shared<models::Refiner>(models::random_refiner(width), options);
  const auto in = picture(4);
  const auto noise = std::make_shared<std::vector<float>>(net->noise_count(), 0.3f);
  *out = nn::Tensor({1, kSide, kSide, 3});
  return [=](nn::Workspace& workspace) { net->forward(*in, noise->data(), *out, workspace); };
}

Forward discriminate(int width, const ModelOptions& options, nn::Tensor* out) {
  const auto net =
      std::make_shared<models::Discriminator>(models::random_discriminator(width), options);
  const auto in = picture(3);
  *out = nn::Tensor({1, 1, 1, 1});
  return [=](nn::Workspace& workspace) { net->score(*in, out->data(), workspace); };
}

Forward classify(int width, const ModelOptions& options, nn::Tensor* out) {
  const auto net = std::make_shared<models::Classifier>(models::random_classifier(width), options);
  const auto in = picture(3);
  *out = nn::Tensor({1, 1, 1, net->classes()});
  return [=](nn::Workspace& workspace) { net->forward(*in, *out, workspace); };
}

template <typename Make>
auto bound(const Make& make, int width) {
  return [=](const ModelOptions& options, nn::Tensor* out) { return make(width, options, out); };
}

}  // namespace

std::vector<Module> modules() {
  return {{"depth U-Net", 5.53, 45, bound(depth, 32)},
          {"VQ encode", 3.73, 30, bound(vq_encode, 128)},
          {"VQ decode", 2.58, 20, bound(vq_decode, 128)},
          {"PixelCNN, whole", 11.43, 0, bound(pixel_cnn, 80)},
          {"refinement", 128.2, 500, bound(refine, 64)},
          {"discriminator", 9.20, 70, bound(discriminate, 64)},
          {"classifier at 256^2", 4.74, 0, bound(classify, 64)}};
}

std::vector<Module> modules_of_widths() {
  std::vector<Module> all;
  const auto add = [&](const std::string& name, const std::vector<int>& widths, const auto& make) {
    for (const int width : widths) {
      all.push_back({name + ", " + std::to_string(width), 0, 0, bound(make, width)});
    }
  };
  add("depth U-Net", {8, 16, 24}, depth);
  add("VQ encode", {32, 64, 96}, vq_encode);
  add("VQ decode", {32, 64, 96}, vq_decode);
  add("PixelCNN, whole", {16, 32, 48}, pixel_cnn);
  add("refinement", {8, 16, 24}, refine);
  add("discriminator", {8, 16, 24}, discriminate);
  add("classifier at 256^2", {8, 16, 24}, classify);
  return all;
}

}  // namespace ps::bench
