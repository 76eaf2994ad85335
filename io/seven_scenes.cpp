// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "io/bytes.h"
#include "io/image_listing.h"
#include "io/posed_layouts.h"
#include "io/text.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

constexpr Intrinsics kLens = {640, 480, 585, 585, 320, 240};
constexpr const char* kColor = ".color.png";

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// "frame-000007" of each photo of the folder, in order.
std::vector<std::string> frame_names(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("frame-", 0) != 0 || !ends_with(name, kColor)) continue;
    const std::string frame = name.substr(0, name.size() - std::string_view(kColor).size());
    if (to_number<std::uint32_t>(std::string_view(frame).substr(6))) names.push_back(frame);
  }
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

/// @return the 7 of "frame-000007"
double number_of(const std::string& name) {
  return to_number<std::uint32_t>(std::string_view(name).substr(6)).value();
}

/// The folder itself, or its seq-01, seq-02, ...
std::vector<fs::path> sequences_of(const fs::path& path) {
  if (!fs::is_directory(path)) return {};
  if (!frame_names(path).empty()) return {path};
  std::vector<fs::path> sequences;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    const bool named = entry.path().filename().string().rfind("seq-", 0) == 0;
    if (named && entry.is_directory() && !frame_names(entry.path()).empty()) {
      sequences.push_back(entry.path());
    }
  }
  std::sort(sequences.begin(), sequences.end());
  return sequences;
}

Pose read_pose(const fs::path& file) {
  const FileBytes bytes(file);
  LineReader lines(bytes.view(), file.string());
  Eigen::Matrix4d matrix;
  std::string_view line;
  for (int r = 0; r < 4; ++r) {
    if (!lines.next_content(line)) throw Error(lines.where(), "ends early", "4 rows of 4 numbers");
    for (int c = 0; c < 4; ++c) matrix(r, c) = take_finite(line, lines, "a 4x4 matrix");
    if (!trimmed(line).empty()) throw Error(lines.where(), "a long row", "4 numbers in a row");
  }
  return checked_pose(matrix, file.string());
}

}  // namespace

bool is_seven_scenes(const fs::path& path) { return !sequences_of(path).empty(); }

PosedFrames open_seven_scenes(const fs::path& path, double depth_scale) {
  std::vector<std::string> assumed;
  const Intrinsics lens = lens_or(path, kLens, assumed);
  std::vector<FrameFiles> files;
  std::size_t skipped = 0;
  double first = 0;  // numbers go on from one sequence to the next
  for (const fs::path& sequence : sequences_of(path)) {
    const std::string prefix = sequence == path ? "" : sequence.filename().string() + "/";
    double next = first;
    for (const std::string& name : frame_names(sequence)) {
      const fs::path depth = sequence / (name + ".depth.png"),
                     pose = sequence / (name + ".pose.txt");
      const double stamp = first + number_of(name);
      next = std::max(next, stamp + 1);
      if (!fs::exists(depth) || !fs::exists(pose)) {
        ++skipped;
        continue;
      }
      PosedFrame frame = {prefix + name, stamp, 0};
      files.push_back({std::move(frame), read_pose(pose), lens, sequence / (name + kColor), depth});
    }
    first = next;
  }
  const float unknown = static_cast<float>(65535 / depth_scale) * (1 - 1e-6f);
  PosedFrames frames =
      frames_of("7-Scenes", std::move(files), {depth_scale, unknown}, path.string());
  frames.skipped = skipped;
  frames.assumed = std::move(assumed);
  return frames;
}

}  // namespace ps
