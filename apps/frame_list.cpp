// SPDX-License-Identifier: BSD-3-Clause
#include "apps/frame_list.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

namespace ps::apps {
namespace {

std::optional<double> parse_stamp(const std::string& text, const std::string& whole) {
  if (text.empty()) return std::nullopt;
  char* end = nullptr;
  const double stamp = std::strtod(text.c_str(), &end);
  if (*end != '\0' || !std::isfinite(stamp)) {
    throw CLI::ValidationError("--frames", "'" + whole + "' is no range; expected A:B, as 10:99");
  }
  return stamp;
}

bool in_canonical_order(const ChosenFrame& a, const ChosenFrame& b) {
  const auto key = [](const ChosenFrame& c) {
    const Eigen::Vector3d t = c.frame.world_from_cam.translation();
    return std::make_tuple(c.frame.timestamp, t.x(), t.y(), t.z(),
                           c.frame.color.lexically_normal().string());
  };
  return key(a) < key(b);
}

}  // namespace

void parse_frames(const std::string& text, FrameChoice& choice) {
  const auto colon = text.find(':');
  if (colon == std::string::npos) {
    choice.first = choice.last = parse_stamp(text, text);
  } else {
    choice.first = parse_stamp(text.substr(0, colon), text);
    choice.last = parse_stamp(text.substr(colon + 1), text);
  }
  if (choice.first && choice.last && *choice.first > *choice.last) {
    throw CLI::ValidationError("--frames", "'" + text + "' ends before it begins");
  }
}

FrameList choose_frames(const std::vector<RgbdFolder>& folders, const FrameChoice& choice) {
  FrameList list;
  for (const RgbdFolder& folder : folders) {
    int in_range = 0, chosen = 0;
    for (const RgbdFrame& frame : folder.frames) {
      const bool early = choice.first && frame.timestamp < *choice.first;
      const bool late = choice.last && frame.timestamp > *choice.last;
      if (early || late || in_range++ % choice.every != 0) continue;
      const int n = choice.hold_out;
      const bool held = n > 0 && chosen++ % n == n / 2;
      (held ? list.held_out : list.used).push_back({&folder, frame});
    }
  }
  std::sort(list.used.begin(), list.used.end(), in_canonical_order);
  std::sort(list.held_out.begin(), list.held_out.end(), in_canonical_order);
  return list;
}

}  // namespace ps::apps
