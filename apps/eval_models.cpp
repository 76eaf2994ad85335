// SPDX-License-Identifier: BSD-3-Clause
#include "apps/eval_models.h"

#include "apps/scene_input.h"
#include "io/weights_file.h"

namespace ps::apps {

void add_lpips_option(CLI::App& verb, std::string& lpips) {
  verb.add_option("--lpips", lpips, "Weights of LPIPS, for the perceptual distance")
      ->type_name("FILE");
}

PerceptualModel::PerceptualModel(const std::string& lpips) {
  if (!lpips.empty()) net_.emplace(read_weights(lpips));
}

PerceptualDistance PerceptualModel::distance() const {
  return net_ ? lpips_distance(*net_) : PerceptualDistance();
}

std::optional<FeatureNetwork> PerceptualModel::features() const {
  return net_ ? std::optional(lpips_features(*net_)) : std::nullopt;
}

void complete_depth(View& view, const DepthModel& model, bool estimate) {
  if (estimate || view.depth.empty() || cv::countNonZero(view.depth) == 0) {
    view.depth = photo_depth(model.net, view.color, view.intrinsics, model.scale);
  } else {
    fill_holes(view, model);
  }
}

}  // namespace ps::apps
