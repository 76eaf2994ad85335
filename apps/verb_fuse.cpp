// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>

#include "apps/frame_list.h"
#include "apps/fuse_report.h"
#include "apps/interrupt.h"
#include "apps/lift_arguments.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report.h"
#include "io/atomic_file.h"
#include "io/cloud_file.h"
#include "io/intrinsics_file.h"
#include "io/trajectory.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/scene/camera_path.h"
#include "libps/scene/frame_study.h"
#include "libps/scene/fuse.h"

namespace ps::apps {
namespace {

struct FuseArguments {
  std::vector<std::string> folders;
  std::string output;
  std::string frames;
  FrameChoice choice;
  double depth_scale = 1000;
  FuseOptions fuse;
  bool no_average = false;
  bool keep_contradicted = false;
  bool study = false;
  bool compress = false;
};

void add_input_options(CLI::App& verb, FuseArguments& a) {
  verb.add_option("folders", a.folders,
                  "RGB-D folders: color/, depth/, trajectory.txt, intrinsics.json; the poses of "
                  "several folders must be of one world")
      ->required()
      ->type_name("DIR");
  verb.add_option("-o,--output", a.output, "Cloud to write: .ply or .pcd")
      ->required()
      ->type_name("FILE");
  verb.add_option("--frames", a.frames,
                  "Only frames from A to B, both included, by timestamp or frame number; A: and :B "
                  "are open")
      ->type_name("A:B");
  verb.add_option("--every", a.choice.every, "Only every Nth of these frames of each folder")
      ->type_name("N")
      ->check(whole_in(1, 1000000));
  verb.add_option(
          "--hold-out", a.choice.hold_out,
          "Leave out every Nth of what is left, to compare with: of each folder's frames, "
          "counted from 0, those whose number modulo N is N/2 (10: 5, 15, 25, ...); 0 = none")
      ->type_name("N")
      ->check(whole_in(0, 1000000));
  verb.add_option("--depth-scale", a.depth_scale, "Units of the depth files in a metre")
      ->type_name("S")
      ->check(in_range(1e-6, kNoBound));
}

void add_cloud_options(CLI::App& verb, SceneCloudOptions& o) {
  const auto at_least_0 = in_range(0, kNoBound);
  add_lift_options(verb, o.lift);
  verb.add_option("--spacing", o.spacing, "Least distance between points, metres; 0 = by footprint")
      ->type_name("M")
      ->check(at_least_0);
  verb.add_option("--spacing-footprints", o.spacing_footprints,
                  "Least distance between points, in pixel widths at their distance")
      ->type_name("F")
      ->check(at_least_0);
  verb.add_option("--tolerance-relative", o.tolerance_relative,
                  "Two depths are one surface within this share of the depth ...")
      ->type_name("X")
      ->check(in_range(0, 1));
  verb.add_option("--tolerance-footprints", o.tolerance_footprints,
                  "... plus so many pixel widths at their distance")
      ->type_name("F")
      ->check(at_least_0);
  verb.add_option("--better-footprint", o.better_footprint,
                  "A view replaces points it sees with less than this share of their pixel width")
      ->type_name("X")
      ->check(in_range(0, 1));
}

std::vector<RgbdFolder> open_folders(const FuseArguments& a, const Context& context) {
  std::vector<RgbdFolder> folders;
  for (const std::string& path : a.folders) {
    std::size_t skipped = 0;
    folders.push_back(open_rgbd_folder(path, &skipped));
    context.detail(path + ": " + counted(folders.back().frames.size(), "frame"));
    if (skipped > 0) {
      context.warn(path + ": " + counted(skipped, "frame lacks", "frames lack") +
                   " colour, depth or pose and " + (skipped == 1 ? "is" : "are") + " left out");
    }
  }
  return folders;
}

/// By their timestamps, or by number where folders have timestamps in common.
std::vector<StampedPose> poses_of(const std::vector<ChosenFrame>& frames) {
  std::set<double> stamps;
  for (const ChosenFrame& chosen : frames) stamps.insert(chosen.frame.timestamp);
  const bool differ = stamps.size() == frames.size();
  std::vector<StampedPose> poses;
  for (const ChosenFrame& chosen : frames) {
    const double stamp = differ ? chosen.frame.timestamp : static_cast<double>(poses.size());
    poses.push_back({stamp, chosen.frame.world_from_cam, "", {}});
  }
  return poses;
}

std::vector<Pose> world_from_cams(const FrameList& frames) {
  std::vector<Pose> poses;
  for (const ChosenFrame& chosen : frames.used) poses.push_back(chosen.frame.world_from_cam);
  return poses;
}

constexpr const char* kBeside[] = {"settings.json", "report.json", "trajectory.txt",
                                   "intrinsics.json", "held-out.txt"};

/// a.ply and a.pcd would share their report.
void check_no_other_cloud(const std::filesystem::path& output) {
  std::filesystem::path other = output;
  other.replace_extension(extension_of(output) == ".ply" ? ".pcd" : ".ply");
  std::ifstream file(beside(output, "settings.json"));
  const Json settings = Json::parse(file, nullptr, false);
  const Json::json_pointer made("/options/output");
  std::error_code ignored;
  if (!settings.is_object() || !settings.contains(made) || !settings.at(made).is_string()) return;
  const std::filesystem::path cloud = settings.at(made).get<std::string>();
  if (cloud.filename() != other.filename() || !std::filesystem::exists(other, ignored)) return;
  throw Error(beside(output, "report.json").string(),
              "is the report of " + other.string() + " and would be replaced",
              "another name than " + output.string());
}

void check_outputs(const std::string& output) {
  check_output_file(output, {".ply", ".pcd"});
  check_no_other_cloud(output);
  for (const char* name : kBeside) check_output_file(beside(output, name), {});
}

/// How the cloud was made and where from, and the cloud, all at once.
void write_all(const FuseArguments& a, const Cloud& cloud, const FrameList& frames,
               const Json& settings, const Json& report) {
  const std::filesystem::path output(a.output);
  AtomicFiles files;
  write_json(beside(output, "settings.json"), settings);
  write_json(beside(output, "report.json"), report);
  write_trajectory(beside(output, "trajectory.txt"), poses_of(frames.used));
  write_intrinsics(beside(output, "intrinsics.json"), frames.used.front().folder->intrinsics);
  if (frames.held_out.empty()) {  // an earlier run's would be taken for this one's
    files.remove(beside(output, "held-out.txt"));
  } else {
    write_trajectory(beside(output, "held-out.txt"), poses_of(frames.held_out));
  }
  write_cloud(output, cloud, up_axis(world_from_cams(frames)), a.compress);
  files.commit();
}

/// All that the command line alone can tell. @return the arguments, with what follows from others
FuseArguments resolved(const FuseArguments& given) {
  FuseArguments a = given;
  if (!a.frames.empty()) parse_frames(a.frames, a.choice);
  if (a.choice.hold_out == 1) {
    throw CLI::ValidationError("--hold-out", "1 leaves no frame; expected 0 (none) or 2 and more");
  }
  check_depth_range(a.fuse.cloud.lift);
  a.fuse.cloud.average = !a.no_average;
  a.fuse.remove_contradicted = !a.keep_contradicted;
  check_outputs(a.output);
  if (a.compress && extension_of(a.output) != ".pcd") {
    throw CLI::ValidationError("--compress", "a .ply is never compressed; -o FILE.pcd is");
  }
  return a;
}

FrameList choose_some_frames(const FuseArguments& a, const std::vector<RgbdFolder>& folders) {
  FrameList frames = choose_frames(folders, a.choice);
  if (!frames.used.empty()) return frames;
  double first = folders.front().frames.front().timestamp, last = first;
  for (const RgbdFolder& folder : folders) {
    first = std::min(first, folder.frames.front().timestamp);
    last = std::max(last, folder.frames.back().timestamp);
  }
  std::ostringstream range;
  range.precision(17);
  range << "a range within " << first << ":" << last;
  throw Error("--frames", "no frame is in " + a.frames, range.str());
}

/// Holds the frames against each other.
FrameStudy studied(const ViewSource& source, const Context& context) {
  Progress progress(context, "study", source.count);
  return study_frames({source.count, [&](std::size_t i) {
                         progress.update(i);
                         return source.load(i);
                       }});
}

Fused fuse_frames(const FuseArguments& a, const FrameList& frames, const Context& context) {
  std::atomic<std::size_t> scaled{0};  // fuse() loads in the background
  ViewSource source = {frames.used.size(), [&](std::size_t i) {
                         const ChosenFrame& chosen = frames.used[i];
                         FrameNotes notes;
                         View view =
                             load_frame(*chosen.folder, chosen.frame, a.depth_scale, &notes);
                         scaled += notes.scaled ? 1 : 0;
                         return view;
                       }};
  Fused fused;
  FuseOptions options = a.fuse;
  if (a.study) {
    fused.study = studied(source, context);
    source = heeding(source, *fused.study);
    options = heeding(options, *fused.study);
    scaled = 0;
  }
  fused.tolerance_relative = options.cloud.tolerance_relative;
  {
    Progress progress(context, "fuse", source.count);
    fused.cloud = fuse(source, options, &fused.report, [&](std::size_t done, std::size_t) {
      progress.update(done);
      return true;
    });
  }
  throw_if_interrupted();
  fused.scaled = scaled;
  if (fused.report.views == 0) {
    throw Error(a.folders.front(), "no frame has any depth", "depth that is not 0");
  }
  if (fused.cloud.empty()) {
    throw Error(a.folders.front(), "no pixel can be lifted", "depth in the range asked for");
  }
  warn_of(fused, context);
  return fused;
}

void run_fuse(const FuseArguments& given, const CLI::App& verb, const Context& context) {
  const FuseArguments a = resolved(given);
  note_interrupts();
  const Stopwatch total;
  const std::vector<RgbdFolder> folders = open_folders(a, context);
  const FrameList frames = choose_some_frames(a, folders);
  const Fused fused = fuse_frames(a, frames, context);
  Json report = report_of(fused, frames);
  add_costs(report, total);
  write_all(a, fused.cloud, frames, settings_of(verb, context), report);
  end_run(context, report, a.output,
          counted(fused.cloud.size(), "point") + " from " + counted(fused.report.views, "view"));
}

}  // namespace

void add_fuse(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "fuse",
      "RGB-D folders to one cloud without duplicates.\n"
      "Beside fused.ply it writes fused.report.json, fused.settings.json, fused.trajectory.txt and "
      "fused.intrinsics.json (and fused.held-out.txt).");
  auto a = std::make_shared<FuseArguments>();
  add_input_options(*verb, *a);
  add_cloud_options(*verb, a->fuse.cloud);
  verb->add_flag("--no-average", a->no_average,
                 "Keep points where they were first seen, instead of averaging views");
  verb->add_flag("--keep-contradicted", a->keep_contradicted,
                 "Keep points that other views see through");
  verb->add_flag(
      "--study", a->study,
      "Read frames twice, and hold them against each other first: exposures are evened "
      "out, and scales of depths where they differ; frames whose poses are lost and "
      "depths that no neighbour shares are left out, and depths that spread are averaged "
      "more widely. The report says what was done to which frame");
  verb->add_flag("--compress", a->compress, "Compress the .pcd; a .ply is never compressed");
  verb->callback([a, verb, &context] { run_fuse(*a, *verb, context); });
}

}  // namespace ps::apps
