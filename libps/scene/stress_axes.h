// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "libps/scene/stress.h"
#include "libps/scene/stress_given.h"
#include "libps/scene/view_methods.h"

namespace ps::stress {

/// How much is put under stress.
struct SuiteOptions {
  std::uint64_t seed = 0;
  int rooms = 2;              ///< procedural rooms that scores are means of
  int frames = 10;            ///< of each, to be fused
  int held_out = 3;           ///< of each, to be rendered
  cv::Size size = {128, 96};  ///< of frames, pixels
  int photos = 2;             ///< of as many rooms, to be looked around in
  int samples = 1;            ///< completions of each view
  bool dense = false;         ///< values between the others as well
  /// Put under stress in place of rooms: all axes then but those of rooms alone. Null = rooms.
  std::shared_ptr<const GivenFrames> given;
};

SuiteOptions small_suite(std::uint64_t seed);
SuiteOptions full_suite(std::uint64_t seed);

/// @brief Axes of fusing posed RGB-D frames: what goes wrong with depths, poses, lenses, exposures.
/// Rooms are made when an axis is first run.
std::vector<Axis> fusion_axes(const SuiteOptions& options);

/// @brief Axes of rendering a fused cloud: density, splat radius, coincident points, image size.
std::vector<Axis> cloud_axes(const SuiteOptions& options);

/// Makes the networks of all methods, which must outlive the axes, when a method first needs them.
using NetworksSource = std::function<MethodNetworks()>;

/// @brief Axes of looking around in one photo: how far the camera goes, and what is wrong with the
/// photo's depth, lens and size. Ours is view_methods.h's, and so are the others.
std::vector<Axis> photo_axes(const SuiteOptions& options, const NetworksSource& networks);

}  // namespace ps::stress
