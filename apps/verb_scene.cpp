// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "apps/contact_sheet.h"
#include "apps/depth_model.h"
#include "apps/interrupt.h"
#include "apps/lens_arguments.h"
#include "apps/lift_arguments.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report.h"
#include "io/cloud_file.h"
#include "io/depth_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/trajectory.h"
#include "libps/core/error.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/splat.h"
#include "libps/scene/camera_path.h"

namespace ps::apps {
namespace {

using Path = std::filesystem::path;

struct SceneArguments {
  std::string photo;
  std::string output;
  std::string depth;
  double depth_scale = 1000;
  std::string weights;
  LensArguments lens;
  bool no_outpaint = false;
  LiftOptions lift;
};

/// One picture of the scene: where it is taken from and what is seen there.
struct SceneView {
  std::string name;
  Pose world_from_cam = Pose::Identity();
  Splat splat;
};

/// The photo's camera in the scene's world: y up and z towards the viewer, so that other programs
/// show the cloud the right way up.
const Pose kPhotoPose = [] {
  Pose pose = Pose::Identity();
  pose.linear().diagonal() << 1, -1, -1;
  return pose;
}();

std::string text_of(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

Depth read_depth_for(const SceneArguments& a, cv::Size photo, const Context& context) {
  Depth depth = read_depth(a.depth, a.depth_scale);
  if (depth.size() == photo) return depth;
  const std::string sizes = "is " + text_of(depth.size()) + ", the photo " + text_of(photo);
  if (!same_aspect(depth.size(), photo)) throw Error(a.depth, sizes, "the same aspect");
  context.warn(a.depth + ": " + sizes + "; scaled to the photo's size");
  Depth scaled;
  cv::resize(depth, scaled, photo, 0, 0, cv::INTER_NEAREST_EXACT);
  return scaled;
}

/// The photo as a view, and what the report says of where its lens and depth come from.
struct Input {
  View view;
  Json lens;
  Json depth;
};

Input read_input(const SceneArguments& a, const Context& context) {
  const Photo photo = read_photo(a.photo);
  const PhotoLens lens = choose_lens(a.lens, photo, a.photo, context);
  Input input{{}, to_json(lens), {{"from", a.depth}}};
  View& view = input.view;
  view.world_from_cam = kPhotoPose;
  view.color = photo.color;
  view.intrinsics = lens.intrinsics;
  if (a.depth.empty()) {
    const DepthModel model = load_depth_model(a.weights, context);
    view.depth = photo_depth(model.net, photo.color, lens.intrinsics, model.scale);
    input.depth = scale_report(model, lens.intrinsics);
  } else {
    view.depth = read_depth_for(a, photo.color.size(), context);
  }
  check(view, a.photo);
  return input;
}

/// The input's own pose and the extremes of the eight directions (SPEC.md 2).
std::vector<SceneView> render_views(const Cloud& cloud, const Intrinsics& lens,
                                    const Context& context) {
  std::vector<SceneView> views = {{"input", kPhotoPose, {}}};
  PathOptions to_the_extreme;
  to_the_extreme.frames = 2;
  for (const std::string& name : direction_names()) {
    views.push_back({name, camera_path(name, kPhotoPose, to_the_extreme).back(), {}});
  }
  SplatOptions options;
  options.renormalise = true;
  Progress progress(context, "views", views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].splat = splat(cloud, lens, views[i].world_from_cam, options);
    progress.update(i + 1);
  }
  return views;
}

/// Each view where it looks to: up-left in the upper left corner, the input in the middle.
Image preview_of(const std::vector<SceneView>& views) {
  std::vector<SheetTile> tiles;
  for (const SceneView& view : views) {
    const auto says = [&](const char* word) { return view.name.find(word) != std::string::npos; };
    tiles.push_back({view.name, view.splat.color, 1 - (says("up") ? 1 : 0) + (says("down") ? 1 : 0),
                     1 - (says("left") ? 1 : 0) + (says("right") ? 1 : 0)});
  }
  return contact_sheet(tiles);
}

Json report_of(const Cloud& cloud, const Input& input, const std::vector<SceneView>& views) {
  const View& view = input.view;
  Json report = summary_of(cloud);
  const auto known = static_cast<std::size_t>(cv::countNonZero(view.depth > 0));
  report["pixels"] = {{"photo", view.depth.total()},
                      {"depth_known", known},
                      {"lifted", cloud.size()},
                      {"dropped", known - cloud.size()}};
  report["lens"] = input.lens;
  report["depth"] = input.depth;
  for (const SceneView& seen : views) {
    report["covered_share"][seen.name] = static_cast<double>(cv::countNonZero(seen.splat.hit)) /
                                         static_cast<double>(view.depth.total());
  }
  return report;
}

void write_all(OutputFolder& folder, const Cloud& cloud, const View& view,
               const std::vector<SceneView>& views) {
  folder.write("scene.ply", [&](const Path& file) { write_cloud(file, cloud, "y"); });
  std::vector<StampedPose> poses;
  for (const SceneView& seen : views) {
    throw_if_interrupted();
    folder.write("views/" + seen.name + ".png",
                 [&](const Path& file) { write_image(file, seen.splat.color); });
    poses.push_back({static_cast<double>(poses.size()), seen.world_from_cam, "", {}});
  }
  folder.write("trajectory.txt", [&](const Path& file) { write_trajectory(file, poses); });
  folder.write("intrinsics.json",
               [&](const Path& file) { write_intrinsics(file, view.intrinsics); });
  folder.write("preview.png", [&](const Path& file) { write_image(file, preview_of(views)); });
}

void check_networks(const SceneArguments& a) {
  if (!a.no_outpaint) {
    throw Error("scene",
                "the networks are here but have no trained weights yet, so it cannot outpaint",
                "--no-outpaint, for a scene of what the photo shows");
  }
}

void run_scene(const SceneArguments& a, const CLI::App& verb, const Context& context) {
  check_networks(a);
  check_depth_range(a.lift);
  note_interrupts();
  const Stopwatch total;
  OutputFolder folder(a.output);
  const Input input = read_input(a, context);
  const View& view = input.view;
  const Cloud cloud = lift(view, 0, Origin::observed, a.lift);
  if (cloud.empty()) throw Error(a.photo, "no pixel can be lifted", "depth in the range asked for");
  const std::vector<SceneView> views = render_views(cloud, view.intrinsics, context);
  write_all(folder, cloud, view, views);
  Json report = report_of(cloud, input, views);
  add_costs(report, total);
  const Json settings = settings_of(verb, context);
  folder.write("settings.json", [&](const Path& file) { write_json(file, settings); });
  folder.write("report.json", [&](const Path& file) { write_json(file, report); });
  throw_if_interrupted();
  folder.commit();
  end_run(context, report, a.output,
          std::to_string(cloud.size()) + " points, " + std::to_string(views.size()) + " views");
}

void add_options(CLI::App& verb, SceneArguments& a) {
  verb.add_option("photo", a.photo, "Photo: JPEG, PNG, TIFF, WebP, ...")
      ->required()
      ->type_name("PHOTO");
  verb.add_option("-o,--output", a.output, "Folder to write")->required()->type_name("OUT");
  verb.add_option("--depth", a.depth,
                  "The photo's depth: 16-bit PNG, or metres as PFM, 32-bit TIFF or EXR (default: "
                  "estimated, metres not promised)")
      ->type_name("FILE");
  verb.add_option("--depth-scale", a.depth_scale, "Units of a 16-bit depth file in a metre")
      ->type_name("S")
      ->check(in_range(1e-6, kNoBound));
  add_weights_option(verb, a.weights);
  a.lens.add_to(verb);
  verb.add_flag("--no-outpaint", a.no_outpaint, "Invent nothing: only what the photo shows");
  add_lift_options(verb, a.lift);
}

}  // namespace

void add_scene(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "scene",
      "A photo, and its depth if known, to a scene: scene.ply, views/*.png to eight sides, "
      "preview.png, "
      "trajectory.txt, intrinsics.json, report.json and settings.json in one folder.\n"
      "The folder appears when all is done; in a folder that exists already, files of these names "
      "are replaced and others stay. The world has the photo's camera at its origin; x is right, y "
      "up, "
      "z towards the viewer, as MeshLab, CloudCompare and f3d show it.");
  auto a = std::make_shared<SceneArguments>();
  add_options(*verb, *a);
  verb->callback([a, verb, &context] { run_scene(*a, *verb, context); });
}

}  // namespace ps::apps
