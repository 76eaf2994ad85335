// SPDX-License-Identifier: BSD-3-Clause
#include "apps/chart_knobs.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "apps/interrupt.h"
#include "apps/scene_input.h"
#include "io/weights_file.h"
#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// Of the layer that all widths follow from; 0 where it is missing.
std::size_t width_of(const nn::Weights& weights) {
  for (const char* name : {"pts_regressor.conv1.weight", "pts_regressor.conv1.weight_orig"}) {
    const auto found = weights.tensors().find(name);
    if (found != weights.tensors().end() && !found->second.shape.empty()) {
      return found->second.shape.front();
    }
  }
  return 0;
}

struct WidthFile {
  fs::path file;
  std::size_t width = 0;
};

/// depth-*.safetensors by width.
std::vector<WidthFile> width_files(const std::string& folder) {
  std::error_code problem;
  std::vector<WidthFile> files;
  for (const auto& entry : fs::directory_iterator(folder, problem)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("depth-", 0) != 0 || entry.path().extension() != ".safetensors") continue;
    files.push_back({entry.path(), width_of(read_weights(entry.path()))});
  }
  if (problem) throw Error(folder, problem.message(), "a folder of depth-*.safetensors");
  if (files.size() < 2) {
    throw Error(folder, "holds fewer than two files depth-*.safetensors", "one for each width");
  }
  std::sort(files.begin(), files.end(), [](const WidthFile& a, const WidthFile& b) {
    return std::tie(a.width, a.file) < std::tie(b.width, b.file);
  });
  return files;
}

/// Knobs that show whole pictures are scored by LPIPS; the others show parts, or no picture.
void say_what_lpips_leaves_out(const std::vector<Knob>& knobs, const Context& context) {
  std::string others;
  for (const Knob& knob : knobs) {
    const bool scored = std::any_of(knob.scores.begin(), knob.scores.end(),
                                    [](const ScoreColumn& c) { return c.name == "LPIPS"; });
    if (!scored) others += (others.empty() ? "" : ", ") + knob.name;
  }
  if (!others.empty())
    context.say("--lpips scores samples, guidance and selection alone, not " + others);
}

}  // namespace

const std::vector<std::string>& knob_names() {
  static const std::vector<std::string> names = {"samples",    "guidance",         "selection",
                                                 "radius",     "points-per-pixel", "budget",
                                                 "image-size", "arithmetic",       "width"};
  return names;
}

ChartKnobs::ChartKnobs(const ChartKnobOptions& options, const Context& context)
    : perceptual_(options.lpips) {
  for (const std::string& name : options.names) {
    if (name == "samples") knobs_.push_back(samples_knob(outpainting(options, context)));
    if (name == "guidance") knobs_.push_back(guidance_knob(outpainting(options, context)));
    if (name == "selection") knobs_.push_back(selection_knob(outpainting(options, context)));
    if (name == "radius") knobs_.push_back(radius_knob());
    if (name == "points-per-pixel") knobs_.push_back(points_per_pixel_knob());
    if (name == "budget") knobs_.push_back(budget_knob());
    if (name == "image-size") knobs_.push_back(image_size_knob());
    if (name == "arithmetic") {
      refiner_ = read_weights(weights_of(options.weights, "refine.safetensors"));
      knobs_.push_back(arithmetic_knob(refiner_));
    }
    if (name == "width") add_widths(options, context);
  }
  if (knobs_.empty()) throw Error("--knobs", "nothing is left to try", "--widths DIR for width");
  if (!options.lpips.empty()) say_what_lpips_leaves_out(knobs_, context);
}

OutpaintKnobOptions ChartKnobs::outpainting(const ChartKnobOptions& options,
                                            const Context& context) {
  if (models_ == nullptr) models_ = std::make_unique<SceneModels>(options.weights, "both", context);
  OutpaintKnobOptions knob;
  knob.networks = models_->networks();
  knob.scene.outpaint.seed = context.seed;
  knob.scene.outpaint.progress = unless_interrupted;
  knob.perceptual = perceptual_.distance();
  return knob;
}

void ChartKnobs::add_widths(const ChartKnobOptions& options, const Context& context) {
  if (options.widths.empty()) {
    context.say("width is left out: --widths DIR names depth networks of several widths");
    return;
  }
  const std::size_t standard = width_of(read_weights(depth_weights(options.weights)));
  std::vector<DepthWidth> widths;
  for (const WidthFile& file : width_files(options.widths)) {
    depths_.push_back(std::make_unique<DepthModel>(load_depth_model(file.file.string(), context)));
    const std::string stem = file.file.stem().string();
    widths.push_back({stem.substr(std::string("depth-").size()), &depths_.back()->net,
                      depths_.back()->scale, file.width == standard});
  }
  const auto defaults = std::count_if(widths.begin(), widths.end(),
                                      [](const DepthWidth& width) { return width.is_default; });
  if (defaults != 1) {
    throw Error(options.widths,
                std::to_string(defaults) + " networks are as wide as the program's, " +
                    std::to_string(standard),
                "one");
  }
  knobs_.push_back(width_knob(widths));
}

void ChartKnobs::complete(KnobSample& sample) const {
  if (models_ == nullptr) return;
  View whole = sample.input;
  fill_holes(whole, models_->depth().net, models_->depth().scale);
  sample.whole_depth = whole.depth;
}

}  // namespace ps::apps
