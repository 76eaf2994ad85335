// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "io/bytes.h"
#include "io/image_listing.h"
#include "io/photo.h"
#include "io/posed_layouts.h"
#include "io/text.h"
#include "io/trajectory.h"

namespace ps {
namespace {

namespace fs = std::filesystem;

/// Its first line is the address of a video.
bool is_list(const fs::path& file) {
  if (extension_of(file) != ".txt" || !fs::is_regular_file(file)) return false;
  const InputFile bytes(file);
  std::string start(std::min<std::size_t>(bytes.size(), 4), ' ');
  bytes.read(0, start.data(), start.size());
  return start == "http";
}

/// The file itself, or those in the folder.
std::vector<fs::path> lists_of(const fs::path& path) {
  if (!fs::is_directory(path)) return is_list(path) ? std::vector{path} : std::vector<fs::path>{};
  std::vector<fs::path> lists;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    if (is_list(entry.path())) lists.push_back(entry.path());
  }
  std::sort(lists.begin(), lists.end());
  return lists;
}

fs::path folder_of_photos(const fs::path& list) {
  const fs::path named = fs::path(list).replace_extension(""), beside = list.parent_path();
  for (const fs::path& folder : {named, beside / "frames"}) {
    if (fs::is_directory(folder)) return folder;
  }
  return beside.empty() ? "." : beside;
}

/// Shares of the image's sides to pixels whose centres are at integers.
Intrinsics lens_of(const Eigen::Vector4d& shares, cv::Size size) {
  return {size.width,
          size.height,
          shares[0] * size.width,
          shares[1] * size.height,
          shares[2] * size.width - 0.5,
          shares[3] * size.height - 0.5};
}

}  // namespace

bool is_realestate10k(const fs::path& path) { return !lists_of(path).empty(); }

PosedFrames open_realestate10k(const fs::path& path) {
  const std::vector<fs::path> lists = lists_of(path);
  if (lists.size() > 1) {
    throw Error(path.string(), "holds " + std::to_string(lists.size()) + " lists of frames",
                "one; or one of them instead of the folder");
  }
  const std::vector<StampedPose> poses = read_trajectory(lists.front());
  const fs::path folder = folder_of_photos(lists.front());
  const ImageListing photos(folder);
  const bool named = std::any_of(poses.begin(), poses.end(), [&](const StampedPose& pose) {
    return photos.find(pose.timestamp) != nullptr;
  });
  if (!named && photos.files.size() != poses.size()) {
    throw Error(folder.string(),
                std::to_string(photos.files.size()) + " photos of " + std::to_string(poses.size()) +
                    " frames",
                "photos named by timestamps, or as many as frames");
  }
  const cv::Size size = read_photo(photos.files.front()).color.size();
  std::vector<FrameFiles> files;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const fs::path* photo = named ? photos.find(poses[i].timestamp) : &photos.files[i];
    if (photo == nullptr || !poses[i].normalised_intrinsics) continue;
    PosedFrame frame = {photo->stem().string(), poses[i].timestamp, 0};
    files.push_back({std::move(frame),
                     poses[i].world_from_cam,
                     lens_of(*poses[i].normalised_intrinsics, size),
                     *photo,
                     {}});
  }
  const std::size_t whole = files.size();
  PosedFrames frames = frames_of("RealEstate10K", std::move(files), {}, lists.front().string());
  frames.skipped = poses.size() - whole;
  return frames;
}

}  // namespace ps
