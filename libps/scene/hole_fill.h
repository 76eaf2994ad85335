// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"

namespace ps {

/// What fills the holes of a picture without knowing anything of scenes.
enum class HoleFill {
  mean_colour,    ///< of all pixels that are seen
  nearest,        ///< the colour of the nearest pixel that is seen
  telea,          ///< Telea, An image inpainting technique based on the fast marching method, 2004
  navier_stokes,  ///< Bertalmio, Bertozzi, Sapiro, CVPR 2001
};

/// @brief Fills the pixels of a picture where `seen` is 0; the others stay as they are. The last
/// two are OpenCV's, of radius 3, and of 8 bits there. Where nothing is seen all is grey.
/// Throws ps::Error when the sizes differ.
Image filled(const Image& picture, const Mask& seen, HoleFill fill);

}  // namespace ps
