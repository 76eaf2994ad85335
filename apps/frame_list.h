// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/rgbd_folder.h"

namespace ps::apps {

/// Which frames of a folder are used; timestamps are inclusive.
struct FrameChoice {
  std::optional<double> first;
  std::optional<double> last;
  int every = 1;
  /// N: of the frames so chosen in a folder, counted from 0, leave out i with i % N == N / 2 (N =
  /// 10: 5, 15, 25, ...); 0 = none.
  int hold_out = 0;
};

/// @brief Parses `A:B`, `A:`, `:B` into first and last. Throws CLI::ValidationError on anything
/// else.
void parse_frames(const std::string& text, FrameChoice& choice);

/// One frame and the folder it is from.
struct ChosenFrame {
  const RgbdFolder* folder = nullptr;
  RgbdFrame frame;
};

struct FrameList {
  std::vector<ChosenFrame> used;
  std::vector<ChosenFrame> held_out;
};

/// @brief Chooses frames folder by folder and puts them in one order, by timestamp, then
/// translation, then path, so that the order of the folders changes nothing. The list points into
/// `folders`.
FrameList choose_frames(const std::vector<RgbdFolder>& folders, const FrameChoice& choice);

}  // namespace ps::apps
