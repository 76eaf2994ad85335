// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/codebook.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include "libps/core/error.h"
#include "libps/nn/pixel_loop.h"

namespace ps::nn {
namespace {

void check_channels(const TensorView& view, int expected) {
  if (view.shape.channels != expected) {
    throw Error("codebook", std::to_string(view.shape.channels) + " channels",
                std::to_string(expected));
  }
}

}  // namespace

Codebook::Codebook(const WeightTensor& embed) {
  const std::size_t dimensions = embed.shape.size();
  if (dimensions != 2 || embed.elements() == 0 || embed.values.size() != embed.elements()) {
    throw Error("codebook", "embeddings of the shape " + to_string(embed.shape),
                "[channels, codes]");
  }
  channels_ = static_cast<int>(embed.shape[0]);
  size_ = static_cast<int>(embed.shape[1]);
  const auto at = [&](int channel, int code) {
    return embed.values[static_cast<std::size_t>(channel) * embed.shape[1] +
                        static_cast<std::size_t>(code)];
  };
  vectors_.reserve(embed.values.size());
  for (int code = 0; code < size_; ++code) {
    double square = 0;
    for (int c = 0; c < channels_; ++c) {
      vectors_.push_back(at(c, code));
      square += static_cast<double>(at(c, code)) * at(c, code);
    }
    squares_.push_back(static_cast<float>(square));
  }
  matrix_ =
      PackedMatrix(1, channels_, size_, [&](int, int c, int code) { return -2 * at(c, code); });
  spacing_ = median_spacing();
}

template <typename Each>
void Codebook::for_scores(const TensorView& in, const Each& each) const {
  check_channels(in, channels_);
  Epilogue epilogue;
  epilogue.bias = squares_.data();  // |x|^2 is the same for all codes
  const auto width = static_cast<std::size_t>(size_);
  for_ranges(in.shape.pixels(), width, [&](std::size_t begin, std::size_t end) {
    constexpr int kRows = PackedMatrix::kRows;
    thread_local std::vector<float> memory;
    if (memory.size() < kRows * width) memory.resize(kRows * width);
    const float* rows[kRows];
    float* scores[kRows];
    for (int r = 0; r < kRows; ++r) scores[r] = memory.data() + static_cast<std::size_t>(r) * width;
    for (std::size_t i = begin; i < end; i += kRows) {
      const int count = static_cast<int>(std::min<std::size_t>(kRows, end - i));
      for (int r = 0; r < count; ++r) rows[r] = in.pixel(i + static_cast<std::size_t>(r));
      matrix_.multiply({rows, &PackedMatrix::kOnlyTap, 1, count, scores, nullptr}, 1, epilogue, 0,
                       matrix_.panels());
      for (int r = 0; r < count; ++r) each(i + static_cast<std::size_t>(r), scores[r]);
    }
  });
}

void Codebook::nearest(const TensorView& in, std::int32_t* codes) const {
  for_scores(in, [&](std::size_t pixel, const float* scores) {
    codes[pixel] = static_cast<std::int32_t>(std::min_element(scores, scores + size_) - scores);
  });
}

void Codebook::excess(const TensorView& in, float* out) const {
  for_scores(in, [&](std::size_t pixel, const float* scores) {
    const float least = *std::min_element(scores, scores + size_);
    std::transform(scores, scores + size_, out + pixel * static_cast<std::size_t>(size_),
                   [least](float score) { return score - least; });
  });
}

float Codebook::median_spacing() {
  const auto width = static_cast<std::size_t>(size_);
  if (width < 2) return 0;
  std::vector<float> nearest(width);
  const TensorView codes = {
      vectors_.data(), {1, 1, size_, channels_}, static_cast<std::size_t>(channels_)};
  for_scores(codes, [&](std::size_t code, const float* scores) {
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < width; ++k) {
      if (k != code) least = std::min(least, scores[k]);
    }
    nearest[code] = std::max(0.f, least + squares_[code]);
  });
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(width / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

void Codebook::embed(const std::int32_t* codes, const TensorView& out) const {
  check_channels(out, channels_);
  const auto width = static_cast<std::size_t>(channels_);
  for_ranges(out.shape.pixels(), width, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (codes[i] < 0 || codes[i] >= size_) {
        throw Error("codebook", "the code " + std::to_string(codes[i]),
                    "0 to " + std::to_string(size_ - 1));
      }
      const float* vector = vectors_.data() + static_cast<std::size_t>(codes[i]) * width;
      std::memcpy(out.pixel(i), vector, width * sizeof(float));
    }
  });
}

}  // namespace ps::nn
