// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libps/scene/stress.h"

namespace ps::stress {

/// How much is put under stress.
struct SuiteOptions {
  std::uint64_t seed = 0;
  int rooms = 2;               ///< procedural rooms that scores are means of
  int frames = 12;             ///< of each, to be fused
  int held_out = 3;            ///< of each, to be rendered
  cv::Size size = {160, 120};  ///< of frames, pixels
  bool dense = false;          ///< values between the others as well
};

SuiteOptions small_suite(std::uint64_t seed);
SuiteOptions full_suite(std::uint64_t seed);

/// @brief Axes of fusing posed RGB-D frames: what goes wrong with depths, poses, lenses, exposures.
/// Rooms are made when an axis is first run.
std::vector<Axis> fusion_axes(const SuiteOptions& options);

/// @brief Axes of rendering a fused cloud: density, splat radius, coincident points, image size.
std::vector<Axis> cloud_axes(const SuiteOptions& options);

}  // namespace ps::stress
