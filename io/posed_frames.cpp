// SPDX-License-Identifier: BSD-3-Clause
#include "io/posed_frames.h"

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>

#include "io/bytes.h"
#include "io/depth_file.h"
#include "io/image_listing.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/posed_layouts.h"
#include "io/rgbd_folder.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

View load(const FrameFiles& files, const DepthCode& code) {
  return guarded(files.color.string(), [&] {
    View view;
    view.world_from_cam = files.world_from_cam;
    view.color = read_photo(files.color).color;
    view.intrinsics = fitted_lens(files.lens, view.color.size(), files.color.string());
    if (files.depth.empty()) return view;
    view.depth = read_depth(files.depth, code.scale, NoDepth::allow);
    view.depth.setTo(0, view.depth >= code.unknown);
    view.depth = fitted_depth(view.depth, view.color.size(), files.depth.string());
    return view;
  });
}

PosedFrames open_rgbd(const fs::path& path, double depth_scale) {
  std::size_t skipped = 0;
  const RgbdFolder folder = open_rgbd_folder(path, &skipped);
  std::vector<FrameFiles> files;
  for (const RgbdFrame& f : folder.frames) {
    PosedFrame frame = {f.color.stem().string(), f.timestamp, 0};
    files.push_back({std::move(frame), f.world_from_cam, folder.intrinsics, f.color, f.depth});
  }
  PosedFrames frames = frames_of("RGB-D folder", std::move(files), {depth_scale}, path.string());
  frames.skipped = skipped;
  return frames;
}

}  // namespace

bool has_depth(const View& frame) {
  return !frame.depth.empty() && cv::countNonZero(frame.depth) > 0;
}

PosedFrames frames_of(const std::string& layout, std::vector<FrameFiles> files,
                      const DepthCode& code, const std::string& where) {
  if (files.empty()) throw Error(where, "no frame of " + layout + " is whole", "one at least");
  std::sort(files.begin(), files.end(), [](const FrameFiles& a, const FrameFiles& b) {
    return std::tie(a.frame.world, a.frame.stamp, a.frame.name) <
           std::tie(b.frame.world, b.frame.stamp, b.frame.name);
  });
  PosedFrames frames;
  frames.layout = layout;
  for (const FrameFiles& f : files) frames.frames.push_back(f.frame);
  const auto shared = std::make_shared<const std::vector<FrameFiles>>(std::move(files));
  frames.pose = [shared](std::size_t i) { return shared->at(i).world_from_cam; };
  frames.load = [shared, code](std::size_t i) { return load(shared->at(i), code); };
  return frames;
}

Intrinsics lens_or(const fs::path& folder, const Intrinsics& otherwise,
                   std::vector<std::string>& assumed) {
  const fs::path file = folder / "intrinsics.json";
  if (fs::exists(file)) return read_intrinsics(file);
  assumed.push_back("there is no intrinsics.json: a focal length of " +
                    std::to_string(static_cast<int>(otherwise.fx)) + " pixels of 640x480 is taken");
  return otherwise;
}

PosedFrames open_posed_frames(const std::string& data, std::optional<double> depth_scale) {
  return guarded(data, [&]() -> PosedFrames {
    if (data.rfind("rooms:", 0) == 0) return open_room_frames(data);
    const fs::path path(data);
    if (!fs::exists(path))
      throw Error(data, "is not there", "a folder, a file or rooms:SEED:COUNT");
    if (fs::exists(path / "trajectory.txt")) return open_rgbd(path, depth_scale.value_or(1000));
    if (is_tum_folder(path)) return open_tum_folder(path, depth_scale.value_or(5000));
    if (is_seven_scenes(path)) return open_seven_scenes(path, depth_scale.value_or(1000));
    if (is_realestate10k(path)) return open_realestate10k(path);
    throw Error(data, "is of no known layout",
                "an RGB-D folder (color/, depth/, trajectory.txt, intrinsics.json), TUM RGB-D "
                "(rgb.txt, depth.txt, groundtruth.txt), 7-Scenes (frame-000000.color.png, "
                ".depth.png, .pose.txt) or RealEstate10K (text file and photos)");
  });
}

}  // namespace ps
