// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/examples.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "libps/core/random.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/splat.h"
#include "libps/outpaint/order.h"

namespace ps::train {
namespace {

/// An upright square of a view, resized to kSide.
View square_of(const View& view, const cv::Rect& square) {
  View part;
  const double scale = static_cast<double>(kSide) / square.width;
  cv::resize(view.color(square), part.color, {kSide, kSide}, 0, 0, cv::INTER_AREA);
  cv::resize(view.depth(square), part.depth, {kSide, kSide}, 0, 0, cv::INTER_NEAREST);
  Intrinsics lens = view.intrinsics;
  lens.cx -= square.x;
  lens.cy -= square.y;
  lens.width = lens.height = square.width;
  part.intrinsics = resized(lens, kSide, kSide);
  part.intrinsics.fx = lens.fx * scale;
  part.world_from_cam = view.world_from_cam;
  return part;
}

cv::Rect random_square(const View& view, std::uint64_t seed, std::uint32_t which) {
  const int width = view.color.cols, height = view.color.rows, shorter = std::min(width, height);
  const auto unit = [&](std::uint32_t i) { return random_unit(seed, {which, i, 0x63u, 0}); };
  const int side = std::clamp(static_cast<int>(shorter * (.6 + .45 * unit(0))), 1, shorter);
  const auto at = [&](int room, double u) { return static_cast<int>(u * (room + 1)); };
  return {std::min(at(width - side, unit(1)), width - side),
          std::min(at(height - side, unit(2)), height - side), side, side};
}

ExamplePair::Half half_of(const View& view) { return {view.color, view.depth, view.intrinsics}; }

/// As to_byte(), in a loop that becomes vectors.
void to_bytes(const float* __restrict colors, int count, unsigned char* __restrict bytes) {
  for (int i = 0; i < count; ++i) {
    const float positive = colors[i] > 0 ? colors[i] : 0;
    const float scaled = (positive < 1 ? positive : 1) * 255;
    const int whole = static_cast<int>(scaled);
    bytes[i] = static_cast<unsigned char>(whole + (scaled - static_cast<float>(whole) >= .5f));
  }
}

void append_bytes(FileTensor& tensor, const Image& image) {
  const std::size_t start = tensor.bytes.size(), row = 3 * static_cast<std::size_t>(image.cols);
  tensor.bytes.resize(start + row * static_cast<std::size_t>(image.rows));
  auto* bytes = reinterpret_cast<unsigned char*>(tensor.bytes.data() + start);
  for (int y = 0; y < image.rows; ++y, bytes += row) {
    to_bytes(image[y]->val, 3 * image.cols, bytes);
  }
}

void append_raw(FileTensor& tensor, const void* data, std::size_t bytes) {
  const auto* from = static_cast<const std::byte*>(data);
  tensor.bytes.insert(tensor.bytes.end(), from, from + bytes);
}

void append_floats(FileTensor& tensor, const std::vector<double>& values) {
  for (const double value : values) {
    const float narrow = static_cast<float>(value);
    append_raw(tensor, &narrow, sizeof narrow);
  }
}

void append_pose(FileTensor& tensor, const Pose& pose) {
  for (int i = 0; i < 12; ++i) append_floats(tensor, {pose.matrix()(i / 4, i % 4)});
}

void append_half(TensorMap& shard, const ExamplePair::Half& half, unsigned char kind) {
  append_bytes(shard["color"], half.color);
  const Intrinsics& lens = half.lens;
  const double focal = std::sqrt(lens.fx * lens.fy);
  cv::Mat canonical;
  Depth metres = half.depth * (kSide / focal);
  metres.setTo(0, metres > 6e4);  // what a half float cannot hold
  metres.convertTo(canonical, CV_16F);
  append_raw(shard["depth"], canonical.data, canonical.total() * 2);
  append_floats(shard["focal"], {focal / kSide});
  append_floats(shard["lens"], {lens.fx, lens.fy, lens.cx, lens.cy});
  append_raw(shard["kind"], &kind, 1);
}

}  // namespace

ExamplePair example_pair(const View& first, const View& second, const View& source) {
  ExamplePair pair;
  pair.first = half_of(first);
  pair.second = half_of(second);
  pair.first_from_second = first.world_from_cam.inverse() * second.world_from_cam;
  SplatOptions options;
  options.background = {.5f, .5f, .5f};
  const Splat seen = splat(lift(source), second.intrinsics, second.world_from_cam, options);
  pair.splat = seen.color;
  pair.flags = seen.hit * kHit + seen.missing * kMissing;
  pair.order = outpaint::order_of(seen.missing).cells;
  return pair;
}

ExamplePair frame_pair(const View& first, const View& second, std::uint64_t seed) {
  return example_pair(square_of(first, random_square(first, seed, 0)),
                      square_of(second, random_square(second, seed, 1)), first);
}

TensorMap to_shard(const std::vector<ExamplePair>& pairs) {
  const std::size_t n = pairs.size(), s = kSide;
  TensorMap shard;
  const std::size_t cells = pairs.empty() ? 0 : pairs.front().order.size();
  shard["color"] = {"U8", {2 * n, s, s, 3}, {}};
  shard["depth"] = {"F16", {2 * n, s, s}, {}};
  shard["focal"] = {"F32", {2 * n}, {}};
  shard["kind"] = {"U8", {2 * n}, {}};
  shard["splat"] = {"U8", {n, s, s, 3}, {}};
  shard["flags"] = {"U8", {n, s, s}, {}};
  shard["order"] = {"I32", {n, cells}, {}};
  shard["lens"] = {"F32", {2 * n, 4}, {}};
  shard["pose"] = {"F32", {n, 12}, {}};
  for (const ExamplePair& pair : pairs) {
    append_half(shard, pair.first, pair.kind);
    append_half(shard, pair.second, pair.kind);
    append_bytes(shard["splat"], pair.splat);
    append_raw(shard["flags"], pair.flags.data, pair.flags.total());
    append_pose(shard["pose"], pair.first_from_second);
    append_raw(shard["order"], pair.order.data(), cells * sizeof(int));
  }
  return shard;
}

}  // namespace ps::train
