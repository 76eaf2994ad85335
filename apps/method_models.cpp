// SPDX-License-Identifier: BSD-3-Clause
#include "apps/method_models.h"

#include <algorithm>
#include <system_error>

#include "apps/default_weights.h"
#include "io/weights_file.h"
#include "libps/core/error.h"
#include "libps/models/color_codes.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

constexpr char kRgb[] = "rgb.safetensors", kNoOutpainter[] = "no-outpainter";

bool outpaints(const std::string& method) {
  return needs_networks(method) && method != kNoOutpainter;
}

fs::path rgb_weights(const std::string& weights) {
  std::error_code ignored;
  const fs::path beside = fs::path(weights) / kRgb;
  if (!weights.empty() && fs::exists(beside, ignored)) return beside;
  if (const auto shipped = find_default_weights(kRgb)) return *shipped;
  throw Error("--methods rgb", "its weights, rgb.safetensors, are missing",
              "--weights DIR with them, of `train pixelcnn --codes colours`");
}

}  // namespace

std::vector<std::string> default_methods() {
  std::vector<std::string> names = view_method_names();
  if (!find_default_weights(kRgb)) names.erase(std::find(names.begin(), names.end(), "rgb"));
  return names;
}

MethodModels::MethodModels(const std::string& weights, const std::vector<std::string>& methods,
                           const Context& context) {
  const auto has = [&](const char* name) {
    return std::find(methods.begin(), methods.end(), name) != methods.end();
  };
  if (std::none_of(methods.begin(), methods.end(), outpaints)) {
    depth_ = std::make_unique<DepthModel>(load_depth_model(depth_weights(weights), context));
    if (has(kNoOutpainter)) {
      const fs::path file = weights_of(weights, "refine.safetensors");
      refiner_ = std::make_unique<models::Refiner>(read_weights(file));
    }
    return;
  }
  scene_ = std::make_unique<SceneModels>(weights, "both", context);
  if (!has("rgb")) return;
  const fs::path file = rgb_weights(weights);
  rgb_autoencoder_ = std::make_unique<models::Autoencoder>(models::color_codes());
  rgb_pixel_cnn_ = std::make_unique<models::PixelCnn>(read_weights(file));
  check_codes(*rgb_autoencoder_, *rgb_pixel_cnn_, file.string());
}

MethodNetworks MethodModels::networks() const {
  MethodNetworks networks;
  if (!scene_) {
    networks.scene = {{nullptr, nullptr, refiner_.get(), {}}, &depth_->net, depth_->scale};
    return networks;
  }
  networks.scene = scene_->networks();
  networks.scene.outpaint.scorers.clear();  // as `scene` without --select
  networks.scorers = scene_->scorers();
  networks.rgb.autoencoder = rgb_autoencoder_.get();
  networks.rgb.pixel_cnn = rgb_pixel_cnn_.get();
  return networks;
}

}  // namespace ps::apps
