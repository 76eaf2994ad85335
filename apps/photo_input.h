// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/context.h"
#include "io/photo.h"

namespace ps::apps {

/// @brief ps::read_photo() and check_photo(), whose errors it throws; warns of what the photo has
/// that is not heeded.
Photo take_photo(const std::string& file, const Context& context, WantedPixels wanted = {});

}  // namespace ps::apps
