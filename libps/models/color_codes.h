// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/nn/weights.h"

namespace ps::models {

/// @brief Weights of an Autoencoder that nobody trained: a cell's code is the nearest of 512
/// colours (8 levels of red, green and blue each) to the mean of its 8x8 pixels, and a code is
/// decoded to a square of that colour. Outpainting such codes is outpainting in RGB (PixelSynth,
/// section 4.2, the ablation without VQ-VAE), with the same PixelCNN, sampler and refinement.
///
/// What embed_avg and cluster_size would be in training is there too.
nn::Weights color_codes();

}  // namespace ps::models
