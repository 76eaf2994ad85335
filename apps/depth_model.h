// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "apps/context.h"
#include "apps/report.h"
#include "libps/scene/photo_depth.h"

namespace ps::apps {

/// A network that guesses depth, and what its weights were trained to.
struct DepthModel {
  std::string weights;  ///< their file
  DepthScale scale;
  models::DepthNet net;
};

/// @brief Adds --weights; empty = those that come with the program.
void add_weights_option(CLI::App& verb, std::string& weights);

/// @brief Reads the weights; warns when the file does not say their scale. Throws ps::Error when it
/// has no depth network, or an unsound scale.
DepthModel load_depth_model(const std::string& weights, const Context& context);

/// @brief For reports: the weights, the rule that gives metres, and that these are not promised.
Json scale_report(const DepthModel& model, const Intrinsics& lens);

}  // namespace ps::apps
