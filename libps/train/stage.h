// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: what the stages of training have in common.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "libps/train/augmentation.h"
#include "libps/train/dataset.h"
#include "libps/train/parameters.h"
#include "libps/train/train.h"

namespace ps::train {

using Values = std::map<std::string, double>;

/// How a stage is trained unless the caller says otherwise.
struct StageDefaults {
  int batch = 8;
  std::int64_t steps = 10000;
  double learning_rate = 1e-3;
  int curriculum = 0;  ///< as TrainOptions' own
};

class Stage {
 public:
  virtual ~Stage() = default;

  virtual StageDefaults defaults() const = 0;
  virtual Augmentation augmentation() const { return {true, true, true}; }
  virtual Wanted wanted() const { return {}; }

  /// @brief Told once what it is trained on, for what scores are compared with.
  virtual void look_at(const Dataset&) {}

  /// @brief One step along the gradients of a batch.
  /// @return the losses, summed up by name
  virtual Values step(const Batch& batch, torch::Generator generator, double learning_rate) = 0;

  /// @brief Scores of a batch that is not trained on; means over its examples.
  virtual Values test(const Batch& batch) = 0;
  /// @brief Rows of pictures [3, h, w] in [-1,1], one for each of the first examples of a batch.
  virtual std::vector<std::vector<Tensor>> pictures(const Batch& batch) = 0;

  struct Trained {
    Parameters* parameters;
    Adam* adam;
    bool shipped = true;  ///< whether it goes into the weights file
  };
  virtual std::vector<Trained> networks() = 0;
  /// @brief What a reader of the weights has to know.
  virtual std::map<std::string, std::string> metadata() const { return {}; }
};

/// @return the width that is asked for
inline int width_of(const TrainOptions& options, int shipped, int published) {
  if (options.width == kPaperWidth) return published;
  return options.width > 0 ? options.width : shipped;
}

/// @return the parameters, moved to the device
Parameters& on_device(Parameters& parameters, torch::Device device);

/// @brief How far views of a pair may be turned at a step: it grows to `most` in `curriculum` equal
/// steps, each as long; 0 = any.
double turn_limit(std::int64_t step, std::int64_t steps, int curriculum, double most);

std::unique_ptr<Stage> make_classifier_stage(const TrainOptions& options, torch::Device device);
std::unique_ptr<Stage> make_depth_stage(const TrainOptions& options, torch::Device device);
std::unique_ptr<Stage> make_pixelcnn_stage(const TrainOptions& options, torch::Device device);
std::unique_ptr<Stage> make_refine_stage(const TrainOptions& options, torch::Device device);
std::unique_ptr<Stage> make_vqvae_stage(const TrainOptions& options, torch::Device device);

}  // namespace ps::train
