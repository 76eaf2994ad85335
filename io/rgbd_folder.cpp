// SPDX-License-Identifier: BSD-3-Clause
#include "io/rgbd_folder.h"

#include <algorithm>

#include "io/bytes.h"
#include "io/depth_file.h"
#include "io/image_listing.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/text.h"
#include "io/trajectory.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

/// @param poses  by timestamp
std::vector<RgbdFrame> matched(const std::vector<StampedPose>& poses, const ImageListing& colors,
                               const ImageListing& depths) {
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

/// Ends at the first pixel that has one.
bool has_depth(const Depth& depth) {
  return std::any_of(depth.begin(), depth.end(), [](float d) { return d > 0; });
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
    const ImageListing colors(path / "color");
    const ImageListing depths = with_depth ? ImageListing(path / "depth") : colors;
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
      view.intrinsics = fitted_lens(folder.intrinsics, view.color.size(), frame.color.string());
      if (notes != nullptr) *notes = {false, true};
      return view;
    }
    view.depth = read_depth(frame.depth, depth_scale, notes ? NoDepth::allow : NoDepth::refuse);
    FrameNotes found;
    found.without_depth = !has_depth(view.depth);
    if (!found.without_depth) {
      found.scaled = view.depth.size() != view.color.size();
      if (found.scaled)
        view.depth = fitted_depth(view.depth, view.color.size(), frame.depth.string());
      view.intrinsics = fitted_lens(folder.intrinsics, view.color.size(), frame.color.string());
      check(view, frame.color.string());
    }
    if (notes != nullptr) *notes = found;
    return found.without_depth ? View() : view;
  });
}

}  // namespace ps
