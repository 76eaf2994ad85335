// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

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

}  // namespace ps
