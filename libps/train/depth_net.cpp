// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/depth_net.h"

#include <string>
#include <vector>

#include "libps/models/depth_net.h"
#include "libps/train/layers.h"
#include "libps/train/narrow_norm.h"
#include "libps/train/upsample.h"
#include "libps/train/upsampled_sum.h"

namespace ps::train {
namespace {

constexpr int kLevels = 8;
constexpr int kEncoderWidths[kLevels] = {1, 2, 4, 8, 8, 8, 8, 8};
constexpr int kDecoderWidths[kLevels - 1] = {8, 8, 8, 8, 4, 2, 1};

std::string encoder_norm(int level) { return models::DepthNet::kEncoderNorms[level]; }
std::string encoder_name(int level) { return "conv" + std::to_string(level + 1); }
std::string decoder_name(int level) { return "dconv" + std::to_string(level + 1); }

}  // namespace

DepthNet::DepthNet(int f, std::uint64_t seed) : parameters("pts_regressor.", seed) {
  int in = 3;
  for (int i = 0; i < kLevels; ++i) {
    const int out = f * kEncoderWidths[i];
    add_convolution(parameters, encoder_name(i), in, out, 4);
    if (!encoder_norm(i).empty()) add_batch_norm(parameters, encoder_norm(i), out);
    in = out;
  }
  for (int i = 0; i < kLevels; ++i) {
    const bool last = i + 1 == kLevels;
    const int out = last ? 1 : f * kDecoderWidths[i];
    add_convolution(parameters, decoder_name(i), in, out, 3, last ? .1 : 1);
    if (!last) add_batch_norm(parameters, models::DepthNet::kDecoderNorms[i], out);
    in = last ? out : out + f * kEncoderWidths[kLevels - 2 - i];
  }
}

Tensor DepthNet::forward(const Tensor& image, bool training) const {
  std::vector<Tensor> skips;
  Tensor x = image;
  for (int i = 0; i < kLevels; ++i) {
    // The decoder reads relu(x) of a skip, which is relu(leaky(x)).
    x = normed_convolution(parameters, encoder_name(i), encoder_norm(i), x, 2, 1,
                           i + 1 < kLevels ? .2F : 1.F, training);
    skips.push_back(x);
  }
  for (int i = 0; i + 1 < kLevels; ++i) {
    x = normed_convolution(parameters, decoder_name(i), models::DepthNet::kDecoderNorms[i],
                           relu_upsample_2x(x), 1, 1, 1, training);
    x = torch::cat({x, skips[static_cast<std::size_t>(kLevels - 2 - i)]}, 1);
  }
  const std::string last = decoder_name(kLevels - 1);
  return relu_upsample_to_one(x, parameters[last + ".weight"], parameters[last + ".bias"]);
}

}  // namespace ps::train
