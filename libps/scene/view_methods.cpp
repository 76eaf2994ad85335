// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/view_methods.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libps/core/error.h"
#include "libps/geometry/point.h"
#include "libps/scene/hole_fill.h"
#include "libps/scene/network_view.h"

namespace ps {
namespace {

/// The input's points, as SceneBuilder::observe() makes them.
Cloud cloud_of(const View& input, const SceneCloudOptions& options) {
  check(input, "input");
  SceneCloud cloud(options);
  cloud.add(enlarged(input), 0, Origin::observed);
  return cloud.cloud();
}

/// Poses from one to another, without the first: even steps of about `degrees`.
std::vector<Pose> steps_to(const Pose& from, const Pose& to, double degrees) {
  const Eigen::Quaterniond start(from.linear()), end(to.linear());
  const double turn = start.angularDistance(end) * 180 / M_PI;
  const int count = std::max(1, static_cast<int>(std::lround(turn / degrees)));
  std::vector<Pose> poses;
  for (int i = 1; i < count; ++i) {
    const double share = static_cast<double>(i) / count;
    Pose pose = Pose::Identity();
    pose.linear() = start.slerp(share, end).toRotationMatrix();
    pose.translation() = from.translation() + share * (to.translation() - from.translation());
    poses.push_back(pose);
  }
  poses.push_back(to);
  return poses;
}

enum class Way { at_once, in_steps, as_outpainted };

/// Those that outpaint.
class Outpainting : public ViewMethod {
 public:
  Outpainting(const SceneNetworks& networks, const ViewMethodOptions& options, Way way)
      : networks_(networks),
        options_(options),
        way_(way),
        renderer_(networks.outpaint.refiner, options.renderer) {}

  MethodView show(const View& input, const Intrinsics& lens, const Pose& world_from_cam) override {
    constexpr double kStep = 15;  // degrees
    SceneBuilder scene(networks_, lens, options_.scene);
    scene.observe(input, 0);
    const Mask seen =
        cloud_picture(scene.cloud(), lens, world_from_cam, options_.renderer).splat.hit;
    std::vector<Pose> poses = {world_from_cam};
    if (way_ == Way::in_steps) poses = steps_to(input.world_from_cam, world_from_cam, kStep);
    std::uint16_t number = 0;
    for (const Pose& pose : poses) {
      const SupportView support = scene.outpaint(pose, ++number);
      if (support.view.color.empty()) return {};
      if (way_ == Way::as_outpainted) {
        return {resampled(support.view.color, scene.lens(), lens), seen};
      }
      scene.add(support, number);
    }
    return {renderer_.render(scene.cloud(), lens, world_from_cam).color, seen};
  }

 private:
  SceneNetworks networks_;
  ViewMethodOptions options_;
  Way way_;
  ViewRenderer renderer_;
};

class Refining : public ViewMethod {
 public:
  Refining(const models::Refiner* refiner, const ViewMethodOptions& options)
      : cloud_(options.scene.cloud), renderer_(refiner, options.renderer) {}

  MethodView show(const View& input, const Intrinsics& lens, const Pose& world_from_cam) override {
    const RenderedView view = renderer_.render(cloud_of(input, cloud_), lens, world_from_cam);
    return {view.color, view.splat.hit};
  }

 private:
  SceneCloudOptions cloud_;
  ViewRenderer renderer_;
};

class Filling : public ViewMethod {
 public:
  Filling(HoleFill fill, const ViewMethodOptions& options) : fill_(fill), options_(options) {}

  MethodView show(const View& input, const Intrinsics& lens, const Pose& world_from_cam) override {
    const Cloud cloud = cloud_of(input, options_.scene.cloud);
    const RenderedView view = cloud_picture(cloud, lens, world_from_cam, options_.renderer);
    return {filled(view.color, view.splat.hit, fill_), view.splat.hit};
  }

 private:
  HoleFill fill_;
  ViewMethodOptions options_;
};

class Copying : public ViewMethod {
 public:
  MethodView show(const View& input, const Intrinsics& lens, const Pose& world_from_cam) override {
    check(input, "input");
    check(lens, "target");
    checked_pose(world_from_cam.matrix(), "target");
    return {resampled(input.color, input.intrinsics, lens), Mask::zeros(lens.height, lens.width)};
  }
};

std::optional<HoleFill> fill_named(const std::string& name) {
  if (name == "mean-colour") return HoleFill::mean_colour;
  if (name == "telea") return HoleFill::telea;
  if (name == "navier-stokes") return HoleFill::navier_stokes;
  if (name == "nearest") return HoleFill::nearest;
  return std::nullopt;
}

void check_name(const std::string& name) {
  const auto& names = view_method_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  std::string choices;
  for (const std::string& known : names) choices += (choices.empty() ? "" : ", ") + known;
  throw Error("method", "there is none named '" + name + "'", choices);
}

const outpaint::Scorer& scorer_named(const MethodNetworks& networks, const std::string& name) {
  const auto found = networks.scorers.find(name);
  if (found != networks.scorers.end()) return found->second;
  throw Error("by-" + name, "there is no " + name, "its weights");
}

outpaint::Outpainter::Networks rgb_networks(const MethodNetworks& networks) {
  outpaint::Outpainter::Networks rgb = networks.rgb;
  if (rgb.autoencoder == nullptr || rgb.pixel_cnn == nullptr) {
    throw Error("rgb", "its networks, which continue colours, are missing", "rgb.safetensors");
  }
  if (rgb.refiner == nullptr) rgb.refiner = networks.scene.outpaint.refiner;
  if (rgb.scorers.empty()) rgb.scorers = networks.scene.outpaint.scorers;
  return rgb;
}

void check_networks(const std::string& name, const SceneNetworks& networks) {
  const auto& o = networks.outpaint;
  const bool outpaints = name != "no-outpainter";
  const bool complete = o.refiner != nullptr && (!outpaints || (o.autoencoder && o.pixel_cnn));
  if (complete && (!outpaints || networks.depth != nullptr)) return;
  throw Error(name, "a network is missing",
              outpaints ? "depth, autoencoder, PixelCNN and refiner" : "the refiner");
}

}  // namespace

ViewMethod::~ViewMethod() = default;

const std::vector<std::string>& view_method_names() {
  static const std::vector<std::string> names = {
      "ours",        "one-completion", "by-likelihood", "by-classifier", "by-discriminator",
      "by-both",     "sequential",     "independent",   "no-outpainter", "rgb",
      "mean-colour", "telea",          "navier-stokes", "nearest",       "copy"};
  return names;
}

bool needs_networks(const std::string& name) {
  check_name(name);
  return name != "copy" && !fill_named(name);
}

std::unique_ptr<ViewMethod> make_view_method(const std::string& name,
                                             const MethodNetworks& all_networks,
                                             const ViewMethodOptions& given) {
  check_name(name);
  if (name == "copy") return std::make_unique<Copying>();
  if (const auto fill = fill_named(name)) return std::make_unique<Filling>(*fill, given);
  SceneNetworks networks = all_networks.scene;
  ViewMethodOptions options = given;
  outpaint::OutpaintOptions& outpaint = options.scene.outpaint;
  if (name == "rgb") networks.outpaint = rgb_networks(all_networks);
  check_networks(name, networks);
  if (name == "no-outpainter") {
    return std::make_unique<Refining>(networks.outpaint.refiner, options);
  }
  if (name == "one-completion") {
    outpaint.samples = 1;
    outpaint.until_settled = false;
    outpaint.refine_best = 0;
  } else if (name == "by-likelihood") {
    networks.outpaint.scorers.clear();
    outpaint.keep = outpaint::OutpaintOptions::Keep::likeliest;
  } else if (name == "by-both") {
    networks.outpaint.scorers = {scorer_named(all_networks, "classifier"),
                                 scorer_named(all_networks, "discriminator")};
    outpaint.likelihood = false;
  } else if (name.rfind("by-", 0) == 0) {
    networks.outpaint.scorers = {scorer_named(all_networks, name.substr(3))};
    outpaint.likelihood = false;
  }
  const Way way = name == "sequential"    ? Way::in_steps
                  : name == "independent" ? Way::as_outpainted
                                          : Way::at_once;
  return std::make_unique<Outpainting>(networks, options, way);
}

}  // namespace ps
