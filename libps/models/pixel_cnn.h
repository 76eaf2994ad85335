// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/linear.h"
#include "libps/nn/masked_convolution.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::models {

class Layers;

/// @brief What each cell of a grid may look at: for each of the 3x3 taps, row by row, and each
/// cell, 0 = hidden (SPEC.md 6). All are [9][height * width].
struct LocalMasks {
  std::vector<std::uint8_t> first;    ///< of the first layer: the cell itself is hidden
  std::vector<std::uint8_t> later;    ///< of all others
  std::vector<std::uint8_t> dilated;  ///< of those with a dilation of 2
};

/// @brief The first layer: a locally masked convolution of one-hot codes and a channel of ones. One
/// row of weights is added for each visible tap; the input is never built.
class CodeConvolution {
 public:
  /// @param weight  [out, codes + 1, 3, 3], the ones last
  CodeConvolution(const nn::WeightTensor& weight, std::vector<float> bias);

  int codes() const { return codes_; }
  int out_channels() const { return static_cast<int>(bias_.size()); }
  const std::vector<float>& bias() const { return bias_; }
  /// @param tap   in [0, 9)
  /// @param code  in [0, codes()), or anything below 0: not yet sampled
  /// @return what a visible neighbour adds: out_channels() values
  const float* row(int tap, std::int32_t code) const {
    const auto index = static_cast<std::size_t>(code < 0 ? codes_ : code);
    return rows_.data() + (static_cast<std::size_t>(tap) * rows() + index) * bias_.size();
  }

  /// @param codes  out.shape.pixels() values, all below codes()
  void operator()(const std::int32_t* codes, const std::uint8_t* mask,
                  const nn::TensorView& out) const;

 private:
  std::size_t rows() const { return static_cast<std::size_t>(codes_) + 1; }

  int codes_ = 0;
  std::vector<float> bias_;
  std::vector<float> rows_;  ///< [9][codes + 1][out]; the last row is that of no code
};

/// @brief h = PONO(input(celu(x))) + skip(celu(a)); (p, q) = output(celu(h)); x + PONO(p) *
/// sigmoid(q).
struct GatedBlock {
  nn::MaskedConvolution input;     ///< to f channels
  std::optional<nn::Linear> skip;  ///< in the down half alone
  nn::MaskedConvolution output;    ///< to 2f channels
};

/// Some blocks and, behind all but the last stage's, a dilated convolution with PONO.
struct GatedStage {
  std::vector<GatedBlock> blocks;
  std::optional<nn::MaskedConvolution> dilated;
};

/// @brief PixelCNN++ with locally masked convolutions: the distribution of every code, given those
/// earlier in some order (SPEC.md 7; `outpaint2.*`). Its layers are public to be read: a sampler
/// computes the same cell by cell.
class PixelCnn {
 public:
  explicit PixelCnn(const nn::Weights& weights, const ModelOptions& options = {});

  int codes() const { return first_.codes(); }            ///< 512
  int channels() const { return first_.out_channels(); }  ///< f

  /// @param codes   n * h * w values in [0, codes()), or below 0 where not yet sampled
  /// @param masks   for a grid of h x w, the same for all n
  /// @param logits  [n, h, w, codes()]
  /// Throws ps::Error also when a code is too great or the masks are of another size.
  void forward(const std::int32_t* codes, const LocalMasks& masks, const nn::TensorView& logits,
               nn::Workspace& workspace) const;

  const CodeConvolution& first() const { return first_; }
  const std::vector<GatedStage>& up() const { return up_; }
  const std::vector<GatedStage>& down() const { return down_; }
  const nn::Linear& last() const { return last_; }  ///< after elu

 private:
  explicit PixelCnn(const Layers& layers, nn::Storage storage);

  CodeConvolution first_;
  std::vector<GatedStage> up_;
  std::vector<GatedStage> down_;
  nn::Linear last_;
};

}  // namespace ps::models
