// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/geometry/view.h"

namespace ps {

/// A second view that goes with a first one.
struct SecondView {
  View view;            ///< its depth made to agree with the first's where both see a surface
  double before = 0;    ///< median |log ratio| of the two depths over the overlap; NaN without one
  double residual = 0;  ///< the same, afterwards
};

/// @brief Makes two views one scene: SceneCloud::add() both, the first as it is, then the second as
/// it comes from here, and surfaces that both see are there once.
///
/// Two depths that networks guessed differ, even at the best common scale, by a few percent that
/// vary slowly over the picture, and SceneCloud would take one wall for two. So the second's depth
/// is multiplied by a smooth field: the local median ratio over a grid of cells, blurred widely,
/// then what is left of it narrowly. It fades to 1 away from the overlap. Depths that are right
/// stay as they are, to the ratio's noise.
/// @param second  its pose found, its depth multiplied by the common scale (find_second_pose())
/// Throws ps::Error when a view is unsound.
SecondView second_view(const View& first, const View& second);

}  // namespace ps
