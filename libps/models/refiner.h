// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "libps/models/model_options.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"

namespace ps::models {

class Layers;

/// @brief A BatchNorm whose scale and shift come from noise: (x - mean) / sqrt(var + 1e-5) *
/// (1 + gain n) + bias n (SPEC.md 8).
class NoiseNorm {
 public:
  /// @param gain, bias  [channels, noise]
  NoiseNorm(const nn::WeightTensor& gain, const nn::WeightTensor& bias, std::vector<float> mean,
            const std::vector<float>& variance);

  int channels() const { return static_cast<int>(mean_.size()); }
  int noise() const { return static_cast<int>(gain_.size() / mean_.size()); }

  /// @param noise  noise() values, of N(0, 1)
  /// @param scale, shift  get channels() values each: the norm is x * scale + shift
  void apply(const float* noise, float* scale, float* shift) const;

 private:
  std::vector<float> gain_, bias_, mean_, inverse_deviation_;
};

/// @brief The network that makes one picture of a projection and what was outpainted (SPEC.md 8;
/// `projector.*`).
class Refiner {
 public:
  /// How the published weights were trained.
  enum class Output {
    tanh_of_sum,  ///< tanh(net + image): RealEstate10K
    tanh_of_net,  ///< tanh(net) + image: Matterport
  };
  static constexpr int kMultiple = 4;            ///< of an image's sides
  static constexpr std::size_t kNoiseRows = 16;  ///< one for each norm

  explicit Refiner(const nn::Weights& weights, const ModelOptions& options = {},
                   Output output = Output::tanh_of_sum);

  /// @return how many values of N(0, 1) one image takes: 16 rows of 20, in order of use
  std::size_t noise_count() const;

  /// @param input   [n, h, w, 4]: the combined image, RGB in [-1,1], and 1 where it shows
  /// foreground, else
  ///                0; sides multiples of 4
  /// @param noise   n * noise_count() values
  /// @param output  [n, h, w, 3]: RGB in (-1,1), or (-2,2) with Output::tanh_of_net; must not
  ///                overlap the input
  void forward(const nn::TensorView& input, const float* noise, const nn::TensorView& output,
               nn::Workspace& workspace) const;

 private:
  enum class Resample { none, down, up };
  struct Block {
    NoiseNorm norm1;
    nn::Convolution convolution1;
    NoiseNorm norm2;
    nn::Convolution convolution2;             ///< its bias has that of `straight` in it
    std::optional<nn::Convolution> straight;  ///< 1x1 on the other path; none = that path is x
    Resample resample;

    int noise() const { return norm1.noise() + norm2.noise(); }
    nn::Shape output(const nn::Shape& in) const;
  };
  static std::vector<Block> read_blocks(const Layers& layers);
  static void run(const Block& block, const nn::TensorView& x, const float* noise,
                  const nn::TensorView* added, const nn::TensorView& out, nn::Workspace& workspace);
  void forward_one(const nn::TensorView& input, const float* noise, const nn::TensorView& output,
                   nn::Workspace& workspace) const;

  std::vector<Block> blocks_;
  Output output_;
};

}  // namespace ps::models
