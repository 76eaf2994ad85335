// SPDX-License-Identifier: BSD-3-Clause
#include "apps/scene_input.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include "apps/frame_list.h"
#include "apps/lift_arguments.h"
#include "apps/photo_input.h"
#include "apps/program.h"
#include "apps/scene_report.h"
#include "io/depth_file.h"
#include "io/photo.h"
#include "io/rgbd_folder.h"
#include "io/trajectory.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/scene/photo_depth.h"
#include "libps/scene/second_view.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// The photo's camera in the scene's world: y up and z towards the viewer, so that other programs
/// show the cloud the right way up.
const Pose kPhotoPose = [] {
  Pose pose = Pose::Identity();
  pose.linear().diagonal() << 1, -1, -1;
  return pose;
}();

/// Pixels along a photo's short side that are always kept: twice what the depth network sees.
constexpr int kShortest = 512;

std::string text_of(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

Depth read_depth_for(const std::string& file, double depth_scale, cv::Size photo,
                     const Context& context) {
  Depth depth = read_depth(file, depth_scale);
  if (depth.size() == photo) return depth;
  const std::string sizes = "is " + text_of(depth.size()) + ", the photo " + text_of(photo);
  if (!same_aspect(depth.size(), photo)) throw Error(file, sizes, "the same aspect");
  context.warn(file + ": " + sizes + "; scaled to the photo's size");
  Depth scaled;
  cv::resize(depth, scaled, photo, 0, 0, cv::INTER_NEAREST_EXACT);
  return scaled;
}

/// Shrunk until no side is above `longest` pixels.
View shrunk(const View& view, int longest, Json& report) {
  const cv::Size size = view.color.size();
  const double scale = static_cast<double>(longest) / std::max(size.width, size.height);
  if (scale >= 1) return view;
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
  View small = view;
  const cv::Size to(side(size.width), side(size.height));
  cv::resize(view.color, small.color, to, 0, 0, cv::INTER_AREA);
  cv::resize(view.depth, small.depth, to, 0, 0, cv::INTER_NEAREST_EXACT);
  small.intrinsics = resized(view.intrinsics, to.width, to.height);
  report["shrunk_to"] = {to.width, to.height};
  return small;
}

Json report_of(const FilledHoles& filled) {
  if (filled.pixels == 0) return {{"pixels", 0}};
  Json report = {
      {"pixels", filled.pixels}, {"agreed", filled.agreed}, {"residual", filled.residual}};
  if (!filled.agreed) report["why"] = filled.why;
  return report;
}

/// The photo's depth at the size of its colours.
Depth depth_at(const Photo& photo, const std::string& file, double depth_scale,
               const Context& context) {
  Depth depth = read_depth_for(file, depth_scale, photo.size, context);
  if (photo.size == photo.color.size()) return depth;
  Depth small;
  cv::resize(depth, small, photo.color.size(), 0, 0, cv::INTER_NEAREST_EXACT);
  return small;
}

/// A photo with its depth; its pose is the scene's beginning.
/// @param longest  pixels that are wanted along its long side
View read_one(const SceneInputArguments& a, const std::string& file, const std::string& depth,
              const DepthModel* model, int longest, const Context& context, Json& report) {
  const Photo photo = take_photo(file, context, {longest, kShortest});
  const PhotoLens lens = choose_lens(a.lens, photo, file, context);
  View view;
  view.world_from_cam = kPhotoPose;
  view.color = photo.color;
  view.intrinsics = lens.intrinsics;
  if (photo.color.size() != photo.size) {
    view.intrinsics = resized(lens.intrinsics, photo.color.cols, photo.color.rows);
    report["shrunk_to"] = {photo.color.cols, photo.color.rows};
  }
  report["lens"] = to_json(lens);
  if (depth.empty()) {
    if (model == nullptr) throw Error(file, "its depth is not given", "--depth FILE");
    view.depth = photo_depth(model->net, photo.color, view.intrinsics, model->scale);
    report["depth"] = scale_report(*model, lens.intrinsics);
  } else {
    view.depth = depth_at(photo, depth, a.depth_scale, context);
    report["depth"] = {{"from", depth}};
    check(view, file);
    if (model != nullptr) {
      report["depth"]["filled"] = report_of(fill_holes(view, model->net, model->scale));
    }
  }
  check(view, file);
  return view;
}

/// The frames of a folder, which they point into.
struct Frames {
  std::vector<RgbdFolder> folders;
  std::vector<ChosenFrame> chosen;
  double depth_scale = 1000;

  View load(std::size_t i) const {
    FrameNotes notes;
    return load_frame(*chosen[i].folder, chosen[i].frame, depth_scale, &notes);
  }
  Depth load_depth(std::size_t i) const {
    const Depth depth = read_depth(chosen[i].frame.depth, depth_scale);
    const Intrinsics& lens = chosen[i].folder->intrinsics;
    return depth.size() == cv::Size(lens.width, lens.height) ? depth : load(i).depth;
  }
};

std::shared_ptr<const Frames> open_frames(const SceneInputArguments& a, const Context& context) {
  std::size_t skipped = 0;
  auto frames = std::make_shared<Frames>();
  frames->folders = {open_rgbd_folder(a.photo, &skipped)};
  frames->depth_scale = a.depth_scale;
  if (skipped > 0) {
    context.warn(a.photo + ": " + counted(skipped, "frame lacks", "frames lack") +
                 " colour, depth or pose and " + (skipped == 1 ? "is" : "are") + " left out");
  }
  frames->chosen = choose_frames(frames->folders, a.choice()).used;
  if (frames->chosen.empty())
    throw Error("--frames", "no frame is in " + a.frames, "a range that has some");
  return frames;
}

SceneInput read_frames(const SceneInputArguments& a, const Context& context) {
  const std::shared_ptr<const Frames> frames = open_frames(a, context);
  SceneInput input;
  std::size_t begin = 0;
  while (begin < frames->chosen.size() && (input.first = frames->load(begin)).depth.empty()) {
    ++begin;
  }
  if (input.first.depth.empty()) {
    throw Error(a.photo, "no frame has any depth", "depth that is not 0");
  }
  input.count = frames->chosen.size() - begin;
  input.without_depth = begin;
  input.load = [frames, begin](std::size_t i) { return frames->load(begin + i); };
  input.load_depth = [frames, begin](std::size_t i) { return frames->load_depth(begin + i); };
  input.report["lens"] = to_json(input.first.intrinsics);
  input.report["depth"] = {{"from", a.photo}};
  return input;
}

void warn_of_poor_pose(const SecondPose& found, const Intrinsics& lens, const Context& context) {
  constexpr double kPoor = .01;  // of the long side
  if (found.reprojection_error <= kPoor * std::max(lens.width, lens.height)) return;
  context.warn("--second: its pose is poor: half of its matches miss by more than " +
               in_digits(found.reprojection_error, 2) +
               " pixels; what both photos show may be seen twice (--second-pose gives a true one)");
}

/// The second photo, placed where it was taken, its depth on the first one's scale.
View read_second(const SceneInputArguments& a, const View& first, const DepthModel* model,
                 int longest, const Context& context, Json& report) {
  View second = read_one(a, a.second, a.second_depth, model, longest, context, report);
  if (a.second_pose == "auto") {
    const SecondPose found = find_second_pose(first, second.color, second.intrinsics, second.depth);
    warn_of_poor_pose(found, second.intrinsics, context);
    second.world_from_cam = found.world_from_cam;
    second.depth *= found.depth_scale;
    report["pose"] = to_json(found);
  } else {
    const StampedPose given = read_trajectory(a.second_pose).front();
    second.world_from_cam = first.world_from_cam * given.world_from_cam;
    report["pose"] = {{"from", a.second_pose}};
    if (a.second_depth.empty()) {
      const double scale = depth_scale_between(first, second);
      second.depth *= scale;
      report["pose"]["depth_scale"] = scale;
    }
  }
  const SecondView agreed = second_view(first, second);
  if (std::isfinite(agreed.before)) {
    report["depth_disagreement"] = {{"before", agreed.before}, {"after", agreed.residual}};
  }
  return agreed.view;
}

}  // namespace

bool SceneInputArguments::is_folder() const {
  std::error_code ignored;
  return fs::is_directory(photo, ignored);
}

bool SceneInputArguments::needs_estimate() const {
  return !is_folder() && (depth.empty() || (!second.empty() && second_depth.empty()));
}

std::vector<fs::path> SceneInputArguments::files() const {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const std::string& file :
       {photo, depth, lens.intrinsics, second, second_depth, second_pose}) {
    if (!file.empty() && fs::is_regular_file(file, ignored)) files.emplace_back(file);
  }
  if (!is_folder()) return files;
  const fs::path folder = photo;
  for (const char* name : {"trajectory.txt", "intrinsics.json"}) files.push_back(folder / name);
  const std::vector<RgbdFolder> folders = {open_rgbd_folder(folder)};
  for (const ChosenFrame& chosen : choose_frames(folders, choice()).used) {
    files.push_back(chosen.frame.color);
    files.push_back(chosen.frame.depth);
  }
  return files;
}

FrameChoice SceneInputArguments::choice() const {
  FrameChoice choice;
  choice.every = every;
  if (!frames.empty()) parse_frames(frames, choice);
  return choice;
}

void SceneInputArguments::add_to(CLI::App& verb) {
  verb.add_option("photo", photo,
                  "Photo: JPEG, PNG, TIFF, WebP, ...; or a folder of RGB-D frames (color/, depth/, "
                  "trajectory.txt, intrinsics.json), whose first frame the scene starts from")
      ->required()
      ->type_name("PHOTO|DIR");
  verb.add_option("--depth", depth,
                  "The photo's depth: 16-bit PNG, or metres as PFM, 32-bit TIFF or EXR (default: "
                  "estimated, metres not promised; holes are estimated too)")
      ->type_name("FILE");
  verb.add_option("--depth-scale", depth_scale, "Units of a 16-bit depth file in a metre")
      ->type_name("S")
      ->check(in_range(1e-6, kNoBound));
  lens.add_to(verb);
  verb.add_option("--second", second, "Another photo of the place, by the same lens")
      ->type_name("PHOTO2");
  verb.add_option("--second-depth", second_depth, "The second photo's depth (default: estimated)")
      ->type_name("FILE");
  verb.add_option(
          "--second-pose", second_pose,
          "Where the second photo was taken, seen from the first's camera (x right, y down, "
          "z forward, metres): a trajectory file, whose first pose counts, or auto = found "
          "by what both show")
      ->type_name("FILE|auto");
  verb.add_option("--frames", frames, "Of a folder: timestamps A:B, both included")
      ->type_name("A:B");
  verb.add_option("--every", every, "Of a folder: only every N-th frame")
      ->type_name("N")
      ->check(whole_in(1, 1000000));
  add_lift_options(verb, lift);
}

SceneInput read_scene_input(const SceneInputArguments& a, const DepthModel* model, int longest,
                            const Context& context) {
  if (a.is_folder()) {
    if (!a.depth.empty()) throw CLI::ValidationError("--depth", "a folder brings its own depth");
    if (!a.second.empty())
      throw CLI::ValidationError("--second", "goes with a photo, not a folder");
    return read_frames(a, context);
  }
  if (!a.frames.empty() || a.every != 1) {
    throw CLI::ValidationError(a.frames.empty() ? "--every" : "--frames",
                               "goes with a folder of frames, not with a photo");
  }
  SceneInput input;
  const View photo = read_one(a, a.photo, a.depth, model, longest, context, input.report);
  std::vector<View> views = {shrunk(photo, longest, input.report)};
  if (!a.second.empty()) {
    Json report;
    const View second = read_second(a, photo, model, longest, context, report);
    views.push_back(shrunk(second, longest, report));
    input.report["second"] = report;
  }
  input.first = views.front();
  input.count = views.size();
  input.load = [views](std::size_t i) { return views[i]; };
  return input;
}

}  // namespace ps::apps
