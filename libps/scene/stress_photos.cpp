// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "libps/eval/image_metrics.h"
#include "libps/eval/pairs.h"
#include "libps/eval/statistics.h"
#include "libps/scene/photo_depth.h"
#include "libps/scene/stress_suite.h"

namespace ps::stress {
namespace {

constexpr double kChange = .1;  ///< of a colour
/// Share of what was seen that may be shown otherwise. Given pairs are up to a metre and 60 degrees
/// apart, rooms' 20 centimetres and 20 degrees: slivers beside edges grow with that.
constexpr double kMostChanged = .01, kMostChangedOfGiven = .1;

constexpr int kSeam = 2;          ///< pixels
const cv::Size kPhoto(256, 256);  ///< pixels; given photos fit into that
const std::string kMovesCamera = "it moves the camera at will";
const std::string kOurs = "ours", kUnguarded = "ours, no guard";

/// What a method is asked: the input as it knows it, and where to look from.
struct Question {
  View input;
  Intrinsics lens;
  Pose world_from_cam;
  bool holes = false;  ///< the input lacks depth where it has colour
  double temperature = ViewMethodOptions().scene.outpaint.temperature;
};
/// Where a picture is held against the truth. What nobody can know is invented by all: there PSNR
/// likes grey best.
enum class Where { all, visible };

struct Truth {
  Image color;
  Mask visible;  ///< what the undisturbed photo sees of it
};
using Ask = std::function<Question(const Photo& photo, double value, const Draw&)>;

/// Looks from elsewhere.
Question ask(const View& input, const Photo& photo) {
  return {input, photo.lens, photo.world_from_cam};
}

/// Looks from the photo's own camera, turned and moved.
Question ask_from(const View& input, const Photo& photo, double degrees,
                  const Eigen::Vector3d& metres) {
  return {input, photo.view.intrinsics, moved_pose(photo.view.world_from_cam, degrees, metres)};
}

/// Asks about the usual view of a photo that something went wrong with.
Ask about(const std::function<View(const View&, double, const Draw&)>& disturb) {
  return [disturb](const Photo& photo, double value, const Draw& draw) {
    return ask(disturb(photo.view, value, draw), photo);
  };
}

/// How what the input's points show was changed, away from seams, where splats mix: its share of
/// all that they show.
std::string overwritten(const MethodView& shown, const MethodView& points, double most) {
  std::size_t changed = 0;
  cv::Mat1b known = shown.seen & points.seen;
  cv::erode(known, known, cv::Mat1b(2 * kSeam + 1, 2 * kSeam + 1, 1));
  for (int y = 0; y < known.rows; ++y) {
    for (int x = 0; x < known.cols; ++x) {
      if (!known(y, x)) continue;
      changed += cv::norm(shown.color(y, x) - points.color(y, x), cv::NORM_INF) > kChange;
    }
  }
  const double share =
      static_cast<double>(changed) / std::max(1.0, static_cast<double>(cv::countNonZero(known)));
  if (share <= most) return "";
  return std::to_string(100 * share) + " % of what was observed is shown otherwise";
}

class PhotoAxes {
 public:
  PhotoAxes(const SuiteOptions& options, const NetworksSource& networks)
      : options_(options), shared_(std::make_shared<Shared>(options, networks)) {}

  void add(const std::string& name, const std::string& what, const std::string& unit,
           const std::vector<double>& values, Where where, double limit, const Ask& ask) {
    Axis axis;
    axis.geometry = where == Where::visible;
    axis.name = name;
    axis.what = what;
    axis.unit = unit;
    axis.values = values_of(options_, values);
    axis.score = axis.geometry ? "PSNR of what the photo sees of the view" : "PSNR of the view";
    axis.score_unit = "dB";
    axis.limit = limit;
    axis.methods = {kOurs, "no-outpainter", "mean-colour", "telea", "nearest", "copy"};
    const auto shared = shared_;
    axis.run = [=](const std::string& method, double value) {
      return shared->show(method, value, ask, where);
    };
    axis.truth = [=](double value) {
      const Photo& photo = shared->photos.get()[0];
      return shared->truth(photo, ask(photo, value, {})).color;
    };
    axes_.push_back(std::move(axis));
  }

  /// Of the last axis.
  void rooms_alone(const std::string& why) { axes_.back().rooms_alone = why; }

  /// Shows the last axis without its guard too.
  void with_unguarded() {
    axes_.back().methods.insert(axes_.back().methods.begin() + 1, kUnguarded);
  }

  std::vector<Axis> take() { return std::move(axes_); }

 private:
  struct Shared {
    SuiteOptions options;
    Lazy<MethodNetworks> networks;
    Lazy<std::vector<Photo>> photos;
    std::map<std::pair<const Photo*, std::vector<double>>, Truth> truths;

    Shared(const SuiteOptions& o, const NetworksSource& source)
        : options(o), networks(source), photos([this] { return make_photos(); }) {}

    std::vector<Photo> make_photos() {
      std::vector<Photo> all;
      if (!options.given) {
        for (int i = 0; i < options.photos; ++i) {
          all.push_back(make_photo(room_seed(options, i), kPhoto));
        }
        return all;
      }
      for (const auto& pair : options.given->pairs) {
        all.push_back(given_photo(pair, kPhoto));
        // For all methods alike: what they do with holes is an axis of its own.
        if (cv::countNonZero(all.back().view.depth == 0) > 0) complete(&all.back().view);
      }
      return all;
    }

    /// Shot once for each lens and pose.
    const Truth& truth(const Photo& photo, const Question& question) {
      const Eigen::Matrix4d m = question.world_from_cam.matrix();
      std::vector<double> key(m.data(), m.data() + m.size());
      key.push_back(question.lens.width);
      Truth& known = truths[{&photo, key}];
      if (known.color.empty()) {
        const View view = photo.shoot(question.lens, question.world_from_cam);
        known = {view.color, true_visibility(photo.known, view).visible};
      }
      return known;
    }

    /// Fills holes of depth, as `scene` does.
    void complete(View* view) {
      const SceneNetworks& scene = networks.get().scene;
      fill_holes(*view, *scene.depth, scene.depth_scale);
    }

    MethodView shown_by(const std::string& name, const Question& question) {
      const std::string method = name == kUnguarded ? kOurs : name;
      ViewMethodOptions method_options;
      method_options.scene.outpaint.samples = options.samples;
      method_options.scene.outpaint.seed = options.seed;
      method_options.scene.outpaint.temperature = question.temperature;
      method_options.renderer.seed = options.seed;
      const MethodNetworks none;
      return make_view_method(method, needs_networks(method) ? networks.get() : none,
                              method_options)
          ->show(question.input, question.lens, question.world_from_cam);
    }

    Outcome show(const std::string& method, double value, const Ask& ask, Where where) {
      Outcome outcome;
      std::vector<double> scores;
      for (std::size_t i = 0; i < photos.get().size(); ++i) {
        const Photo& photo = photos.get()[i];
        Question question = ask(photo, value, {options.seed, static_cast<std::uint32_t>(i)});
        if (method == kOurs && question.holes) complete(&question.input);
        const MethodView shown = shown_by(method, question);
        // Not of ours without its guard: where depth is missing nobody knows what would stand
        // before what was seen, which is what the guard is for.
        if (method == kOurs && outcome.overwritten.empty()) {
          outcome.overwritten = overwritten(shown, shown_by("mean-colour", question),
                                            options.given ? kMostChangedOfGiven : kMostChanged);
        }
        outcome.finite = outcome.finite && cv::checkRange(shown.color);
        outcome.digest = outcome.digest * 31 + digest_of(shown.color);
        const Truth& true_view = truth(photo, question);
        if (i == 0) outcome.picture = shown.color;
        const bool whole = where == Where::all;
        if (!whole && cv::countNonZero(true_view.visible) == 0) continue;
        scores.push_back(psnr(shown.color, true_view.color, whole ? Mask() : true_view.visible));
      }
      outcome.score = [scores] { return mean(scores); };
      return outcome;
    }
  };

  SuiteOptions options_;
  std::shared_ptr<Shared> shared_;
  std::vector<Axis> axes_;
};

void add_looks(PhotoAxes* axes) {
  axes->add("rotation", "The camera turns to the right", "degrees",
            {0, 10, 20, 40, 60, 90, 135, 180}, Where::all, 12,
            [](const Photo& photo, double x, const Draw&) {
              return ask_from(photo.view, photo, x, Eigen::Vector3d::Zero());
            });
  axes->rooms_alone(kMovesCamera);
  axes->add("translation", "The camera moves to the right", "metres", {0, .1, .2, .4, .6, .8},
            Where::visible, 17, [](const Photo& photo, double x, const Draw&) {
              return ask_from(photo.view, photo, 0, {x, 0, 0});
            });
  axes->rooms_alone(kMovesCamera);
  axes->add("missing-share", "The photo is missing from its right side on", "% of the pixels",
            {0, 10, 25, 50, 75, 90, 100}, Where::all, 12,
            [](const Photo& photo, double x, const Draw&) {
              View input = photo.view;
              input.depth = photo.view.depth.clone();
              const int from = static_cast<int>((1 - x / 100) * input.depth.cols);
              input.color = photo.view.color.clone();
              input.depth.colRange(from, input.depth.cols).setTo(0);
              input.color.colRange(from, input.color.cols).setTo(cv::Scalar::all(.5));
              return ask_from(input, photo, 0, Eigen::Vector3d::Zero());
            });
  axes->add("temperature", "The temperature of sampling", "", {0, .35, .7, 1, 1.5, 2}, Where::all,
            12, [](const Photo& photo, double x, const Draw&) {
              Question question = ask(photo.view, photo);
              question.temperature = x;
              return question;
            });
}

void add_inputs(PhotoAxes* axes) {
  axes->add("photo-focal", "The photo's focal length is taken to be larger than it is", "%",
            {0, 2, 5, 10, 20, 40, 80}, Where::visible, 17,
            about([](const View& v, double x, const Draw&) { return with_focal(v, x / 100); }));
  axes->add(
      "photo-noise", "The photo's depth is noisy: normal, independent at each pixel",
      "% of the depth", {0, 1, 2, 4, 8, 16, 32}, Where::visible, 17,
      about([](const View& v, double x, const Draw& d) { return with_noise(v, x / 100, d); }));
  axes->add("photo-bias", "The photo's depths are too large by one factor", "%",
            {0, 10, 25, 50, 100, 200, 400}, Where::visible, 17,
            about([](const View& v, double x, const Draw&) { return with_bias(v, x / 100); }));
  axes->add("photo-holes", "The photo's depth is missing in blots", "% of the pixels",
            {0, 10, 25, 50, 75, 90, 100}, Where::visible, 17,
            [](const Photo& photo, double x, const Draw& draw) {
              Question question = ask(with_holes(photo.view, x / 100, draw), photo);
              question.holes = true;
              return question;
            });
  axes->with_unguarded();
  axes->add("photo-edges", "The photo's depth is smeared over edges", "pixels",
            {0, 2, 4, 8, 16, 32, 64}, Where::visible, 17,
            about([](const View& v, double x, const Draw&) { return with_soft_edges(v, x); }));
  axes->add("photo-tiny", "The photo is so many times narrower", "times", {1, 2, 4, 8, 16, 32, 128},
            Where::visible, 17,
            about([](const View& v, double x, const Draw&) { return shrunk(v, x); }));
}

}  // namespace

std::vector<Axis> photo_axes(const SuiteOptions& options, const NetworksSource& networks) {
  PhotoAxes axes(options, networks);
  add_looks(&axes);
  add_inputs(&axes);
  return axes.take();
}

}  // namespace ps::stress
