// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/winograd.h"

#include <algorithm>
#include <array>

#include "libps/core/parallel.h"
#include "libps/nn/kernels/kernels.h"
#include "libps/nn/winograd_points.h"

namespace ps::nn {
namespace {

constexpr int kProducts = 36;
constexpr int kSide = 4;                      ///< of a block of outputs
constexpr std::size_t kScratch = 640 * 1024;  ///< floats that a thread holds between the transforms
constexpr std::size_t kMostBlocks = 96;

using Row = std::array<double, 3>;

/// The transform of weights: rows of G in Lavin and Gray's words, for the points of this file.
std::array<Row, 6> weight_transform() {
  const double a = kWinogradA, b = kWinogradB, a2 = a * a, b2 = b * b;
  const double na = 2 * a2 * (a2 - b2), nb = 2 * b2 * (b2 - a2);
  return {{{1 / (a2 * b2), 0, 0},
           {1 / na, a / na, a2 / na},
           {1 / na, -a / na, a2 / na},
           {1 / nb, b / nb, b2 / nb},
           {1 / nb, -b / nb, b2 / nb},
           {0, 0, 1}}};
}

double transformed(const float* kernel, const Row& y, const Row& x) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum += y[i] * x[j] * kernel[3 * i + j];
  }
  return sum;
}

/// One convolution: what its blocks of 4x4 outputs share.
class Run {
 public:
  Run(const WinogradWeights& weights, const TensorView& in, int padding, const TensorView& out,
      const Epilogue& epilogue, const Prologue& prologue)
      : weights_(weights),
        in_(in),
        out_(out),
        epilogue_(epilogue),
        prologue_(prologue),
        padding_(padding),
        columns_((out.shape.width + kSide - 1) / kSide),
        rows_((out.shape.height + kSide - 1) / kSide) {
    const auto channels = static_cast<std::size_t>(in.shape.channels + out.shape.channels);
    group_ = kScratch / (kProducts * std::max<std::size_t>(channels, 1));
    group_ = std::min(std::max<std::size_t>(group_, 12), kMostBlocks) / PackedMatrix::kRows *
             PackedMatrix::kRows;
  }

  void operator()() const {
    const std::size_t blocks = static_cast<std::size_t>(out_.shape.images) *
                               static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
    parallel_chunks(blocks, group_, [this](std::size_t begin, std::size_t end) {
      thread_local Scratch scratch;
      const std::size_t in_step = group_ * static_cast<std::size_t>(in_.shape.channels) + kSkew;
      const std::size_t out_step = group_ * static_cast<std::size_t>(out_.shape.channels) + kSkew;
      float* transformed = scratch.take(kProducts * (in_step + out_step));
      float* products = transformed + kProducts * in_step;
      for (std::size_t i = begin; i < end; ++i) read_block(i, i - begin, transformed, in_step);
      multiply(transformed, in_step, products, out_step, end - begin);
      for (std::size_t i = begin; i < end; ++i) write_block(i, i - begin, products, out_step);
    });
  }

 private:
  /// So that the 36 values of a channel do not fall on one set of the cache.
  static constexpr std::size_t kSkew = 16;

  struct Scratch {
    AlignedFloats memory;
    std::size_t size = 0;
    float* take(std::size_t count) {
      if (count > size) {
        memory = aligned_floats(count);
        size = count;
      }
      return memory.get();
    }
  };

  struct Place {
    int image, y, x;  ///< of the block's first output
  };
  Place place(std::size_t block) const {
    const auto index = static_cast<int>(block);
    return {index / (rows_ * columns_), index / columns_ % rows_ * kSide, index % columns_ * kSide};
  }

  void read_block(std::size_t block, std::size_t slot, float* to, std::size_t step) const {
    const Place at = place(block);
    const float* pixels[kProducts];
    for (int i = 0; i < kProducts; ++i) {
      const int y = at.y - padding_ + i / 6, x = at.x - padding_ + i % 6;
      const bool inside = y >= 0 && y < in_.shape.height && x >= 0 && x < in_.shape.width;
      pixels[i] = inside ? in_.pixel(at.image, y, x) : nullptr;
    }
    const int channels = in_.shape.channels;
    kernels().winograd_input({pixels, prologue_.scale, prologue_.shift,
                              to + slot * static_cast<std::size_t>(channels), step, channels});
  }

  void multiply(const float* from, std::size_t in_step, float* to, std::size_t out_step,
                std::size_t blocks) const {
    constexpr std::size_t kRows = PackedMatrix::kRows;
    const auto in = static_cast<std::size_t>(in_.shape.channels),
               out = static_cast<std::size_t>(out_.shape.channels);
    for (std::size_t product = 0; product < kProducts; ++product) {
      const PackedMatrix& matrix = weights_.products[product];
      for (int panel = 0; panel < matrix.panels(); ++panel) {
        for (std::size_t first = 0; first < blocks; first += kRows) {
          const std::size_t count = std::min(kRows, blocks - first);
          const float* rows[kRows];
          float* results[kRows];
          for (std::size_t i = 0; i < count; ++i) {
            rows[i] = from + product * in_step + (first + i) * in;
            results[i] = to + product * out_step + (first + i) * out;
          }
          matrix.multiply(
              {rows, &PackedMatrix::kOnlyTap, 1, static_cast<int>(count), results, nullptr}, 1, {},
              panel, panel + 1);
        }
      }
    }
  }

  void write_block(std::size_t block, std::size_t slot, const float* from, std::size_t step) const {
    const Place at = place(block);
    float* pixels[kSide * kSide];
    const float* residuals[kSide * kSide];
    for (int i = 0; i < kSide * kSide; ++i) {
      const int y = at.y + i / kSide, x = at.x + i % kSide;
      const bool inside = y < out_.shape.height && x < out_.shape.width;
      pixels[i] = inside ? out_.pixel(at.image, y, x) : nullptr;
      residuals[i] =
          inside && epilogue_.residual ? epilogue_.residual->pixel(at.image, y, x) : nullptr;
    }
    const int channels = out_.shape.channels;
    kernels().winograd_output({from + slot * static_cast<std::size_t>(channels), step, pixels,
                               epilogue_.residual ? residuals : nullptr, epilogue_.bias,
                               epilogue_.scale, epilogue_.shift, epilogue_.activation.slope,
                               channels});
  }

  const WinogradWeights& weights_;
  const TensorView& in_;
  const TensorView& out_;
  const Epilogue& epilogue_;
  const Prologue& prologue_;
  int padding_, columns_, rows_;
  std::size_t group_ = 0;  ///< blocks that a thread transforms, multiplies and transforms back
};

}  // namespace

std::unique_ptr<WinogradWeights> winograd_weights(const WeightTensor& weight, Storage storage) {
  const std::array<Row, 6> transform = weight_transform();
  const auto out = static_cast<int>(weight.shape[0]), in = static_cast<int>(weight.shape[1]);
  auto weights = std::make_unique<WinogradWeights>();
  for (std::size_t i = 0; i < kProducts; ++i) {
    weights->products.emplace_back(
        1, in, out,
        [&](int, int row, int column) {
          const auto kernel =
              static_cast<std::size_t>(column) * weight.shape[1] + static_cast<std::size_t>(row);
          return static_cast<float>(
              transformed(weight.values.data() + 9 * kernel, transform[i / 6], transform[i % 6]));
        },
        storage);
  }
  return weights;
}

void winograd_convolution(const WinogradWeights& weights, const TensorView& in, int padding,
                          const TensorView& out, const Epilogue& epilogue,
                          const Prologue& prologue) {
  Run(weights, in, padding, out, epilogue, prologue)();
}

}  // namespace ps::nn
