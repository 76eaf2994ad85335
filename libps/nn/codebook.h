// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "libps/nn/packed_matrix.h"
#include "libps/nn/weights.h"

namespace ps::nn {

/// @brief The codes of a VQ-VAE (SPEC.md 5).
class Codebook {
 public:
  /// @param embed  [channels, codes], as published
  explicit Codebook(const WeightTensor& embed);

  int size() const { return size_; }
  int channels() const { return channels_; }

  /// @brief For every pixel the first k that makes |x|^2 - 2 x.e_k + |e_k|^2 least.
  /// @param codes  in.shape.pixels() values
  void nearest(const TensorView& in, std::int32_t* codes) const;

  /// @brief By how much each code is farther from a pixel than the nearest: |x - e_k|^2, less the
  /// least of them.
  /// @param out  in.shape.pixels() x size() values
  void excess(const TensorView& in, float* out) const;

  /// The median, over all codes, of the squared distance to the nearest other (codes that training
  /// left far out do not move it); 0 for a single code.
  float spacing() const { return spacing_; }

  /// @brief The embeddings of codes. Throws ps::Error when a code is not in [0, size()).
  void embed(const std::int32_t* codes, const TensorView& out) const;

 private:
  /// Calls each(pixel, |e_k|^2 - 2 x.e_k of every k) for every pixel, from any thread.
  template <typename Each>
  void for_scores(const TensorView& in, const Each& each) const;
  float median_spacing();

  int size_ = 0, channels_ = 0;
  std::vector<float> vectors_;  ///< [codes][channels]
  std::vector<float> squares_;  ///< |e_k|^2
  float spacing_ = 0;
  PackedMatrix matrix_;
};

}  // namespace ps::nn
