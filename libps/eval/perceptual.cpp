// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/perceptual.h"

#include "libps/models/lpips.h"

namespace ps {
namespace {

/// [0,1] to the networks' [-1,1].
nn::Tensor to_tensor(const Image& image) {
  nn::Tensor tensor({1, image.rows, image.cols, 3});
  float* to = tensor.data();
  for (const cv::Vec3f& color : image) {
    for (int c = 0; c < 3; ++c) *to++ = 2 * color[c] - 1;
  }
  return tensor;
}

}  // namespace

PerceptualDistance lpips_distance(const models::Lpips& net) {
  return [&net](const Image& a, const Image& b) {
    nn::Workspace workspace;
    float distance = 0;
    net.distance(to_tensor(a), to_tensor(b), &distance, workspace);
    return static_cast<double>(distance);
  };
}

FeatureNetwork lpips_features(const models::Lpips& net) {
  return {"SqueezeNet 1.1 fire-9", [&net](const Image& image) {
            nn::Workspace workspace;
            std::vector<float> features(static_cast<std::size_t>(net.feature_count()));
            net.features(to_tensor(image), features.data(), workspace);
            return features;
          }};
}

}  // namespace ps
