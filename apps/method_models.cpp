// SPDX-License-Identifier: BSD-3-Clause
#include "apps/method_models.h"

#include <algorithm>
#include <system_error>

#include "apps/default_weights.h"
#include "io/weights_file.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

constexpr char kRgb[] = "rgb.safetensors";

fs::path rgb_weights(const std::string& weights) {
  std::error_code ignored;
  const fs::path beside = fs::path(weights) / kRgb;
  return !weights.empty() && fs::exists(beside, ignored) ? beside : default_weights(kRgb);
}

}  // namespace

std::vector<std::string> default_methods() {
  std::vector<std::string> names = view_method_names();
  if (!find_default_weights(kRgb)) names.erase(std::find(names.begin(), names.end(), "rgb"));
  return names;
}

MethodModels::MethodModels(const std::string& weights, const std::vector<std::string>& methods,
                           const Context& context) {
  if (!std::any_of(methods.begin(), methods.end(), needs_networks)) {
    depth_ = std::make_unique<DepthModel>(load_depth_model(depth_weights(weights), context));
    return;
  }
  scene_ = std::make_unique<SceneModels>(weights, "both", context);
  if (std::find(methods.begin(), methods.end(), "rgb") == methods.end()) return;
  const nn::Weights rgb = read_weights(rgb_weights(weights));
  rgb_autoencoder_ = std::make_unique<models::Autoencoder>(rgb);
  rgb_pixel_cnn_ = std::make_unique<models::PixelCnn>(rgb);
}

MethodNetworks MethodModels::networks() const {
  MethodNetworks networks;
  if (!scene_) return networks;
  networks.scene = scene_->networks();
  networks.scorers = scene_->scorers();
  networks.rgb.autoencoder = rgb_autoencoder_.get();
  networks.rgb.pixel_cnn = rgb_pixel_cnn_.get();
  return networks;
}

}  // namespace ps::apps
