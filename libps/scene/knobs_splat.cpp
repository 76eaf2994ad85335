// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/eval/image_metrics.h"
#include "libps/eval/pairs.h"
#include "libps/geometry/point.h"
#include "libps/scene/budget.h"
#include "libps/scene/closed_splat.h"
#include "libps/scene/fuse.h"
#include "libps/scene/knob_clock.h"
#include "libps/scene/knobs.h"

namespace ps {
namespace {

constexpr const char* kTimed = "splatting the view";
constexpr int kRepeats = 5;

/// One cloud, and the view of it that was left out.
struct FusedSample {
  explicit FusedSample(const KnobSample& sample);

  /// Splats the target in the share of its size, as closed_splat() does.
  KnobTrial draw(const Cloud& cloud, SplatOptions options, float finest, double size = 1) const;

  View target;
  std::vector<PlannedView> cameras;  ///< of all views, the target's first
  Cloud cloud;
  Mask known;  ///< of the target: what other views see
};

FusedSample::FusedSample(const KnobSample& sample) : target(sample.target) {
  std::vector<View> views = sample.others;
  views.insert(views.begin(), sample.input);
  known = Mask::zeros(target.color.size());
  cameras.push_back({target.intrinsics, target.world_from_cam});
  for (const View& view : views) {
    known |= true_visibility(view, target).visible;
    cameras.push_back({view.intrinsics, view.world_from_cam});
  }
  cloud = fuse({views.size(), [&](std::size_t i) { return views[i]; }});
}

KnobTrial FusedSample::draw(const Cloud& points, SplatOptions options, float finest,
                            double size) const {
  options.renormalise = true;
  const auto side = [&](int length) {
    return std::max(1, static_cast<int>(std::lround(length * size)));
  };
  const Intrinsics lens =
      resized(target.intrinsics, side(target.intrinsics.width), side(target.intrinsics.height));
  KnobTrial trial;
  Splat drawn;
  trial.seconds = seconds_of(
      [&] { drawn = closed_splat(points, lens, target.world_from_cam, options, finest); });
  drawn.color.setTo(cv::Scalar::all(0.5), drawn.hit == 0);
  cv::resize(drawn.color, trial.picture, target.color.size(), 0, 0,
             size > 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
  trial.scores = {psnr(trial.picture, target.color, known)};
  return trial;
}

std::vector<ScoreColumn> psnr_column() { return {{"PSNR where known", "dB", true}}; }

/// How splats are drawn.
struct Drawing {
  SplatOptions options;
  float finest = kFinestSplat;
};

/// A knob that changes how splats are drawn; its settings are named already.
Knob splat_knob(Knob knob, const std::vector<Drawing>& drawings) {
  knob.timed = kTimed;
  knob.scores = psnr_column();
  knob.repeats = kRepeats;
  knob.prepare = [=](const KnobSample& sample) {
    const auto fused = std::make_shared<FusedSample>(sample);
    return KnobBench{sample.target.color, [=](std::size_t s) {
                       return fused->draw(fused->cloud, drawings[s].options, drawings[s].finest);
                     }};
  };
  return knob;
}

}  // namespace

Knob radius_knob() {
  Knob knob = {"radius",
               "Radius of splats, pixels; where two are told, from the narrowest to the widest, as "
               "footprints are, gaps closed: the view that was left out, from a fused cloud."};
  std::vector<Drawing> drawings;
  const auto add = [&](const std::string& name, float finest, float radius) {
    Drawing drawing;
    const bool standard = finest == drawing.finest && radius == drawing.options.radius;
    drawing.options.radius = radius;
    drawing.finest = finest;
    drawings.push_back(drawing);
    knob.settings.push_back({name, standard});
  };
  for (const float radius : {0.5F, 1.F, 1.5F, 2.F, 3.F, 4.F, 8.F}) {
    add(in_digits(radius), radius, radius);
  }
  const float widest = SplatOptions().radius;
  for (const float finest : {0.7F, 1.F, 1.5F}) {
    add(in_digits(finest) + " to " + in_digits(widest), finest, widest);
  }
  return splat_knob(std::move(knob), drawings);
}

Knob points_per_pixel_knob() {
  Knob knob = {"points-per-pixel",
               "Nearest so many points of a pixel that count: the view that was left out, from a "
               "fused cloud."};
  std::vector<Drawing> drawings;
  for (const int points : {1, 2, 4, 8, 16, 32, 64, 128}) {
    Drawing drawing;
    knob.settings.push_back({in_digits(points), points == drawing.options.points_per_pixel});
    drawing.options.points_per_pixel = points;
    drawings.push_back(drawing);
  }
  return splat_knob(std::move(knob), drawings);
}

Knob budget_knob() {
  Knob knob = {"budget",
               "Share of the points that is kept, thinned for these cameras; auto is what scenes "
               "do: the view that was left out, from a fused cloud.",
               kTimed,
               psnr_column(),
               {},
               kRepeats,
               {}};
  const std::vector<double> shares = {0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1};
  for (const double share : shares) knob.settings.push_back({in_digits(100 * share) + " %"});
  knob.settings.push_back({"auto", true});
  knob.scores.push_back({"points", "", false});
  knob.prepare = [shares](const KnobSample& sample) {
    const auto fused = std::make_shared<FusedSample>(sample);
    const auto clouds = std::make_shared<std::vector<Cloud>>();
    for (std::size_t s = 0; s <= shares.size(); ++s) {
      BudgetOptions options;
      const bool fixed = s < shares.size();
      if (fixed && shares[s] == 1) {
        clouds->push_back(fused->cloud);
        continue;
      }
      if (fixed) {
        options.points = std::max<std::size_t>(
            1, static_cast<std::size_t>(shares[s] * static_cast<double>(fused->cloud.size())));
      }
      clouds->push_back(thinned(fused->cloud, fused->cameras, options));
    }
    return KnobBench{sample.target.color, [=](std::size_t s) {
                       KnobTrial trial = fused->draw((*clouds)[s], {}, kFinestSplat);
                       trial.scores.push_back(static_cast<double>((*clouds)[s].size()));
                       return trial;
                     }};
  };
  return knob;
}

Knob image_size_knob() {
  Knob knob = {"image-size",
               "Size of the picture, in shares of the photo's, to which it is then resized: the "
               "view that was left out, from a fused cloud.",
               kTimed,
               psnr_column(),
               {},
               kRepeats,
               {}};
  const std::vector<double> shares = {0.25, 0.5, 0.75, 1, 1.5};
  for (const double share : shares) {
    knob.settings.push_back({in_digits(100 * share) + " %", share == 1});
  }
  knob.prepare = [shares](const KnobSample& sample) {
    const auto fused = std::make_shared<FusedSample>(sample);
    return KnobBench{sample.target.color, [=](std::size_t s) {
                       return fused->draw(fused->cloud, {}, kFinestSplat, shares[s]);
                     }};
  };
  return knob;
}

}  // namespace ps
