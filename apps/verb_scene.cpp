// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

#include "apps/contact_sheet.h"
#include "apps/frame_sink.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/scene_maker.h"
#include "apps/scene_report.h"
#include "io/atomic_file.h"
#include "io/cloud_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/trajectory.h"
#include "libps/core/error.h"
#include "libps/scene/network_view.h"
#include "libps/scene/view_renderer.h"

namespace ps::apps {
namespace {

using Path = std::filesystem::path;

/// One picture of the scene: where it is taken from and what is seen there.
struct Picture {
  std::string name;
  Pose world_from_cam = Pose::Identity();
  Image color;
  Json report;
};

/// The lens of the pictures: the photo's, its long side at most `longest`, but its short side at
/// least `shortest`.
Intrinsics lens_of_pictures(const Intrinsics& photo, int longest, int shortest) {
  const double longer = std::max(photo.width, photo.height);
  const double shorter = std::min(photo.width, photo.height);
  const double scale = std::max(std::min(1.0, longest / longer), shortest / shorter);
  if (scale == 1) return photo;
  const auto side = [&](int length) { return static_cast<int>(std::lround(length * scale)); };
  return resized(photo, side(photo.width), side(photo.height));
}

ViewRenderer renderer_of(const SceneMaker& scene, const Context& context) {
  ViewRendererOptions options;
  options.seed = context.seed;
  return ViewRenderer(scene.models() != nullptr ? scene.models()->refiner() : nullptr, options);
}

std::vector<Picture> render_views(const SceneMaker& scene, const Intrinsics& lens,
                                  ViewRenderer& renderer, const Context& context) {
  std::vector<Picture> pictures;
  Progress progress(context, "views", scene.plan().size());
  for (std::size_t i = 0; i < scene.plan().size(); ++i) {
    const ViewPlan& view = scene.plan()[i];
    Picture picture = {view.name, view.world_from_cam, {}, {{"view", view.name}}};
    const Stopwatch watch;
    const RenderedView seen = renderer.render(scene.cloud(), lens, view.world_from_cam);
    picture.report["seconds"] = watch.seconds();
    picture.report["covered_share"] = cv::mean(seen.splat.hit)[0];
    picture.report["missing_share"] = seen.missing_share;
    const bool painted = !scene.painted().empty() && !scene.painted()[i].empty();
    picture.color =
        painted ? resampled(scene.painted()[i], scene.painted_lens(), lens) : seen.color;
    pictures.push_back(std::move(picture));
    progress.update(i + 1);
  }
  return pictures;
}

/// The extremes, each where it looks to: up-left in the upper left corner, the input in the middle.
Image preview_of(const std::vector<Picture>& pictures) {
  std::vector<SheetTile> tiles;
  for (const Picture& picture : pictures) {
    if (picture.name.find('_') != std::string::npos) continue;
    const auto says = [&](const char* word) {
      return picture.name.find(word) != std::string::npos;
    };
    tiles.push_back({picture.name, picture.color, 1 - (says("up") ? 1 : 0) + (says("down") ? 1 : 0),
                     1 - (says("left") ? 1 : 0) + (says("right") ? 1 : 0)});
  }
  return contact_sheet(tiles);
}

bool is_built_in(const std::string& path) {
  const auto& names = path_names();
  return std::find(names.begin(), names.end(), path) != names.end();
}

std::string video_name(const std::string& path) { return Path(path).stem().string() + ".mp4"; }

/// Fails before the work, not after it.
void check_paths(const SceneArguments& a) {
  std::set<std::string> names;
  for (const std::string& path : a.paths) {
    if (!is_built_in(path)) read_trajectory(path);
    if (!names.insert(video_name(path)).second) {
      throw CLI::ValidationError("--paths", "two of them would be " + video_name(path));
    }
  }
}

/// The poses of a built-in path from the scene's first view, or those of a file.
std::vector<Pose> poses_of_path(const SceneArguments& a, const SceneMaker& scene,
                                const std::string& path) {
  if (is_built_in(path)) {
    PathOptions options = a.plan().range;
    options.frames = a.path_frames;
    return camera_path(path, scene.plan().front().world_from_cam, options);
  }
  std::vector<Pose> poses;
  for (const StampedPose& pose : read_trajectory(path)) poses.push_back(pose.world_from_cam);
  return poses;
}

/// All cameras that the scene is looked at through.
std::vector<PlannedView> planned_views(const SceneArguments& a, const SceneMaker& scene,
                                       const Intrinsics& lens) {
  std::vector<PlannedView> views;
  for (const ViewPlan& view : scene.plan()) views.push_back({lens, view.world_from_cam});
  for (const std::string& path : a.paths) {
    for (const Pose& pose : poses_of_path(a, scene, path)) views.push_back({lens, pose});
  }
  return views;
}

Json write_path(const SceneArguments& a, const SceneMaker& scene, const std::string& path,
                const Intrinsics& lens, ViewRenderer& renderer, OutputFolder& folder,
                const Context& context) {
  const std::vector<Pose> poses = poses_of_path(a, scene, path);
  const std::string name = video_name(path);
  const Stopwatch watch;
  double missing = 0;
  folder.write(name, [&](const Path& file) {
    SinkOptions options;
    options.frames_per_second = a.frames_per_second;
    const auto sink = make_frame_sink(file, {lens.width, lens.height}, options);
    Progress progress(context, name, poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      RenderedView view = renderer.render(scene.cloud(), lens, poses[i]);
      missing += view.missing_share / static_cast<double>(poses.size());
      view.splat.color = view.color;
      sink->add(view.splat);
      progress.update(i + 1);
    }
    sink->finish(poses, lens);
  });
  return {{"video", name},
          {"frames", poses.size()},
          {"missing_share", missing},
          {"seconds", watch.seconds()}};
}

void write_scene(OutputFolder& folder, const SceneMaker& scene,
                 const std::vector<Picture>& pictures, const Intrinsics& lens) {
  folder.write("scene.ply",
               [&](const Path& file) { write_cloud(file, scene.cloud(), scene.up()); });
  std::vector<StampedPose> poses;
  for (const Picture& picture : pictures) {
    throw_if_interrupted();
    folder.write("views/" + picture.name + ".png",
                 [&](const Path& file) { write_image(file, picture.color); });
    poses.push_back({static_cast<double>(poses.size()), picture.world_from_cam, "", {}});
  }
  folder.write("trajectory.txt", [&](const Path& file) { write_trajectory(file, poses); });
  folder.write("intrinsics.json", [&](const Path& file) { write_intrinsics(file, lens); });
  folder.write("preview.png", [&](const Path& file) { write_image(file, preview_of(pictures)); });
}

/// Makes sure, before the work, that the folder can take what will be written, and that nothing of
/// an earlier scene stays beside it.
void prepare(OutputFolder& folder, const SceneArguments& a) {
  std::vector<std::string> names = {"scene.ply",   "trajectory.txt", "intrinsics.json",
                                    "preview.png", "settings.json",  "report.json"};
  for (const ViewPlan& view : plan_scene(Pose::Identity(), a.plan())) {
    names.push_back("views/" + view.name + ".png");
  }
  for (const std::string& path : a.paths) names.push_back(video_name(path));
  folder.check_places(names);
  folder.clears(pictures_of_earlier_scene(a.output));
}

void make_scene(const SceneArguments& a, const Json& settings, SceneMaker& scene,
                const Context& context) {
  const Stopwatch total;
  OutputFolder folder(a.output);
  prepare(folder, a);
  scene.make();
  constexpr int kNetworks = 256;  // pixels of a short side that networks see
  const Intrinsics lens =
      lens_of_pictures(scene.lens(), a.view_size, scene.models() != nullptr ? kNetworks : 1);
  scene.keep_to_budget(planned_views(a, scene, lens));
  ViewRenderer renderer = renderer_of(scene, context);
  Stopwatch watch;
  const std::vector<Picture> pictures = render_views(scene, lens, renderer, context);
  Json report = summary_of(scene.cloud());
  report.update(scene.report());
  for (const Picture& picture : pictures) report["views"].push_back(picture.report);
  end_stage(report, "views", watch);
  watch = Stopwatch();
  for (const std::string& path : a.paths) {
    report["videos"].push_back(write_path(a, scene, path, lens, renderer, folder, context));
  }
  write_scene(folder, scene, pictures, lens);
  end_stage(report, "write", watch);
  add_costs(report, total);
  folder.write("settings.json", [&](const Path& file) { write_json(file, settings); });
  folder.write("report.json", [&](const Path& file) { write_json(file, report); });
  throw_if_interrupted();
  folder.commit();
  scene.finish();
  end_run(context, report, a.output,
          std::to_string(scene.cloud().size()) + " points, " + std::to_string(pictures.size()) +
              " views");
}

void run_scene(const SceneArguments& a, const CLI::App& verb, const Context& context) {
  Json settings = settings_of(verb, context);
  settings["options"]["samples"] = a.samples_text();
  settings["options"]["budget"] = a.budget_text();
  SceneMaker scene(a, settings, context);
  check_paths(a);
  note_interrupts();
  try {
    make_scene(a, settings, scene, context);
  } catch (const WriteError& error) {  // once there is room, the rest need not be done again
    if (!scene.has_begun()) throw;
    throw WriteError(error.file(), error.why(),
                     "room for it, and leave to write; the same command with --resume goes on with "
                     "what was outpainted so far");
  } catch (const Error&) {
    scene.finish();  // the same command would fail again
    throw;
  } catch (const Interrupted&) {
    if (!scene.has_begun()) throw;
    throw Interrupted(
        "interrupted; the same command with --resume goes on with what was outpainted so far");
  }
}

}  // namespace

void add_scene(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "scene",
      "A photo to a scene: scene.ply, views/*.png to eight sides, preview.png, trajectory.txt, "
      "intrinsics.json, report.json and settings.json in one folder.\n"
      "What the photo does not show is outpainted at the extremes of the camera's range and joins "
      "the cloud; views in between are splats of that one cloud. The folder appears when all is "
      "done; in a folder that exists already, files of these names are replaced, views and videos "
      "of an earlier scene go, and others stay. The world has the photo's camera at its origin; x "
      "is right, y up, z towards the viewer, as MeshLab, CloudCompare and f3d show it; a folder of "
      "frames keeps its own world.");
  auto a = std::make_shared<SceneArguments>();
  a->add_to(*verb);
  verb->callback([a, verb, &context] { run_scene(*a, *verb, context); });
}

}  // namespace ps::apps
