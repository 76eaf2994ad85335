// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/packed_matrix.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "libps/core/error.h"
#include "libps/nn/kernels/kernels.h"

namespace ps::nn {
namespace {

static_assert(PackedMatrix::kRows == kTileRows);

std::uint16_t to_bf16(float value) {  // to nearest, ties to even
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return static_cast<std::uint16_t>((bits + 0x7fff + (bits >> 16 & 1)) >> 16);
}

int up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

const float* from(const float* values, int first) { return values ? values + first : nullptr; }

}  // namespace

PackedMatrix::PackedMatrix(int taps, int depth, int columns,
                           const std::function<float(int, int, int)>& value, Storage storage)
    : taps_(taps), depth_(depth), columns_(columns), storage_(storage), kernels_(&kernels()) {
  if (taps < 0 || depth < 0 || columns < 0) {
    throw Error("matrix", "a negative size", "0 or more of taps, rows and columns");
  }
  const int width = kernels_->vector_width, vectors = up(columns, width) / width;
  panels_ = (vectors + kernels_->most_vectors - 1) / kernels_->most_vectors;
  panel_ = panels_ ? (vectors + panels_ - 1) / panels_ * width : 0;
  count_ = rows() * static_cast<std::size_t>(up(columns, width));
  values_ = aligned_floats(storage == Storage::f32 ? count_ : (count_ + 1) / 2);
  zeros_ = aligned_floats(rows());
  std::fill_n(zeros_.get(), rows(), 0.0f);
  auto* halves = reinterpret_cast<std::uint16_t*>(values_.get());
  std::size_t at = 0;
  for (int first = 0; first < columns; first += panel_) {
    const int padded = std::min(panel_, up(columns - first, width));
    for (int tap = 0; tap < taps; ++tap) {
      for (int row = 0; row < depth; ++row) {
        for (int i = first; i < first + padded; ++i, ++at) {
          const float v = i < columns ? value(tap, row, i) : 0;
          if (storage == Storage::f32) {
            values_[at] = v;
          } else {
            halves[at] = to_bf16(v);
          }
        }
      }
    }
  }
}

std::size_t PackedMatrix::bytes() const {
  return count_ * (storage_ == Storage::f32 ? sizeof(float) : sizeof(std::uint16_t));
}

void PackedMatrix::multiply(const Tile& tile, int cut, const Epilogue& epilogue, int first_panel,
                            int last_panel) const {
  const bool f32 = storage_ == Storage::f32;
  const std::size_t panel_values = rows() * static_cast<std::size_t>(panel_);
  TileJob job = {};
  job.rows = tile.rows;
  job.tap_index = tile.tap_index;
  job.taps = tile.taps;
  job.depth = cut ? taps_ * depth_ / cut : 0;
  job.count = tile.count;
  job.out = tile.out;
  job.residual = tile.residual;
  job.slope = epilogue.activation.slope;
  for (int panel = first_panel; panel < last_panel; ++panel) {
    const std::size_t at = panel_values * static_cast<std::size_t>(panel);
    job.weights = f32 ? static_cast<const void*>(values_.get() + at)
                      : reinterpret_cast<const std::uint16_t*>(values_.get()) + at;
    job.first_column = panel * panel_;
    job.columns = std::min(panel_, columns_ - job.first_column);
    job.bias = from(epilogue.bias, job.first_column);
    job.scale = from(epilogue.scale, job.first_column);
    job.shift = from(epilogue.shift, job.first_column);
    (f32 ? kernels_->tile : kernels_->tile_bf16)(job);
  }
}

}  // namespace ps::nn
