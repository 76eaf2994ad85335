// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/cloud_arguments.h"
#include "apps/frame_sink.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report.h"
#include "apps/start_pose.h"
#include "io/trajectory.h"
#include "libps/core/error.h"
#include "libps/scene/camera_path.h"
#include "libps/scene/closed_splat.h"

namespace ps::apps {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;

struct RenderArguments {
  CloudArguments cloud;
  std::string output;
  std::string trajectory = "circle";
  std::string start;
  int frames = 0;  ///< 0 = 64 on a built-in path, all poses of a file
  double yaw = 34.4;
  double pitch = 17.2;
  double orbit = -1;  ///< below 0 = not given
  SplatOptions splat;
  float finest = kFinestSplat;
  std::vector<int> background = {0, 0, 0};
  bool no_renormalise = false;
  SinkOptions sink;
};

void add_path_options(CLI::App& verb, RenderArguments& a) {
  verb.add_option(
          "--trajectory", a.trajectory,
          "Poses: a file (TUM, COLMAP images.txt, Open3D .log, RealEstate10K) or a built-in "
          "path: circle, sway, left, right, up, down, up-left, up-right, down-left, "
          "down-right (where the camera turns to)")
      ->type_name("FILE|PATH");
  verb.add_option("--start", a.start,
                  "Trajectory file whose first pose starts a built-in path (default: "
                  "trajectory.txt beside the cloud, else from outside)")
      ->type_name("FILE");
  verb.add_option("--frames", a.frames, "Number of frames; 0 = 64, or all poses of a file")
      ->type_name("N")
      ->check(whole_in(0, 1000000));
  verb.add_option("--yaw", a.yaw, "Degrees a built-in path turns to either side")
      ->type_name("DEG")
      ->check(in_range(0, 180));
  verb.add_option("--pitch", a.pitch, "Degrees a built-in path turns up or down")
      ->type_name("DEG")
      ->check(in_range(0, 180));
  verb.add_option("--orbit", a.orbit,
                  "Turn about the point so many metres ahead; 0 = on the spot (default: on the "
                  "spot, or about the cloud when seen from outside)")
      ->type_name("M")
      ->check(in_range(0, 1e6))
      ->default_str("");
}

void add_picture_options(CLI::App& verb, RenderArguments& a) {
  verb.add_option("--radius", a.splat.radius,
                  "Radius of the widest splats, and of gaps that are closed, in pixels")
      ->type_name("PX")
      ->check(in_range(0.01, 64));
  verb.add_option(
          "--finest", a.finest,
          "Radius of the narrowest splats in pixels: others are as wide as their points stand "
          "for, and gaps are closed from beside; at least --radius: all alike, as published")
      ->type_name("PX")
      ->check(in_range(0.01, 64));
  verb.add_option("--points-per-pixel", a.splat.points_per_pixel,
                  "Only the nearest so many points of a pixel count")
      ->type_name("N")
      ->check(whole_in(1, 65536));
  verb.add_option("--background", a.background, "Colour where no point falls, 0 to 255 each")
      ->type_name("R,G,B")
      ->delimiter(',')
      ->expected(3)
      ->check(whole_in(0, 255));
  verb.add_flag("--no-renormalise", a.no_renormalise,
                "Let the background shine between points, as published");
  verb.add_flag("--depth", a.sink.depth, "Also write depth: 16-bit PNG in millimetres, 0 = none");
  verb.add_option("--fps", a.sink.frames_per_second, "Frames per second of a video")
      ->type_name("N")
      ->check(in_range(1, 1000));
}

bool is_built_in(const std::string& trajectory) {
  const auto& names = path_names();
  return std::find(names.begin(), names.end(), trajectory) != names.end();
}

/// All poses of a file, or `frames` of them, evenly spread.
std::vector<StampedPose> poses_of_file(const std::string& file, int frames) {
  if (!std::filesystem::exists(file)) {
    std::string choices;
    for (const std::string& name : path_names()) choices += ", " + name;
    throw Error("--trajectory", "there is no file '" + file + "'", "a file" + choices);
  }
  std::vector<StampedPose> all = read_trajectory(file);
  const auto wanted = static_cast<std::size_t>(frames);
  if (wanted == 0 || wanted >= all.size()) return all;
  std::vector<StampedPose> some;
  for (std::size_t i = 0; i < wanted; ++i) {
    some.push_back(all[wanted == 1 ? 0 : i * (all.size() - 1) / (wanted - 1)]);
  }
  return some;
}

std::vector<Pose> poses_of_path(const RenderArguments& a, const Cloud& cloud,
                                const Intrinsics& lens, const Context& context) {
  const StartPose start = choose_start(a.start, a.cloud, cloud, lens, context);
  PathOptions options;
  if (a.frames > 0) options.frames = a.frames;
  options.range_horizontal = a.yaw * kRadians;
  options.range_vertical = a.pitch * kRadians;
  options.orbit_radius = a.orbit >= 0 ? a.orbit : start.distance;
  return camera_path(a.trajectory, start.world_from_cam, options);
}

struct Shot {
  Intrinsics lens;
  std::vector<Pose> poses;
};

Shot plan(const RenderArguments& a, const Cloud& cloud, const Context& context) {
  constexpr int kWidth = 640, kHeight = 480;
  Shot shot;
  if (is_built_in(a.trajectory)) {
    shot.lens = choose_lens(a.cloud, context, {kWidth, kHeight});
    shot.poses = poses_of_path(a, cloud, shot.lens, context);
  } else {
    const auto stamped = poses_of_file(a.trajectory, a.frames);
    shot.lens =
        choose_lens(a.cloud, context, {kWidth, kHeight}, stamped.front().normalised_intrinsics);
    for (const StampedPose& pose : stamped) shot.poses.push_back(pose.world_from_cam);
  }
  if (extension_of(a.output) == ".png") shot.poses.resize(1);
  return shot;
}

SplatOptions splat_options(const RenderArguments& a) {
  SplatOptions options = a.splat;
  options.renormalise = !a.no_renormalise;
  for (int c = 0; c < 3; ++c) {
    options.background[c] = static_cast<float>(a.background[static_cast<std::size_t>(c)]) / 255;
  }
  return options;
}

/// What drawing the frames took and showed.
struct Drawn {
  double seconds = 0;  ///< splatting alone
  double covered = 0;  ///< mean share of the pixels that a point falls on
};

Drawn draw(const Cloud& cloud, const Shot& shot, const RenderArguments& a, FrameSink& sink,
           const Context& context) {
  const SplatOptions options = splat_options(a);
  Drawn drawn;
  Progress progress(context, "render", shot.poses.size());
  for (std::size_t i = 0; i < shot.poses.size(); ++i) {
    const Stopwatch watch;
    const Splat frame = closed_splat(cloud, shot.lens, shot.poses[i], options, a.finest);
    drawn.seconds += watch.seconds();
    drawn.covered += static_cast<double>(cv::countNonZero(frame.hit)) /
                     static_cast<double>(frame.hit.total() * shot.poses.size());
    sink.add(frame);
    progress.update(i + 1);
  }
  return drawn;
}

void run_render(const RenderArguments& a, const Context& context) {
  if (a.sink.depth && extension_of(a.output) == ".mp4") {
    throw CLI::ValidationError("--depth", "a video holds no depth; -o DIR does");
  }
  if (!a.cloud.size.empty()) parse_size(a.cloud.size);  // before the work
  note_interrupts();
  const Stopwatch total;
  const Cloud cloud = load_cloud(a.cloud, context);
  const double load_seconds = total.seconds();
  const Shot shot = plan(a, cloud, context);
  const cv::Size size(shot.lens.width, shot.lens.height);
  const auto sink = make_frame_sink(a.output, size, a.sink);
  const Drawn drawn = draw(cloud, shot, a, *sink, context);
  sink->finish(shot.poses, shot.lens);

  if (drawn.covered == 0) context.warn("no point falls into any frame; another --start may do");
  Json report = {{"output", a.output},
                 {"points", cloud.size()},
                 {"frames", shot.poses.size()},
                 {"lens", to_json(shot.lens)},
                 {"covered_share", drawn.covered},
                 {"seconds", {{"load", load_seconds}, {"splat", drawn.seconds}}}};
  add_costs(report, total);
  char what[96];
  std::snprintf(what, sizeof what, "%zu frames of %dx%d from %zu points", shot.poses.size(),
                size.width, size.height, cloud.size());
  end_run(context, report, a.output, what);
}

}  // namespace

void add_render(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "render",
      "Pictures or a video of a cloud along a camera path.\n"
      "A folder gets frame_00000.png ..., trajectory.txt and intrinsics.json once all frames are "
      "done; in a folder that exists already, files of these names are replaced and others stay. "
      "A .png gets the first frame, an .mp4 a video that plays in browsers.");
  auto a = std::make_shared<RenderArguments>();
  a->cloud.add_to(*verb);
  verb->add_option("-o,--output", a->output, "Folder, F.mp4 or F.png")
      ->required()
      ->type_name("OUT");
  add_path_options(*verb, *a);
  add_picture_options(*verb, *a);
  verb->callback([a, &context] { run_render(*a, context); });
}

}  // namespace ps::apps
