// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/scene/stress_suite.h"

namespace ps::stress {

/// One room and one photo, so small that an axis takes a moment.
inline SuiteOptions tiny_suite() {
  SuiteOptions options;
  options.rooms = options.photos = 1;
  options.frames = 4;
  options.held_out = 1;
  options.size = {48, 36};
  return options;
}

}  // namespace ps::stress
