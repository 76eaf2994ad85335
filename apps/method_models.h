// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/context.h"
#include "apps/scene_models.h"
#include "libps/scene/view_methods.h"

namespace ps::apps {

/// @return view_method_names(), without `rgb` where its weights are missing
std::vector<std::string> default_methods();

/// @brief The networks that view methods need (libps/scene/view_methods.h), from weights files.
class MethodModels {
 public:
  /// @param weights  as SceneModels takes them; those of `rgb` are rgb.safetensors in a folder,
  /// else what comes with the program
  /// @param methods  of view_method_names(). Networks that outpaint are read where one of these
  /// outpaints, the refiner for no-outpainter, those of `rgb` for it; depth always.
  /// Throws ps::Error as SceneModels does, and when the weights of `rgb` are missing.
  MethodModels(const std::string& weights, const std::vector<std::string>& methods,
               const Context& context);

  MethodNetworks networks() const;
  const DepthModel& depth() const { return scene_ ? scene_->depth() : *depth_; }

 private:
  std::unique_ptr<SceneModels> scene_;
  std::unique_ptr<DepthModel> depth_;         ///< where no method outpaints
  std::unique_ptr<models::Refiner> refiner_;  ///< likewise
  std::unique_ptr<models::Autoencoder> rgb_autoencoder_;
  std::unique_ptr<models::PixelCnn> rgb_pixel_cnn_;
};

}  // namespace ps::apps
