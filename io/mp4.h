// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: the boxes of a video file.
#pragma once

#include <string>

namespace ps {

/// @brief Puts an MP4's index (`moov`) before its data, so that a browser can start before it has
/// all of it; ISO/IEC 14496-12, 6.2. Where that cannot be (offsets beyond 32 bits) the bytes stay
/// as they are.
/// @param name  stands in messages
/// Throws ps::Error when `moov` or `mdat` is missing or cut off: the video was not finished.
std::string index_first(std::string bytes, const std::string& name);

}  // namespace ps
