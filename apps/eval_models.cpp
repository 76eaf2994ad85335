// SPDX-License-Identifier: BSD-3-Clause
#include "apps/eval_models.h"

#include "io/posed_frames.h"
#include "io/weights_file.h"
#include "libps/scene/photo_depth.h"

namespace ps::apps {

void add_lpips_option(CLI::App& verb, std::string& lpips, const std::string& of) {
  verb.add_option("--lpips", lpips, "Weights of LPIPS, for the perceptual distance" + of)
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
  if (estimate || !has_depth(view)) {
    view.depth = photo_depth(model.net, view.color, view.intrinsics, model.scale);
  } else {
    fill_holes(view, model.net, model.scale);
  }
}

}  // namespace ps::apps
