// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/resample.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "libps/core/error.h"
#include "libps/nn/indirect_product.h"
#include "libps/nn/kernels/kernels.h"
#include "libps/nn/pixel_loop.h"

namespace ps::nn {
namespace {

/// Calls row(image, y) for all rows of `out`, on all threads.
template <class Row>
void for_rows(const TensorView& out, const Row& row) {
  const Shape& s = out.shape;
  if (s.pixels() == 0 || s.channels == 0) return;
  const auto height = static_cast<std::size_t>(s.height);
  const std::size_t floats =
      static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.channels);
  for_ranges(static_cast<std::size_t>(s.images) * height, floats,
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i) {
                 row(static_cast<int>(i / height), static_cast<int>(i % height));
               }
             });
}

/// The pixels [begin, end) of a line that a window touches.
struct Range {
  int begin, end;
};
Range window(int at, int size, const MaxPool& pool) {
  const int begin = at * pool.stride - pool.padding;
  return {std::max(0, begin), std::min(size, begin + pool.kernel)};
}

/// out = in of the window's first pixel, then combine(in, out) with each of the others.
template <class Combine>
void pool_window(const TensorView& in, int image, Range ys, Range xs, float* out,
                 const Combine& combine) {
  const auto bytes = static_cast<std::size_t>(in.shape.channels) * sizeof(float);
  std::memcpy(out, in.pixel(image, ys.begin, xs.begin), bytes);
  for (int y = ys.begin; y < ys.end; ++y) {
    for (int x = xs.begin; x < xs.end; ++x) {
      if (y != ys.begin || x != xs.begin) combine(in.pixel(image, y, x), out);
    }
  }
}

void check_pool(const MaxPool& p) {
  if (p.kernel < 1 || p.stride < 1 || p.padding < 0 || p.padding > p.kernel / 2) {
    throw Error("max pooling",
                "a kernel of " + std::to_string(p.kernel) + ", a stride of " +
                    std::to_string(p.stride) + " and a padding of " + std::to_string(p.padding),
                "kernel and stride at least 1, padding at most half the kernel");
  }
}

int pooled_size(int size, const MaxPool& p) {
  const int room = size + 2 * p.padding - p.kernel + (p.ceil ? p.stride - 1 : 0);
  if (size < 1 || room < 0) return 0;
  const int count = room / p.stride + 1;
  return (count - 1) * p.stride >= size + p.padding ? count - 1 : count;
}

/// One row between two rows: 1/4 of `far` and 3/4 of `near`.
void mix_rows(const TensorView& in, const float* far, const float* near, float* out) {
  const auto mix = kernels().mix;
  const auto channels = static_cast<std::size_t>(in.shape.channels);
  const auto width = static_cast<std::size_t>(in.shape.width);
  if (in.stride == channels) return mix(far, near, 0.25f, 0.75f, out, width * channels);
  for (std::size_t x = 0; x < width; ++x) {
    mix(far + x * in.stride, near + x * in.stride, 0.25f, 0.75f, out + x * channels, channels);
  }
}

}  // namespace

void upsample_bilinear_2x(const TensorView& in, const TensorView& out) {
  const Shape& s = in.shape;
  check_same(out.shape, {s.images, 2 * s.height, 2 * s.width, s.channels}, "upsampling");
  const auto mix = kernels().mix;
  const auto channels = static_cast<std::size_t>(s.channels);
  for_rows(out, [&](int image, int y) {
    thread_local std::vector<float> row;
    const std::size_t floats = static_cast<std::size_t>(s.width) * channels;
    if (row.size() < floats) row.resize(floats);
    const int near = y / 2, far = std::clamp(y % 2 ? near + 1 : near - 1, 0, s.height - 1);
    mix_rows(in, in.pixel(image, far, 0), in.pixel(image, near, 0), row.data());
    for (int x = 0; x < s.width; ++x) {
      const auto at = [&](int i) {
        return row.data() + static_cast<std::size_t>(std::clamp(i, 0, s.width - 1)) * channels;
      };
      mix(at(x - 1), at(x), 0.25f, 0.75f, out.pixel(image, y, 2 * x), channels);
      mix(at(x + 1), at(x), 0.25f, 0.75f, out.pixel(image, y, 2 * x + 1), channels);
    }
  });
}

Shape half_size(const Shape& in) {
  return {in.images, (in.height + 1) / 2, (in.width + 1) / 2, in.channels};
}

void average_pool(const TensorView& in, const TensorView& out, bool count_padding) {
  check_same(out.shape, half_size(in.shape), "average pooling");
  constexpr MaxPool kWindow = {3, 2, 1};
  const auto add = kernels().add;
  const auto channels = static_cast<std::size_t>(in.shape.channels);
  for_rows(out, [&](int image, int y) {
    const Range ys = window(y, in.shape.height, kWindow);
    for (int x = 0; x < out.shape.width; ++x) {
      const Range xs = window(x, in.shape.width, kWindow);
      float* sum = out.pixel(image, y, x);
      pool_window(in, image, ys, xs, sum,
                  [&](const float* v, float* total) { add(v, total, total, channels, 1); });
      const int inside = (ys.end - ys.begin) * (xs.end - xs.begin);
      const float scale = 1.0f / static_cast<float>(count_padding ? 9 : inside);
      for (std::size_t c = 0; c < channels; ++c) sum[c] *= scale;
    }
  });
}

Shape pooled_size(const Shape& in, const MaxPool& pool) {
  check_pool(pool);
  return {in.images, pooled_size(in.height, pool), pooled_size(in.width, pool), in.channels};
}

void max_pool(const TensorView& in, const TensorView& out, const MaxPool& pool) {
  check_same(out.shape, pooled_size(in.shape, pool), "max pooling");
  const auto maximum = kernels().maximum;
  const auto channels = static_cast<std::size_t>(in.shape.channels);
  for_rows(out, [&](int image, int y) {
    const Range ys = window(y, in.shape.height, pool);
    for (int x = 0; x < out.shape.width; ++x) {
      pool_window(in, image, ys, window(x, in.shape.width, pool), out.pixel(image, y, x),
                  [&](const float* v, float* most) { maximum(v, most, most, channels); });
    }
  });
}

void global_average(const TensorView& in, const TensorView& out) {
  const Shape& s = in.shape;
  check_same(out.shape, {s.images, 1, 1, s.channels}, "global average");
  for_channel_blocks(in, [&](const TensorView& part, int image, int first) {
    double mean[kChannelBlock];
    channel_means(part, mean);
    std::copy_n(mean, part.shape.channels, out.pixel(image, 0, 0) + first);
  });
}

}  // namespace ps::nn
