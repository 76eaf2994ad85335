// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"
#include "libps/geometry/view.h"
#include "libps/nn/tensor.h"

namespace ps {

/// @brief What the networks see of a camera: the same view, its short side resized to 256 pixels,
/// with the aspect of its pixels kept. Both sides are extended evenly to multiples of 8, the side
/// of a code's cell: nothing is squashed or cut off.
Intrinsics network_lens(const Intrinsics& lens);

/// @brief A picture of the networks' camera, resampled (bicubic) to the camera it was made of.
/// @param seen  network_lens() of a lens of the same view and aspect as `lens`
Image resampled(const Image& picture, const Intrinsics& seen, const Intrinsics& lens);

/// @return the view, enlarged if its short side is below 256 pixels, so that its splats leave no
/// holes in the networks' view; depth by the nearest pixel, so that none is invented between two
/// surfaces
View enlarged(const View& view);

/// @return [1, h, w, 3] in [-1,1] of an image in [0,1]
nn::Tensor to_network(const Image& image);

/// @return an image in [0,1], clamped, of [1, h, w, 3] in [-1,1]
Image from_network(const nn::TensorView& image);

}  // namespace ps
