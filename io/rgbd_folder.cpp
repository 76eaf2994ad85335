// SPDX-License-Identifier: BSD-3-Clause
#include "io/rgbd_folder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "io/bytes.h"
#include "io/depth_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/text.h"
#include "io/trajectory.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

bool digit(char c) { return c >= '0' && c <= '9'; }

/// Order of names in which numbers count as numbers: frame2 before frame10.
bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && digit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string x = number(a, i), y = number(b, j);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  return a.size() - i < b.size() - j || (a.size() - i == b.size() - j && a < b);
}

/// The images of one folder, in order, and by the number that their names are.
struct Listing {
  std::vector<fs::path> files;
  std::map<double, fs::path> by_number;

  explicit Listing(const fs::path& folder) {
    static const std::string kKinds = " .png .jpg .jpeg .bmp .webp .tif .tiff .ppm .pgm .pfm .exr ";
    if (!fs::is_directory(folder))
      throw Error(folder.string(), "is no folder", "a folder of images");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string extension = extension_of(entry.path());
      const bool hidden = entry.path().filename().string().front() == '.';
      const bool kind =
          !extension.empty() && kKinds.find(" " + extension + " ") != std::string::npos;
      if (kind && !hidden && entry.is_regular_file()) files.push_back(entry.path());
    }
    if (files.empty()) throw Error(folder.string(), "holds no image", "one for each frame");
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
      return natural_less(a.filename().string(), b.filename().string());
    });
    for (const fs::path& file : files) add_number(file);
  }

  /// @return the file of that timestamp; nullptr when there is none
  const fs::path* find(double timestamp) const {
    const auto found = by_number.find(timestamp);
    return found == by_number.end() ? nullptr : &found->second;
  }

 private:
  void add_number(const fs::path& file) {
    const std::optional<double> number = to_number<double>(file.stem().string());
    if (!number || !std::isfinite(*number)) return;
    if (!by_number.emplace(*number, file).second) {
      throw Error(file.string(), "another image has its number", "one for each frame");
    }
  }
};

/// @param poses  by timestamp
std::vector<RgbdFrame> matched(const std::vector<StampedPose>& poses, const Listing& colors,
                               const Listing& depths) {
  std::vector<RgbdFrame> frames;
  for (const StampedPose& pose : poses) {
    const fs::path* color = colors.find(pose.timestamp);
    const fs::path* depth = depths.find(pose.timestamp);
    if (color == nullptr || depth == nullptr) continue;
    frames.push_back({*color, *depth, pose.timestamp, pose.world_from_cam});
  }
  const std::size_t count = poses.size();
  if (!frames.empty() || colors.files.size() != count || depths.files.size() != count) {
    return frames;
  }
  for (std::size_t i = 0; i < count; ++i) {
    frames.push_back(
        {colors.files[i], depths.files[i], poses[i].timestamp, poses[i].world_from_cam});
  }
  return frames;
}

std::string size_of(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// Ends at the first pixel that has one.
bool has_depth(const Depth& depth) {
  return std::any_of(depth.begin(), depth.end(), [](float d) { return d > 0; });
}

/// Resizes the depth to the photo's size.
void fit_depth(View& view, const RgbdFrame& frame) {
  const cv::Size size = view.color.size();
  if (!same_aspect(view.depth.size(), size)) {
    throw Error(frame.depth.string(),
                "depth is " + size_of(view.depth.size()) + ", the photo " + size_of(size),
                "the same aspect");
  }
  cv::resize(view.depth, view.depth, size, 0, 0, cv::INTER_NEAREST_EXACT);
}

Intrinsics intrinsics_for(cv::Size photo, const RgbdFolder& folder, const RgbdFrame& frame) {
  const Intrinsics& k = folder.intrinsics;
  const cv::Size camera(k.width, k.height);
  if (!same_aspect(camera, photo)) {
    throw Error(frame.color.string(),
                "the photo is " + size_of(photo) + ", the intrinsics are for " + size_of(camera),
                "the same aspect");
  }
  return camera == photo ? k : resized(k, photo.width, photo.height);
}

}  // namespace

RgbdFolder open_rgbd_folder(const fs::path& path, std::size_t* skipped, bool with_depth) {
  return guarded(path.string(), [&] {
    if (!fs::is_directory(path)) {
      throw Error(path.string(), "is no folder",
                  "a folder with color/, depth/, trajectory.txt and intrinsics.json");
    }
    RgbdFolder folder;
    folder.path = path;
    folder.intrinsics = read_intrinsics(path / "intrinsics.json");
    std::vector<StampedPose> poses = read_trajectory(path / "trajectory.txt");
    std::stable_sort(poses.begin(), poses.end(), [](const StampedPose& a, const StampedPose& b) {
      return a.timestamp < b.timestamp;
    });
    const Listing colors(path / "color");
    const Listing depths = with_depth ? Listing(path / "depth") : colors;
    folder.frames = matched(poses, colors, depths);
    if (!with_depth) {
      for (RgbdFrame& frame : folder.frames) frame.depth.clear();
    }
    const std::size_t most = std::max({colors.files.size(), depths.files.size(), poses.size()});
    if (folder.frames.empty()) {
      throw Error(path.string(),
                  "no frame has colour, depth and pose (" + std::to_string(colors.files.size()) +
                      " photos, " + std::to_string(depths.files.size()) + " depths, " +
                      std::to_string(poses.size()) + " poses)",
                  "files named by the trajectory's timestamps, or as many of each");
    }
    if (skipped != nullptr) *skipped = most - folder.frames.size();
    return folder;
  });
}

View load_frame(const RgbdFolder& folder, const RgbdFrame& frame, double depth_scale,
                FrameNotes* notes) {
  return guarded(frame.color.string(), [&] {
    View view;
    view.world_from_cam = frame.world_from_cam;
    view.color = read_photo(frame.color).color;
    if (frame.depth.empty()) {
      view.depth = Depth::zeros(view.color.size());
      view.intrinsics = intrinsics_for(view.color.size(), folder, frame);
      if (notes != nullptr) *notes = {false, true};
      return view;
    }
    view.depth = read_depth(frame.depth, depth_scale, notes ? NoDepth::allow : NoDepth::refuse);
    FrameNotes found;
    found.without_depth = !has_depth(view.depth);
    if (!found.without_depth) {
      found.scaled = view.depth.size() != view.color.size();
      if (found.scaled) fit_depth(view, frame);
      view.intrinsics = intrinsics_for(view.color.size(), folder, frame);
      check(view, frame.color.string());
    }
    if (notes != nullptr) *notes = found;
    return found.without_depth ? View() : view;
  });
}

}  // namespace ps
