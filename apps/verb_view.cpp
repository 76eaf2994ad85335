// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>

#include "apps/cloud_arguments.h"
#include "apps/display.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/report.h"
#include "apps/start_pose.h"
#include "apps/viewer.h"
#include "io/photo.h"
#include "io/trajectory.h"

namespace ps::apps {
namespace {

struct ViewArguments {
  CloudArguments cloud;
  std::string screenshot;
  std::string trajectory;
  std::string start;
  std::string color_by = "photo";
  double point_size = 3;
  bool no_axes = false;
  bool no_cameras = false;
};

std::vector<Pose> read_poses(const ViewArguments& a) {
  std::string file = a.trajectory;
  if (file.empty()) {
    const auto found = find_beside(a.cloud.cloud, "trajectory.txt");
    if (!found) return {};
    file = found->string();
  }
  std::vector<Pose> poses;
  for (const StampedPose& pose : read_trajectory(file)) poses.push_back(pose.world_from_cam);
  return poses;
}

ViewerOptions viewer_options(const ViewArguments& a, const Cloud& cloud, const Context& context) {
  ViewerOptions options;
  if (!a.cloud.size.empty()) options.size = parse_size(a.cloud.size);
  options.lens = choose_lens(a.cloud, context, options.size);
  options.trajectory = read_poses(a);
  const bool given = a.start.empty() && !a.trajectory.empty();
  options.start =
      choose_start(given ? a.trajectory : a.start, a.cloud, cloud, options.lens, context)
          .world_from_cam;
  const auto& names = color_names();
  options.color_by =
      static_cast<ColorBy>(std::find(names.begin(), names.end(), a.color_by) - names.begin());
  options.point_size = a.point_size;
  options.axes = !a.no_axes;
  options.cameras = !a.no_cameras;
  options.title = "pixelsynth - " + a.cloud.cloud;
  return options;
}

void run_view(const ViewArguments& a, const Context& context) {
  if (!a.screenshot.empty()) {
    check_output_file(a.screenshot, {".png", ".jpg", ".jpeg"});
    note_interrupts();
  }
  const Cloud cloud = load_cloud(a.cloud, context);
  const ViewerOptions options = viewer_options(a, cloud, context);
  if (a.screenshot.empty()) {
    const Display display(Display::Need::window);
    context.flush();
    show(cloud, options);
  } else {
    const Display display(Display::Need::picture);
    const Image picture = snapshot(cloud, options);
    throw_if_interrupted();
    write_image(a.screenshot, picture);
    context.say(a.screenshot + ": " + std::to_string(cloud.size()) + " points");
  }
  print_report(context, summary_of(cloud));
}

}  // namespace

void add_view(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "view",
      "A cloud in a window; ? there shows the keys.\n"
      "It starts at the first pose of the trajectory beside the cloud, if there is one.");
  auto a = std::make_shared<ViewArguments>();
  a->cloud.add_to(*verb);
  verb->add_option("--screenshot", a->screenshot,
                   "Write a picture of what the window would show; needs no screen")
      ->type_name("F.png");
  verb->add_option("--trajectory", a->trajectory,
                   "Camera poses to draw (default: trajectory.txt beside the cloud)")
      ->type_name("FILE");
  verb->add_option("--start", a->start, "Trajectory file whose first pose the window starts at")
      ->type_name("FILE");
  verb->add_option("--color-by", a->color_by, "photo, depth, view or origin")
      ->check(CLI::IsMember(color_names()))
      ->type_name("WHAT");
  verb->add_option("--point-size", a->point_size, "Size of a point in pixels")
      ->type_name("PX")
      ->check(in_range(1, 32));
  verb->add_flag("--no-axes", a->no_axes, "Leave out the world's axes");
  verb->add_flag("--no-cameras", a->no_cameras, "Leave out the cameras");
  verb->callback([a, &context] { run_view(*a, context); });
}

}  // namespace ps::apps
