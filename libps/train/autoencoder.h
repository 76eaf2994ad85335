// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "libps/train/parameters.h"

namespace ps::train {

/// @brief The VQ-VAE in training (SPEC.md 5 and 10; `vqvae.*`; models::Autoencoder runs it).
class Autoencoder {
 public:
  /// The published ones, unless said otherwise.
  struct Widths {
    int channels = 128, residual = 32, embedding = 64, codes = 512;
  };
  Autoencoder(const Widths& widths, std::uint64_t seed);
  Parameters parameters;

  int codes() const { return static_cast<int>(parameters["quantize_t.embed"].size(1)); }

  /// @param image  [n, 3, h, w] in [-1,1], sides multiples of 8
  /// @return [n, e, h/8, w/8]: what is near to a code's embedding
  Tensor encode(const Tensor& image) const;
  /// @param grid  [n, e, h/8, w/8]   @return [n, 3, h, w]
  Tensor decode(const Tensor& grid) const;
  /// @param pre_quant  [n, e, h/8, w/8]   @return [n, h/8, w/8], int64, the nearest code
  Tensor nearest(const Tensor& pre_quant) const;
  /// @param codes  [n, h/8, w/8]   @return [n, e, h/8, w/8]
  Tensor embed(const Tensor& codes) const;

  /// @brief Moves the codebook towards what was quantised: the exponential average of van den Oord
  /// and others (NeurIPS 2017, appendix A.1), decay 0.99, eps 1e-5. A code whose average count
  /// falls below `kDead` of its fair share is put where a random pre-quantised vector of this batch
  /// is.
  void move_codebook(const Tensor& pre_quant, const Tensor& codes, torch::Generator generator);
  static constexpr double kDead = 0.03;
};

/// @brief A trained one; widths are read from its tensors. Throws ps::Error when it is none.
Autoencoder read_autoencoder(const std::filesystem::path& path, torch::Device device);

}  // namespace ps::train
