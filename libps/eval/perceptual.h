// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "libps/core/image.h"

namespace ps {

namespace models {
class Lpips;
}

/// How different two images of one size look; 0 = the same.
using PerceptualDistance = std::function<double(const Image&, const Image&)>;

/// @brief LPIPS of images in [0,1]; `net` must outlive it. It throws ps::Error when the sizes
/// differ or a side is shorter than Lpips::kSmallest.
PerceptualDistance lpips_distance(const models::Lpips& net);

/// A network that makes numbers of an image in [0,1], as many of each.
struct FeatureNetwork {
  std::string name;  ///< of network and layer, for people: a distance means nothing without it
  std::function<std::vector<float>(const Image&)> features;
};

/// @brief `SqueezeNet 1.1 fire-9` by the network that LPIPS looks with; `net` must outlive it. It
/// throws ps::Error when a side is shorter than Lpips::kSmallest.
FeatureNetwork lpips_features(const models::Lpips& net);

}  // namespace ps
