// SPDX-License-Identifier: BSD-3-Clause
// Folders of images, and images that must fit each other.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "libps/core/image.h"
#include "libps/geometry/camera.h"

namespace ps {

/// @brief Order of names in which numbers count as numbers: frame2 before frame10.
bool natural_less(const std::string& a, const std::string& b);

/// @brief The images of one folder, in order, and by the number that their names are.
struct ImageListing {
  std::vector<std::filesystem::path> files;  ///< in natural order
  std::map<double, std::filesystem::path> by_number;

  /// Throws ps::Error when it is no folder, holds no image, or two have one number.
  explicit ImageListing(const std::filesystem::path& folder);

  /// @return the file of that timestamp; nullptr when there is none
  const std::filesystem::path* find(double timestamp) const;
};

/// @return the depth, resized (nearest) to `size`. Throws ps::Error, naming `where`, when the
/// aspects differ.
Depth fitted_depth(const Depth& depth, cv::Size size, const std::string& where);

/// @return the lens of a photo of `size`, resized to it. Throws as fitted_depth() does.
Intrinsics fitted_lens(const Intrinsics& lens, cv::Size size, const std::string& where);

}  // namespace ps
