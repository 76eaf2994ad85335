// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "libps/scene/scene_builder.h"
#include "tests/support/random_weights.h"

namespace ps {

/// Narrow networks by chance: what they paint is noise, but where it goes is not.
struct RandomNetworks {
  models::Autoencoder autoencoder{models::random_autoencoder(16, 8, 8, 24)};
  models::PixelCnn pixel_cnn{models::random_pixel_cnn(11, 24)};
  models::Refiner refiner{models::random_refiner(8)};
  models::DepthNet depth{models::random_depth_net(4)};

  SceneNetworks all() const { return {{&autoencoder, &pixel_cnn, &refiner, {}}, &depth, {}}; }
};

inline const RandomNetworks& random_networks() {
  static const RandomNetworks kNetworks;
  return kNetworks;
}

}  // namespace ps
