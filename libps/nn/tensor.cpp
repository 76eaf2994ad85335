// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/tensor.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include "libps/core/error.h"

namespace ps::nn {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kFloats = kAlignment / sizeof(float);
constexpr std::size_t kSmallestBlock = std::size_t{1} << 16;

std::size_t aligned(std::size_t floats) { return (floats + kFloats - 1) / kFloats * kFloats; }

std::size_t values(const Shape& shape) {
  if (shape.images < 0 || shape.height < 0 || shape.width < 0 || shape.channels < 0) {
    throw Error("tensor", "a negative size", "0 or more");
  }
  constexpr double kMost = 1e15;  // far beyond any memory, and still exact in a size_t
  if (1.0 * shape.images * shape.height * shape.width * shape.channels > kMost) {
    throw Error("tensor", "more values than any machine holds", "a smaller size");
  }
  return shape.pixels() * static_cast<std::size_t>(shape.channels);
}

}  // namespace

TensorView TensorView::channels(int first, int count) const {
  if (first < 0 || count < 0 || first > shape.channels - count) {
    throw Error("tensor", "channels outside it",
                "a range within its " + std::to_string(shape.channels) + " channels");
  }
  TensorView part = *this;
  part.data += first;
  part.shape.channels = count;
  return part;
}

TensorView TensorView::images(int first, int count) const {
  if (first < 0 || count < 0 || first > shape.images - count) {
    throw Error("tensor", "images outside it",
                "a range within its " + std::to_string(shape.images) + " images");
  }
  TensorView part = *this;
  if (shape.images > 0) {
    part.data += shape.pixels() / static_cast<std::size_t>(shape.images) * stride *
                 static_cast<std::size_t>(first);
  }
  part.shape.images = count;
  return part;
}

void FreeAligned::operator()(float* p) const { std::free(p); }

AlignedFloats aligned_floats(std::size_t count) {
  const std::size_t bytes = aligned(std::max<std::size_t>(count, 1)) * sizeof(float);
  auto* p = static_cast<float*>(std::aligned_alloc(kAlignment, bytes));
  if (!p) throw std::bad_alloc();
  return AlignedFloats(p);
}

Tensor::Tensor(Shape shape) {
  const std::size_t count = values(shape);
  memory_ = aligned_floats(count);
  std::fill_n(memory_.get(), count, 0.0f);
  view_ = {memory_.get(), shape, static_cast<std::size_t>(shape.channels)};
}

Workspace::Scope::Scope(Workspace& workspace)
    : workspace_(workspace), block_(workspace.block_), used_(workspace.used_) {}

Workspace::Scope::~Scope() {
  workspace_.block_ = block_;
  workspace_.used_ = used_;
}

float* Workspace::take(std::size_t count) {
  const std::size_t floats = aligned(count);
  while (block_ < blocks_.size() && used_ + floats > blocks_[block_].size) {
    ++block_;
    used_ = 0;
  }
  if (block_ == blocks_.size()) {
    const std::size_t size = std::max(floats, kSmallestBlock);
    blocks_.push_back({aligned_floats(size), size});
  }
  float* p = blocks_[block_].memory.get() + used_;
  used_ += floats;
  return p;
}

TensorView Workspace::take(Shape shape) {
  return {take(values(shape)), shape, static_cast<std::size_t>(shape.channels)};
}

std::size_t Workspace::bytes() const {
  std::size_t sum = 0;
  for (const Block& block : blocks_) sum += block.size * sizeof(float);
  return sum;
}

void from_planes(const float* planes, const TensorView& out) {
  const Shape& s = out.shape;
  const std::size_t pixels = static_cast<std::size_t>(s.height) * static_cast<std::size_t>(s.width);
  for (int image = 0; image < s.images; ++image) {
    for (int c = 0; c < s.channels; ++c) {
      float* to = out.images(image, 1).data + c;
      for (std::size_t i = 0; i < pixels; ++i) to[i * out.stride] = *planes++;
    }
  }
}

void to_planes(const TensorView& in, float* planes) {
  const Shape& s = in.shape;
  const std::size_t pixels = static_cast<std::size_t>(s.height) * static_cast<std::size_t>(s.width);
  for (int image = 0; image < s.images; ++image) {
    for (int c = 0; c < s.channels; ++c) {
      const float* from = in.images(image, 1).data + c;
      for (std::size_t i = 0; i < pixels; ++i) *planes++ = from[i * in.stride];
    }
  }
}

}  // namespace ps::nn
