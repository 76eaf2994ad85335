// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "libps/core/error.h"
#include "libps/eval/image_metrics.h"
#include "libps/rooms/room.h"
#include "libps/scene/closed_splat.h"
#include "libps/scene/room_view.h"
#include "libps/scene/stress_fusers.h"
#include "libps/scene/stress_suite.h"

namespace ps::stress {
namespace {

const std::string kClosed = "ours", kPlainSplat = "ours, no guard", kPublished = "radius 4",
                  kNearestPoint = "nearest point";

/// A fused room, and a view of it.
struct Model {
  Cloud cloud;
  std::optional<rooms::Room> room;  ///< none where frames are given
  View view;
  Mask covered;  ///< of the view
};
using Models = std::shared_ptr<Lazy<std::vector<Model>>>;

Image draw(const std::string& method, const Cloud& cloud, const View& view, float radius) {
  SplatOptions options;
  options.renormalise = true;
  options.radius = radius;
  if (method == kClosed) {
    options.radius = kWidest;
    const float finest = kDetail * radius / kRadius;
    return closed_splat(cloud, view.intrinsics, view.world_from_cam, options, finest).color;
  }
  if (method == kPublished) {
    options.radius = 4 * radius / kRadius;
    options.renormalise = false;
  } else if (method == kNearestPoint) {
    options.radius = radius / kRadius;
    options.points_per_pixel = 1;
  } else if (method != kPlainSplat) {
    throw Error("stress", "no way to draw is called " + method);
  }
  options.radius = std::min(options.radius, kWidest);
  return splat(cloud, view.intrinsics, view.world_from_cam, options).color;
}

/// A cloud, a view and a radius, by a value.
struct Case {
  Cloud cloud;
  View view;
  float radius = kRadius;
};
using Disturb = std::function<Case(const Model&, double value)>;

Cloud thinned(const Cloud& cloud, double factor, const Draw& draw) {
  Cloud result;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (even_at(draw, static_cast<std::uint32_t>(i)) * factor < 1) result.push_back(cloud[i]);
  }
  return result;
}

Cloud repeated(const Cloud& cloud, double times) {
  Cloud result = cloud;
  for (int i = 1; i < static_cast<int>(times); ++i) result += cloud;
  return result;
}

/// The view at another size, shot anew and kept, as that takes a while; given frames only shrink.
class Zoom {
 public:
  View at(const Model& model, double factor) {
    if (!model.room) return shrunk(model.view, 1 / factor);
    const auto key = std::pair(&model, factor);
    const auto known = views_.find(key);
    if (known != views_.end()) return known->second;
    const auto side = [&](int pixels) { return std::max(1, static_cast<int>(pixels * factor)); };
    const Intrinsics lens = resized(model.view.intrinsics, side(model.view.intrinsics.width),
                                    side(model.view.intrinsics.height));
    const View view = shoot_view(*model.room, room_camera(lens, model.view.world_from_cam));
    return views_[key] = view;
  }

 private:
  std::map<std::pair<const Model*, double>, View> views_;
};

class CloudAxes {
 public:
  explicit CloudAxes(const SuiteOptions& options) : options_(options) {
    models_ = std::make_shared<Lazy<std::vector<Model>>>([options] {
      std::vector<Model> models;
      const auto add = [&](const World& world, std::optional<rooms::Room> room) {
        models.push_back({fuse_by(kOursUnguarded, world.frames), std::move(room), world.held_out[0],
                          world.covered[0]});
      };
      if (options.given) {
        for (const auto& walk : options.given->walks) {
          add(given_world({walk.frames, {walk.held_out[0]}}, options.size), std::nullopt);
        }
        return models;
      }
      for (int i = 0; i < options.rooms; ++i) {
        const std::uint64_t seed = room_seed(options, i);
        add(make_world(seed, options.frames, 1, options.size), rooms::Room(seed));
      }
      return models;
    });
  }

  void add(const std::string& name, const std::string& what, const std::string& unit,
           const std::vector<double>& values, const Disturb& disturb) {
    Axis axis;
    axis.name = name;
    axis.what = what;
    axis.unit = unit;
    axis.values = values_of(options_, values);
    axis.score = "PSNR of a view left out";
    axis.score_unit = "dB";
    axis.limit = 16;
    axis.methods = {kClosed, kPlainSplat, kPublished, kNearestPoint};
    const Models models = models_;
    axis.run = [=](const std::string& method, double value) {
      Outcome outcome;
      double sum = 0;
      for (const Model& model : models->get()) {
        const Case now = disturb(model, value);
        const Image picture = draw(method, now.cloud, now.view, now.radius);
        Mask covered;
        cv::resize(model.covered, covered, picture.size(), 0, 0, cv::INTER_NEAREST);
        sum += psnr(picture, now.view.color, covered);
        if (outcome.picture.empty()) outcome.picture = picture;
      }
      outcome.score = [score = sum / static_cast<double>(models->get().size())] { return score; };
      return outcome;
    };
    axis.truth = [=](double value) { return disturb(models->get()[0], value).view.color; };
    axes_.push_back(std::move(axis));
  }

  /// Of the last axis.
  void rooms_alone(const std::string& why) { axes_.back().rooms_alone = why; }

  std::vector<Axis> take() { return std::move(axes_); }

 private:
  SuiteOptions options_;
  Models models_;
  std::vector<Axis> axes_;
};

}  // namespace

std::vector<Axis> cloud_axes(const SuiteOptions& options) {
  CloudAxes axes(options);
  const auto zoom = std::make_shared<Zoom>();
  axes.add("cloud-density", "Points are taken away by chance; one of so many stays", "times",
           {1, 2, 4, 8, 16, 32, 64, 128, 256},
           [draw = Draw{options.seed, 0}](const Model& m, double value) {
             return Case{thinned(m.cloud, value, draw), m.view};
           });
  axes.add("splat-narrow", "Splats are asked for so many times narrower than usual", "times",
           {1, 2, 4, 8, 16, 32}, [](const Model& m, double value) {
             return Case{m.cloud, m.view, static_cast<float>(kRadius / value)};
           });
  axes.add("splat-wide", "Splats are asked for so many times wider than usual", "times",
           {1, 2, 4, 8, 16, 32}, [](const Model& m, double value) {
             return Case{m.cloud, m.view, static_cast<float>(kRadius * value)};
           });
  axes.add("coincident", "Each point is there so many times", "times", {1, 2, 4, 8, 16, 32, 64},
           [](const Model& m, double value) {
             return Case{repeated(m.cloud, value), m.view};
           });
  axes.add("image-huge", "Pictures are so many times wider than the frames", "times",
           options.dense ? std::vector<double>{1, 2, 4, 8, 16} : std::vector<double>{1, 2, 4, 8},
           [zoom](const Model& m, double value) {
             return Case{m.cloud, zoom->at(m, value)};
           });
  axes.rooms_alone("frames are no sharper than they are");
  axes.add("image-tiny", "Pictures are so many times narrower than the frames", "times",
           {1, 2, 4, 8, 16, 32}, [zoom](const Model& m, double value) {
             return Case{m.cloud, zoom->at(m, 1 / value)};
           });
  return axes.take();
}

}  // namespace ps::stress
