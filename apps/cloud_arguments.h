// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "apps/context.h"
#include "libps/core/image.h"
#include "libps/geometry/camera.h"
#include "libps/geometry/point.h"

namespace ps::apps {

/// The arguments that `render` and `view` share: which cloud, which of its points, through which
/// lens.
struct CloudArguments {
  std::string cloud;
  std::string origin = "all";
  std::string size;
  std::string intrinsics;
  double fov = 0;  ///< degrees across; 0 = not given
  std::string up = "y";

  void add_to(CLI::App& verb);
};

/// @brief Parses `640x480`. Throws CLI::ValidationError (wrong usage) on anything else.
cv::Size parse_size(const std::string& text);

/// @return the points that were asked for; warns of points that are not finite, which are left out.
/// Throws ps::Error when the file is bad or no point is left.
Cloud load_cloud(const CloudArguments& arguments, const Context& context);

/// @return the file `STEM.NAME` or else `NAME` in the cloud's folder, as `fuse` and `scene` write
/// them
std::optional<std::filesystem::path> find_beside(const std::string& cloud, const std::string& name);

/// @brief The lens: --intrinsics, else --fov, else `shares`, else the file beside the cloud, else
/// 60 degrees; says which.
/// @param otherwise  the size when neither --size nor a file gives one
/// @param shares  fx fy cx cy as shares of the width and height (RealEstate10K), when the
/// trajectory has them
Intrinsics choose_lens(const CloudArguments& arguments, const Context& context, cv::Size otherwise,
                       const std::optional<Eigen::Vector4d>& shares = {});

}  // namespace ps::apps
