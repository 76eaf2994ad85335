// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <memory>

#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/eval/image_metrics.h"
#include "libps/eval/pairs.h"
#include "libps/geometry/point.h"
#include "libps/scene/knob_clock.h"
#include "libps/scene/knobs.h"
#include "libps/scene/view_renderer.h"

namespace ps {
namespace {

constexpr const char* kTimed = "outpainting, adding and rendering the view";

std::vector<ScoreColumn> columns_of(const OutpaintKnobOptions& options) {
  std::vector<ScoreColumn> columns = {{"PSNR where invisible", "dB", true}, {"PSNR", "dB", true}};
  if (options.perceptual) columns.push_back({"LPIPS", "", false});
  return columns;
}

Image show(const OutpaintKnobOptions& options, const View& input, const View& target) {
  SceneBuilder scene(options.networks, input.intrinsics, options.scene);
  scene.observe(input, 0);
  const SupportView support = scene.outpaint(target.world_from_cam, 1);
  if (support.view.color.empty()) throw Error("outpainting", "was stopped");
  scene.add(support, 1);
  ViewRendererOptions renderer_options;
  renderer_options.seed = options.scene.outpaint.seed;
  ViewRenderer renderer(options.networks.outpaint.refiner, renderer_options);
  return renderer.render(scene.cloud(), target.intrinsics, target.world_from_cam).color;
}

/// A knob whose settings are options of outpainting.
Knob outpaint_knob(Knob knob, const std::vector<OutpaintKnobOptions>& settings) {
  knob.timed = kTimed;
  knob.scores = columns_of(settings.front());
  knob.prepare = [settings](const KnobSample& sample) {
    struct Pair {
      View input, target;
      Mask invisible;
    };
    const auto pair = std::make_shared<Pair>();
    *pair = {sample.input, sample.target, true_visibility(sample.input, sample.target).invisible};
    if (!sample.whole_depth.empty()) pair->input.depth = sample.whole_depth;
    return KnobBench{
        sample.target.color, [=](std::size_t s) {
          KnobTrial trial;
          trial.seconds =
              seconds_of([&] { trial.picture = show(settings[s], pair->input, pair->target); });
          const Image& truth = pair->target.color;
          trial.scores = {psnr(trial.picture, truth, pair->invisible), psnr(trial.picture, truth)};
          if (settings[s].perceptual) {
            trial.scores.push_back(settings[s].perceptual(trial.picture, truth));
          }
          return trial;
        }};
  };
  return knob;
}

OutpaintKnobOptions without_judges(OutpaintKnobOptions options) {
  options.networks.outpaint.scorers.clear();
  return options;
}

}  // namespace

Knob samples_knob(const OutpaintKnobOptions& options) {
  Knob knob = {"samples", "Completions drawn of a view, of which the best is kept."};
  std::vector<OutpaintKnobOptions> settings;
  for (const int samples : {1, 4, 16, 50, 100}) {
    settings.push_back(without_judges(options));
    settings.back().scene.outpaint.samples = samples;
    knob.settings.push_back({std::to_string(samples), false});
  }
  settings.push_back(without_judges(options));
  settings.back().scene.outpaint.samples = outpaint::OutpaintOptions().samples;
  settings.back().scene.outpaint.until_settled = true;
  knob.settings.push_back({"auto", true});
  return outpaint_knob(std::move(knob), settings);
}

Knob guidance_knob(const OutpaintKnobOptions& options) {
  Knob knob = {"guidance", "How much sampling is held to the nearest seen colours."};
  std::vector<OutpaintKnobOptions> settings;
  for (const double guidance : {0.0, 0.25, 1.0, 4.0, 16.0}) {
    settings.push_back(without_judges(options));
    settings.back().scene.outpaint.guidance = guidance;
    knob.settings.push_back(
        {in_digits(guidance), guidance == outpaint::OutpaintOptions().guidance});
  }
  return outpaint_knob(std::move(knob), settings);
}

Knob selection_knob(const OutpaintKnobOptions& options) {
  Knob knob = {"selection", "Whose opinion keeps the best of " +
                                std::to_string(options.selection_samples) +
                                " completions; first = none, one is drawn."};
  std::vector<OutpaintKnobOptions> settings;
  const auto add = [&](const char* name, const std::string& scorer, int samples) {
    settings.push_back(options);
    settings.back().scene.outpaint.samples = samples;
    auto& scorers = settings.back().networks.outpaint.scorers;
    if (scorer != "all") {
      scorers.clear();
      for (const outpaint::Scorer& one : options.networks.outpaint.scorers) {
        if (one.name == scorer) scorers.push_back(one);
      }
    }
    knob.settings.push_back({name, std::string(name) == "consensus"});
  };
  add("first", "none", 1);
  add("consensus", "none", options.selection_samples);
  add("likelihood", "none", options.selection_samples);
  settings.back().scene.outpaint.keep = outpaint::OutpaintOptions::Keep::likeliest;
  add("classifier", "entropy", options.selection_samples);
  add("discriminator", "discriminator", options.selection_samples);
  add("both", "all", options.selection_samples);
  return outpaint_knob(std::move(knob), settings);
}

}  // namespace ps
