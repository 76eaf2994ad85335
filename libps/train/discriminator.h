// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief The two-scale discriminator in training (SPEC.md 9; `netD.*`; models::Discriminator runs
/// it).
class Discriminator {
 public:
  Discriminator(int d, std::uint64_t seed);
  Parameters parameters;

  using Maps = std::vector<Tensor>;  ///< what each layer gives, the last one is D itself
  /// @param power  one step of the power iteration of spectral norms first (Miyato and others, ICLR
  /// 2018)
  std::array<Maps, 2> forward(const Tensor& image, bool power);
};

/// @brief Hinge losses (Lim and Ye, 2017), the mean over scales.
Tensor hinge_of_discriminator(const std::array<Discriminator::Maps, 2>& real,
                              const std::array<Discriminator::Maps, 2>& fake);
Tensor hinge_of_generator(const std::array<Discriminator::Maps, 2>& fake);
/// @brief L1 of the maps of all layers but the last (Wang and others, pix2pixHD, CVPR 2018).
Tensor feature_matching(const std::array<Discriminator::Maps, 2>& real,
                        const std::array<Discriminator::Maps, 2>& fake);

}  // namespace ps::train
