// SPDX-License-Identifier: BSD-3-Clause
#include "apps/scene_models.h"

#include <algorithm>
#include <system_error>

#include "apps/default_weights.h"
#include "io/weights_file.h"
#include "libps/core/error.h"
#include "libps/models/codebook_mark.h"

namespace fs = std::filesystem;

namespace ps::apps {

fs::path weights_of(const std::string& weights, const std::string& name) {
  if (weights.empty()) return default_weights(name);
  std::error_code ignored;
  return fs::is_directory(weights, ignored) ? fs::path(weights) / name : fs::path(weights);
}

std::string depth_weights(const std::string& weights) {
  return weights_of(weights, "depth.safetensors").string();
}

const std::vector<std::string>& selection_names() {
  static const std::vector<std::string> names = {"consensus", "likelihood", "discriminator",
                                                 "classifier", "both"};
  return names;
}

bool has_judges(const std::string& selection) {
  return selection != "consensus" && selection != "likelihood";
}

void check_codes(const models::Autoencoder& autoencoder, const models::PixelCnn& pixel_cnn,
                 const std::string& file) {
  if (pixel_cnn.codes() == autoencoder.codes()) return;
  throw Error(file,
              "the autoencoder has " + std::to_string(autoencoder.codes()) +
                  " codes, the PixelCNN " + std::to_string(pixel_cnn.codes()),
              "networks that were trained together");
}

void check_codebook(const nn::Weights& autoencoder, const fs::path& pixel_cnn) {
  const Metadata words = read_metadata(pixel_cnn);
  const auto mark = words.find(models::kCodebookMark);
  if (mark == words.end()) return;
  const auto& embed = autoencoder.get("vqvae.quantize_t.embed", {0, 0}).values;
  if (models::same_codebook(mark->second, models::codebook_mark(embed))) return;
  throw Error(pixel_cnn.string(), "continues other codes than those of " + autoencoder.name(),
              "networks that were trained together");
}

SceneModels::SceneModels(const std::string& weights, const std::string& selection,
                         const Context& context) {
  const auto read = [&](const char* name) {
    const fs::path file = weights_of(weights, name);
    if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
    return read_weights(file);
  };
  const auto wants = [&](const char* name) { return selection == "both" || selection == name; };
  files_.emplace_back(depth_weights(weights));
  depth_ = std::make_unique<DepthModel>(load_depth_model(files_.front().string(), context));
  const nn::Weights vqvae = read("vqvae.safetensors");
  autoencoder_ = std::make_unique<models::Autoencoder>(vqvae);
  check_codebook(vqvae, weights_of(weights, "pixelcnn.safetensors"));
  pixel_cnn_ = std::make_unique<models::PixelCnn>(read("pixelcnn.safetensors"));
  const nn::Weights refine = read("refine.safetensors");
  refiner_ = std::make_unique<models::Refiner>(refine);
  if (wants("discriminator")) {
    discriminator_ = std::make_unique<models::Discriminator>(refine);
    scorers_["discriminator"] = outpaint::discriminator_scorer(*discriminator_);
  }
  if (wants("classifier")) {
    const nn::Weights classifier = read("classifier.safetensors");
    if (!classifier.has_prefix("classifier.") && !classifier.has("fc.weight")) {
      throw Error(classifier.name(), "holds no classifier of scenes", "--select discriminator");
    }
    classifier_ = std::make_unique<models::Classifier>(classifier);
    scorers_["classifier"] = outpaint::entropy_scorer(*classifier_);
  }
  check_codes(*autoencoder_, *pixel_cnn_, weights_of(weights, "pixelcnn.safetensors").string());
}

SceneNetworks SceneModels::networks() const {
  SceneNetworks networks = {
      {autoencoder_.get(), pixel_cnn_.get(), refiner_.get(), {}}, &depth_->net, depth_->scale};
  for (const auto& [name, scorer] : scorers_) networks.outpaint.scorers.push_back(scorer);
  return networks;
}

}  // namespace ps::apps
