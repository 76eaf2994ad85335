// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "libps/eval/statistics.h"
#include "libps/scene/stress_fusers.h"
#include "libps/scene/stress_suite.h"

namespace ps::stress {
namespace {

enum class Score { psnr, f_score };

/// Disturbs all frames of one room.
using Disturb =
    std::function<std::vector<View>(const std::vector<View>&, double value, std::uint64_t seed)>;

/// Disturbs each frame by itself.
Disturb each(const std::function<View(const View&, double value, const Draw&)>& one) {
  return [one](const std::vector<View>& frames, double value, std::uint64_t seed) {
    std::vector<View> result;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      result.push_back(one(frames[i], value, {seed, static_cast<std::uint32_t>(i)}));
    }
    return result;
  };
}

Outcome fuse_and_score(const SuiteOptions& options, const std::vector<World>& worlds,
                       const std::string& method, double value, Score score,
                       const Disturb& disturb) {
  Outcome outcome;
  auto clouds = std::make_shared<std::vector<Cloud>>();
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    clouds->push_back(fuse_by(method, disturb(worlds[i].frames, value, draw_seed(options, i))));
    note(clouds->back(), &outcome);
  }
  outcome.picture = picture_of(method, clouds->front(), worlds[0].held_out[0]);
  outcome.score = [&worlds, clouds, method, score] {
    std::vector<double> scores;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
      const Cloud& cloud = (*clouds)[i];
      scores.push_back(score == Score::psnr ? psnr_of(method, cloud, worlds[i])
                                            : f_score_of(cloud, worlds[i].truth));
    }
    return mean(scores);
  };
  return outcome;
}

class FusionAxes {
 public:
  explicit FusionAxes(const SuiteOptions& options)
      : options_(options), worlds_(make_worlds(options)) {}

  void add(const std::string& name, const std::string& what, const std::string& unit,
           const std::vector<double>& values, Score score, double limit, const Disturb& disturb) {
    Axis axis;
    axis.name = name;
    axis.what = what;
    axis.unit = unit;
    axis.values = values_of(options_, values);
    axis.score = score == Score::psnr ? "PSNR of views left out" : "F-score of the cloud at 3 cm";
    axis.score_unit = score == Score::psnr ? "dB" : "%";
    axis.limit = limit;
    axis.methods = {kOurs, kOursUnguarded, kAllPoints, kVoxelGrid};
    const Worlds worlds = worlds_;
    const SuiteOptions options = options_;
    axis.run = [=](const std::string& method, double value) {
      return fuse_and_score(options, worlds->get(), method, value, score, disturb);
    };
    axis.truth = [=](double) { return worlds->get()[0].held_out[0].color; };
    axes_.push_back(std::move(axis));
  }

  /// Of the last axis.
  void rooms_alone(const std::string& why) { axes_.back().rooms_alone = why; }

  void add_depths();
  void add_cameras();
  std::vector<Axis> take() { return std::move(axes_); }

 private:
  SuiteOptions options_;
  Worlds worlds_;
  std::vector<Axis> axes_;
};

void FusionAxes::add_depths() {
  add("depth-noise", "Depths of all frames are noisy: normal, independent at each pixel",
      "% of the depth", {0, 1, 2, 4, 8, 16, 32}, Score::f_score, 50,
      each([](const View& v, double x, const Draw& d) { return with_noise(v, x / 100, d); }));
  add("depth-bias", "Depths of all frames are too large by one factor", "%",
      {0, 0.5, 1, 2, 4, 8, 16}, Score::psnr, 20,
      each([](const View& v, double x, const Draw&) { return with_bias(v, x / 100); }));
  add("depth-scale", "Depths of each frame are wrong by a factor of its own, as networks' are",
      "% spread", {0, 1, 2, 4, 8, 16, 32}, Score::f_score, 50,
      each([](const View& v, double x, const Draw& d) { return with_scale(v, x / 100, d); }));
  add("depth-holes", "Depths are missing in blots", "% of the pixels",
      {0, 20, 40, 60, 80, 90, 95, 98, 100}, Score::psnr, 17,
      each([](const View& v, double x, const Draw& d) { return with_holes(v, x / 100, d); }));
  add("depth-edges", "Depths are smeared over edges, so that points fly between surfaces", "pixels",
      {0, 2, 4, 8, 16, 32, 64}, Score::psnr, 20,
      each([](const View& v, double x, const Draw&) { return with_soft_edges(v, x); }));
  add("glass", "Panes of glass: nothing, the pane or what is beyond, by chance at each pixel",
      "% of the pixels", {0, 5, 10, 20, 40, 60, 80, 100}, Score::f_score, 70,
      each([](const View& v, double x, const Draw& d) { return with_glass(v, x / 100, d); }));
  add("mirror", "A round mirror on a wall: its depth is that of what it reflects",
      "metres of radius", {0, .1, .2, .4, .8, 1.6}, Score::f_score, 85,
      [](const std::vector<View>& frames, double value, std::uint64_t) {
        return with_mirror(frames, value);
      });
  rooms_alone("it reflects the walls of a box");
}

void FusionAxes::add_cameras() {
  add("pose-noise", "Poses of all frames are wrong: turned, and moved by 2 cm for each degree",
      "degrees", {0, 0.25, 0.5, 1, 2, 4, 8}, Score::psnr, 17,
      each([](const View& v, double x, const Draw& d) { return with_pose_noise(v, x, d); }));
  add("pose-outliers", "Some frames are lost: turned by 20 degrees and moved by 40 cm",
      "% of the frames", {0, 10, 20, 30, 40, 50, 60, 80}, Score::f_score, 85,
      [](const std::vector<View>& frames, double value, std::uint64_t seed) {
        std::vector<View> result = frames;
        const auto n = static_cast<std::uint32_t>(frames.size());
        const auto lost = static_cast<std::uint32_t>(value / 100 * n + .5);
        for (std::uint32_t k = 0; k < lost; ++k) {
          const std::uint32_t i = (3 + 7 * k) % n;
          result[i] = with_pose_noise(frames[i], 20, {seed, i});
        }
        return result;
      });
  add("focal-error", "The focal length of all frames is taken to be larger than it is", "%",
      {0, 1, 2, 4, 8, 16, 32}, Score::psnr, 17,
      each([](const View& v, double x, const Draw&) { return with_focal(v, x / 100); }));
  add("principal-point",
      "The principal point of all frames is taken to be further right than it is", "% of the width",
      {0, 1, 2, 4, 8, 16, 32}, Score::psnr, 17,
      each([](const View& v, double x, const Draw&) { return with_principal_point(v, x / 100); }));
  add("exposure", "Each frame is exposed more or less, and clips", "stops, spread",
      {0, 0.25, 0.5, 1, 1.5, 2, 3}, Score::psnr, 19,
      [](const std::vector<View>& frames, double value, std::uint64_t seed) {
        std::vector<double> stops;
        double mean = 0;
        for (std::uint32_t i = 0; i < frames.size(); ++i) {
          stops.push_back(normal_at({seed, i}, -1, -1));
          mean += stops.back() / static_cast<double>(frames.size());
        }
        std::vector<View> result;
        for (std::size_t i = 0; i < frames.size(); ++i) {
          result.push_back(with_exposure(frames[i], value * (stops[i] - mean)));
        }
        return result;
      });
  add("frame-order", "Some frames change places with others, anywhere in the order",
      "% of the frames", {0, 25, 50, 75, 100}, Score::psnr, 17,
      [](const std::vector<View>& frames, double value, std::uint64_t seed) {
        std::vector<View> result = frames;
        const auto moved =
            static_cast<std::size_t>(value / 100 * static_cast<double>(frames.size()));
        for (std::size_t i = 0; i < moved; ++i) {
          const double any = even_at({seed, static_cast<std::uint32_t>(i)}, 0);
          std::swap(result[i],
                    result[static_cast<std::size_t>(any * static_cast<double>(frames.size()))]);
        }
        return result;
      });
}

}  // namespace

std::vector<Axis> fusion_axes(const SuiteOptions& options) {
  FusionAxes axes(options);
  axes.add_depths();
  axes.add_cameras();
  return axes.take();
}

}  // namespace ps::stress
