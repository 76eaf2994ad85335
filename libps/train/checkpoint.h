// SPDX-License-Identifier: BSD-3-Clause
// Internal to this room: what is kept of a run.
#pragma once

#include <cstdint>
#include <filesystem>

#include "libps/train/stage.h"

namespace ps::train {

/// @brief Everything that the rest of a run depends on, in `out/checkpoint.safetensors`.
void save_checkpoint(Stage& stage, const TrainOptions& options, std::int64_t step);

/// @return the step that was reached: 0 when there is no checkpoint
/// Throws ps::Error when there is one of another stage, width, seed, batch or number of steps.
std::int64_t load_checkpoint(Stage& stage, const TrainOptions& options);

/// @brief The averaged weights of what is shipped, with what their reader has to know, in
/// `out/weights.safetensors`.
/// @return that path
std::filesystem::path save_weights(Stage& stage, const TrainOptions& options, std::int64_t step);

/// @brief All tensors of a file of weights, under the project's names, as F32.
TensorsByName read_tensors(const std::filesystem::path& path);

/// @brief Begins with the weights of a file; throws ps::Error when they do not fit.
void load_weights(Stage& stage, const std::filesystem::path& path);

}  // namespace ps::train
