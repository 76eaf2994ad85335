// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "io/bytes.h"
#include "io/posed_layouts.h"
#include "io/text.h"
#include "io/trajectory.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

constexpr double kMostApart = 0.02;  ///< seconds
constexpr Intrinsics kDriverLens = {640, 480, 525, 525, 319.5, 239.5};

/// Files by time: rgb.txt or depth.txt.
using FileList = std::map<double, fs::path>;

FileList read_list(const fs::path& file) {
  const FileBytes bytes(file);
  LineReader lines(bytes.view(), file.string());
  FileList list;
  std::string_view line;
  while (lines.next_content(line)) {
    const double stamp = take_finite(line, lines, "a timestamp");
    const std::string name(trimmed(line));
    if (name.empty()) throw Error(lines.where(), "no file name", "2 columns: stamp file");
    if (!list.emplace(stamp, file.parent_path() / name).second) {
      throw Error(lines.where(), "the timestamp is there already", "each timestamp once");
    }
  }
  return list;
}

/// @return the entry of a sorted map that is nearest in time and near enough; end() if none is
template <class Value>
auto nearest(const std::map<double, Value>& map, double stamp) {
  auto best = map.lower_bound(stamp);
  if (best != map.begin()) {
    const auto before = std::prev(best);
    if (best == map.end() || stamp - before->first <= best->first - stamp) best = before;
  }
  return best != map.end() && std::abs(best->first - stamp) <= kMostApart ? best : map.end();
}

/// Photos and depths, each in one pair at most, the nearest in time first.
std::map<double, double> depth_of_color(const FileList& colors, const FileList& depths) {
  std::vector<std::tuple<double, double, double>> apart;
  for (const auto& [color, file] : colors) {
    const auto end = depths.upper_bound(color + kMostApart);
    for (auto depth = depths.lower_bound(color - kMostApart); depth != end; ++depth) {
      apart.emplace_back(std::abs(color - depth->first), color, depth->first);
    }
  }
  std::sort(apart.begin(), apart.end());
  std::map<double, double> pairs, taken;
  for (const auto& [seconds, color, depth] : apart) {
    if (pairs.count(color) > 0 || !taken.emplace(depth, color).second) continue;
    pairs.emplace(color, depth);
  }
  return pairs;
}

}  // namespace

bool is_tum_folder(const fs::path& path) { return fs::exists(path / "rgb.txt"); }

PosedFrames open_tum_folder(const fs::path& path, double depth_scale) {
  const FileList colors = read_list(path / "rgb.txt"), depths = read_list(path / "depth.txt");
  std::map<double, Pose> poses;
  for (const StampedPose& pose : read_trajectory(path / "groundtruth.txt")) {
    poses.emplace(pose.timestamp, pose.world_from_cam);
  }
  std::vector<std::string> assumed;
  const Intrinsics lens = lens_or(path, kDriverLens, assumed);
  std::vector<FrameFiles> files;
  for (const auto& [color, depth] : depth_of_color(colors, depths)) {
    const auto pose = nearest(poses, color);
    if (pose == poses.end()) continue;
    const fs::path& photo = colors.at(color);
    PosedFrame frame = {photo.stem().string(), color, 0};
    files.push_back({std::move(frame), pose->second, lens, photo, depths.at(depth)});
  }
  const std::size_t whole = files.size();
  PosedFrames frames = frames_of("TUM RGB-D", std::move(files), {depth_scale}, path.string());
  frames.skipped = colors.size() - whole;
  frames.assumed = std::move(assumed);
  return frames;
}

}  // namespace ps
