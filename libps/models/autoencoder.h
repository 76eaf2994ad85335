// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/codebook.h"
#include "libps/nn/tensor.h"
#include "libps/nn/transposed_convolution.h"
#include "libps/nn/weights.h"

namespace ps::models {

class Layers;

/// @brief 3x3 and 1x1 convolution of relu(x), added to relu(x): the published blocks change x in
/// place.
struct ResidualBlock {
  nn::Convolution narrow, wide;

  /// @param x  holds relu(x) before, relu of the block's output after: ReLU follows every block
  void operator()(const nn::TensorView& x, nn::Workspace& workspace) const;
};

/// @brief An image as a grid of discrete codes and back: the top level of a VQ-VAE (SPEC.md 5;
/// `vqvae.*`). The published file's bottom level is not read.
class Autoencoder {
 public:
  static constexpr int kCell = 8;  ///< pixels along each side of one code

  explicit Autoencoder(const nn::Weights& weights, const ModelOptions& options = {});

  int codes() const { return codebook_.size(); }         ///< how many there are: 512
  int channels() const { return codebook_.channels(); }  ///< of an embedding: e

  /// @return {n, h / 8, w / 8, e}: the shape of what stands for an image of n x h x w
  nn::Shape grid(const nn::Shape& image) const;

  /// @param image      [n, h, w, 3], RGB in [-1,1], sides multiples of 8
  /// @param pre_quant  grid(image.shape): what is near to a code's embedding
  void encode(const nn::TensorView& image, const nn::TensorView& pre_quant,
              nn::Workspace& workspace) const;

  /// @brief The same, and the nearest code of each cell.
  /// @param codes  n x h/8 x w/8 values in [0, codes())
  void encode(const nn::TensorView& image, std::int32_t* codes, nn::Workspace& workspace) const;

  /// @brief The nearest codes of what encode() gave.
  void quantise(const nn::TensorView& pre_quant, std::int32_t* codes) const {
    codebook_.nearest(pre_quant, codes);
  }
  const nn::Codebook& codebook() const { return codebook_; }

  /// @param codes  n x h/8 x w/8 values; throws ps::Error when one is not in [0, codes())
  /// @param image  [n, h, w, 3]: RGB, about [-1,1], not clamped
  void decode(const std::int32_t* codes, const nn::TensorView& image,
              nn::Workspace& workspace) const;

 private:
  explicit Autoencoder(const Layers& layers);

  struct Encoder {
    nn::Convolution half, quarter, mix;  ///< sides over 2, over 4, the same
    std::vector<ResidualBlock> blocks;
    nn::Convolution eighth, mix_top;
    std::vector<ResidualBlock> top_blocks;
    nn::Convolution to_embedding;
  };
  struct Decoder {
    nn::TransposedConvolution quarter;
    nn::Convolution mix;
    std::vector<ResidualBlock> blocks;
    nn::TransposedConvolution half, whole;
  };
  static Encoder read_encoder(const Layers& layers);
  static Decoder read_decoder(const Layers& layers, int channels);
  static std::vector<ResidualBlock> read_blocks(const Layers& layers, const std::string& prefix,
                                                int first, int channels);

  Encoder encoder_;
  nn::Codebook codebook_;
  Decoder decoder_;
};

}  // namespace ps::models
