// SPDX-License-Identifier: BSD-3-Clause
#include "apps/depth_model.h"

#include <cmath>

#include "apps/default_weights.h"
#include "io/weights_file.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

double number_in(const Metadata& metadata, const std::string& key, const std::string& file) {
  const Json value = Json::parse(metadata.at(key), nullptr, false);
  if (value.is_number()) return value.get<double>();
  throw Error(file, key + " in its metadata is '" + metadata.at(key) + "'", "a number");
}

/// A published checkpoint holds the two as tensors of one value.
bool read_tensors(const nn::Weights& weights, DepthScale& scale) {
  if (!weights.has("min_z") || !weights.has("max_z")) return false;
  scale.min_z = weights.get("min_z", {1}).values[0];
  scale.max_z = weights.get("max_z", {1}).values[0];
  return true;
}

DepthScale scale_of(const std::string& file, const nn::Weights& weights, const Context& context) {
  const Metadata metadata = read_metadata(file);
  DepthScale scale;
  if (metadata.count("min_z") == 0 || metadata.count("max_z") == 0) {
    if (!read_tensors(weights, scale)) {
      context.warn(file + ": does not say which depths it was trained to; 1 to 100 m taken");
    }
    check(scale, file);
    return scale;
  }
  scale.min_z = static_cast<float>(number_in(metadata, "min_z", file));
  scale.max_z = static_cast<float>(number_in(metadata, "max_z", file));
  if (metadata.count("canonical_focal") > 0) {
    scale.canonical_focal = number_in(metadata, "canonical_focal", file);
  }
  check(scale, file);
  return scale;
}

}  // namespace

void add_weights_option(CLI::App& verb, std::string& weights) {
  verb.add_option("--weights", weights,
                  "Weights of the depth network (default: those that come with the program)")
      ->type_name("FILE");
}

DepthModel load_depth_model(const std::string& weights, const Context& context) {
  const std::string file =
      weights.empty() ? default_weights("depth.safetensors").string() : weights;
  const nn::Weights read = read_weights(file);
  models::DepthNet net(read);
  return {file, scale_of(file, read, context), std::move(net)};
}

Json scale_report(const DepthModel& model, const Intrinsics& lens) {
  const double shorter = std::min(lens.width, lens.height);
  return {{"weights", model.weights},
          {"canonical_focal", model.scale.canonical_focal},
          {"focal", std::sqrt(lens.fx * lens.fy) / shorter},
          {"rule",
           "metres = the network's depth * focal / canonical_focal, in short sides of the "
           "photo"},
          {"metric_depth_promised", false},
          {"why",
           "a photo does not tell a large thing far away from a small one nearby: "
           "proportions are estimated, metres follow from the sizes the network was "
           "trained on and from the focal length"}};
}

}  // namespace ps::apps
