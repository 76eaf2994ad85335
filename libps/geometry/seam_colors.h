// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/core/image.h"

namespace ps {

struct SeamColorOptions {
  double decay = 128;  ///< pixels over which a correction fades away from the seam, above 0
  int reach = 3;       ///< pixels to each side of the seam that are compared, 1 or more
  double edge = 0.5;   ///< a difference (of RGB, Euclidean) of so much is half taken for an edge,
                       ///< which stays; above 0
};

/// @brief Makes painted colours continue the seen ones: what the two differ by on average at the
/// seam, nearby, is added to the painted, less and less away from it (a membrane over the
/// differences, as in seamless cloning: Perez, Gangnet, Blake, Poisson Image Editing, SIGGRAPH
/// 2003, but held by springs, so that it fades).
/// @param seen     [0,1], what is seen; read near the seam, where `missing` is 0
/// @param painted  [0,1], read where `missing` is not 0
/// @param missing  not 0 = painted
/// @return `painted`, changed where `missing` is not 0, within [0,1]
/// The same bytes for any number of threads. Throws ps::Error when the sizes differ, are empty, or
/// an option is out of range.
Image continue_colors(const Image& seen, const Image& painted, const Mask& missing,
                      const SeamColorOptions& options = {});

}  // namespace ps
