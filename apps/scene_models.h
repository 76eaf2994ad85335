// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/context.h"
#include "apps/depth_model.h"
#include "libps/scene/scene_builder.h"

namespace ps::apps {

/// @return the file of one network that --weights names, or of what comes with the program
/// @param name  "refine.safetensors"
std::filesystem::path weights_of(const std::string& weights, const std::string& name);

/// @return the file of the depth network that --weights names
std::string depth_weights(const std::string& weights);

/// @return the names that --select takes: consensus, likelihood, discriminator, classifier,
/// both
const std::vector<std::string>& selection_names();
/// @return whether judges look at pictures to keep the best completion by it
bool has_judges(const std::string& selection);

/// @brief Throws ps::Error, naming the PixelCNN's file, unless it continues the autoencoder's
/// codes.
void check_codes(const models::Autoencoder& autoencoder, const models::PixelCnn& pixel_cnn,
                 const std::string& file);

/// @brief Throws ps::Error when the PixelCNN's file bears the mark of a codebook
/// (models/codebook_mark.h), and the autoencoder's is another. A file without one passes.
void check_codebook(const nn::Weights& autoencoder, const std::filesystem::path& pixel_cnn);

/// @brief The networks of a scene, from weights files.
class SceneModels {
 public:
  /// @param weights    one file that holds all networks, a folder of depth, vqvae, pixelcnn, refine
  ///                   and classifier.safetensors, or empty: what comes with the program
  /// @param selection  which opinions keep the best completion, of selection_names()
  /// Throws ps::Error that names file and tensor when one is missing or misshapen.
  SceneModels(const std::string& weights, const std::string& selection, const Context& context);

  SceneNetworks networks() const;
  const DepthModel& depth() const { return *depth_; }
  /// By "discriminator" and "classifier", as selected.
  const std::map<std::string, outpaint::Scorer>& scorers() const { return scorers_; }
  const models::Refiner* refiner() const { return refiner_.get(); }
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  std::vector<std::filesystem::path> files_;
  std::unique_ptr<DepthModel> depth_;
  std::unique_ptr<models::Autoencoder> autoencoder_;
  std::unique_ptr<models::PixelCnn> pixel_cnn_;
  std::unique_ptr<models::Refiner> refiner_;
  std::unique_ptr<models::Discriminator> discriminator_;
  std::unique_ptr<models::Classifier> classifier_;
  std::map<std::string, outpaint::Scorer> scorers_;
};

}  // namespace ps::apps
