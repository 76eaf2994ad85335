// SPDX-License-Identifier: BSD-3-Clause
// Weights by chance for every network, at any widths: for tests without the reference and for
// benchmarks at the published widths. The same numbers on every machine; signals keep about their
// size from layer to layer.
#pragma once

#include "libps/nn/weights.h"

namespace ps::models {

nn::Weights random_depth_net(int f = 32);
nn::Weights random_autoencoder(int c = 128, int embedding = 64, int residual = 32, int codes = 512);
nn::Weights random_pixel_cnn(int f = 80, int codes = 512);
nn::Weights random_refiner(int g = 64);
nn::Weights random_discriminator(int d = 64);
nn::Weights random_classifier(int width = 64, int classes = 365);
/// @param divisor  of SqueezeNet's widths
nn::Weights random_lpips(int divisor = 1);

}  // namespace ps::models
