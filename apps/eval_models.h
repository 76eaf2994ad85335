// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "apps/depth_model.h"
#include "libps/eval/perceptual.h"
#include "libps/geometry/view.h"
#include "libps/models/lpips.h"

namespace ps::apps {

/// @brief Adds --lpips.
/// @param of  what is scored with it, where that is not all: ", in the knobs samples, guidance and
/// selection"
void add_lpips_option(CLI::App& verb, std::string& lpips, const std::string& of = "");

/// @brief What looks at pictures as people do, where its weights are given.
class PerceptualModel {
 public:
  /// @param lpips  weights file; empty = none. Throws ps::Error as reading weights does.
  explicit PerceptualModel(const std::string& lpips);

  PerceptualDistance distance() const;             ///< empty where there is none; looks at this
  std::optional<FeatureNetwork> features() const;  ///< likewise

 private:
  std::optional<models::Lpips> net_;
};

/// @brief Gives every pixel of a frame a depth: holes are filled by the network's, made to continue
/// what is measured; all is the network's when nothing is measured or `estimate` says so.
void complete_depth(View& view, const DepthModel& model, bool estimate);

}  // namespace ps::apps
