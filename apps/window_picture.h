// SPDX-License-Identifier: BSD-3-Clause
// Internal to the part `viewer`.
#pragma once

#include "libps/core/image.h"

class vtkRenderWindow;

namespace ps::apps {

/// @return what a window off screen shows
Image picture_of(vtkRenderWindow& window);

}  // namespace ps::apps
