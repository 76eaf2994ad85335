// SPDX-License-Identifier: BSD-3-Clause
// Internal to the nn room: shapes checked, and pixels taken in ranges, for operators without
// weights.
#pragma once

#include <algorithm>
#include <cstddef>

#include "libps/core/parallel.h"
#include "libps/nn/tensor.h"

namespace ps::nn {

/// @brief Calls body(begin, end) for ranges of [0, count) that depend on nothing but the count and
/// on how many floats one item is; little work stays on the calling thread, as a parallel loop
/// costs 10 us.
template <class Body>
void for_ranges(std::size_t count, std::size_t floats_each, const Body& body) {
  constexpr std::size_t kFloats = 1 << 15;
  const std::size_t range =
      std::max<std::size_t>(1, kFloats / std::max<std::size_t>(1, floats_each));
  if (count <= range) {
    if (count > 0) body(std::size_t{0}, count);
  } else {
    parallel_chunks(count, range, body);
  }
}

/// @brief Calls run(pointers..., count) for runs of floats that cover all views, which have one
/// shape: a range of pixels where all views are dense, else a pixel.
template <class Run, class... Views>
void for_runs(const Run& run, const TensorView& first, const Views&... others) {
  const auto channels = static_cast<std::size_t>(first.shape.channels);
  if (channels == 0) return;
  const bool dense = first.stride == channels && (true && ... && (others.stride == channels));
  for_ranges(first.shape.pixels(), channels, [&](std::size_t begin, std::size_t end) {
    if (dense) {
      run(first.pixel(begin), others.pixel(begin)..., (end - begin) * channels);
    } else {
      for (std::size_t i = begin; i < end; ++i) run(first.pixel(i), others.pixel(i)..., channels);
    }
  });
}

constexpr int kChannelBlock = 16;  ///< channels that one thread takes: a cache line of each pixel

/// @brief Calls body(part, image, first) for each image and up to kChannelBlock channels from
/// `first` on, where `part` is the view of just these.
template <class Body>
void for_channel_blocks(const TensorView& in, const Body& body) {
  if (in.shape.images == 0) return;
  const auto blocks =
      static_cast<std::size_t>((in.shape.channels + kChannelBlock - 1) / kChannelBlock);
  const auto images = static_cast<std::size_t>(in.shape.images);
  for_ranges(images * blocks, in.shape.pixels() / images * kChannelBlock,
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) {
                 const auto image = static_cast<int>(i / blocks);
                 const auto first = static_cast<int>(i % blocks) * kChannelBlock;
                 const int count = std::min(kChannelBlock, in.shape.channels - first);
                 body(in.images(image, 1).channels(first, count), image, first);
               }
             });
}

/// @brief The means of up to kChannelBlock channels, summed in the order of the pixels.
inline void channel_means(const TensorView& part, double* mean) {
  const std::size_t pixels = part.shape.pixels();
  const int channels = part.shape.channels;
  double sum[kChannelBlock] = {};
  for (std::size_t i = 0; i < pixels; ++i) {
    const float* x = part.pixel(i);
    for (int c = 0; c < channels; ++c) sum[c] += x[c];
  }
  for (int c = 0; c < channels; ++c) mean[c] = sum[c] / static_cast<double>(pixels);
}

/// @brief step(result, x) along a pixel's channels, in eight chains so that none waits for itself,
/// which are then joined in order: the same wherever the pixel stands.
template <class T, class Step, class Join>
T folded(const float* x, int channels, T first, const Step& step, const Join& join) {
  constexpr int kChains = 8;
  T chains[kChains];
  std::fill_n(chains, kChains, first);
  int c = 0;
  for (; c + kChains <= channels; c += kChains) {
    for (int i = 0; i < kChains; ++i) chains[i] = step(chains[i], x[c + i]);
  }
  for (int i = 0; c < channels; ++c, ++i) chains[i] = step(chains[i], x[c]);
  T result = first;
  for (const T& chain : chains) result = join(result, chain);
  return result;
}

}  // namespace ps::nn
