// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/eval_models.h"
#include "apps/scene_models.h"
#include "libps/scene/knobs.h"

namespace ps::apps {

/// @return the names that --knobs takes, in the order of the chart
const std::vector<std::string>& knob_names();

struct ChartKnobOptions {
  std::vector<std::string> names = knob_names();
  std::string weights;  ///< as SceneModels takes them
  std::string widths;   ///< a folder of depth-*.safetensors; empty = none
  std::string lpips;    ///< weights; empty = none
};

/// @brief The knobs of a chart, with the networks that they need.
class ChartKnobs {
 public:
  /// Says which knob is left out and why, and which ones LPIPS does not score. Throws ps::Error
  /// when weights are missing or unsound.
  ChartKnobs(const ChartKnobOptions& options, const Context& context);

  const std::vector<Knob>& knobs() const { return knobs_; }
  /// @brief Fills what knobs of outpainting need of a sample.
  void complete(KnobSample& sample) const;

 private:
  OutpaintKnobOptions outpainting(const ChartKnobOptions& options, const Context& context);
  void add_widths(const ChartKnobOptions& options, const Context& context);

  std::unique_ptr<SceneModels> models_;
  PerceptualModel perceptual_;
  nn::Weights refiner_;
  std::vector<std::unique_ptr<DepthModel>> depths_;
  std::vector<Knob> knobs_;
};

}  // namespace ps::apps
