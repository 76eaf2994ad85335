// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace ps::nn {

/// How many images, of how many pixels and channels. Any of them may be 0.
struct Shape {
  int images = 1;
  int height = 1;
  int width = 1;
  int channels = 1;

  std::size_t pixels() const {
    return static_cast<std::size_t>(images) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(width);
  }
  bool operator==(const Shape& o) const {
    return images == o.images && height == o.height && width == o.width && channels == o.channels;
  }
  bool operator!=(const Shape& o) const { return !(*this == o); }
};

/// @brief Activations that somebody else owns, channels last: the channels of pixel (i, y, x) begin
/// at data + ((i * height + y) * width + x) * stride. A stride above `channels` makes this a slice
/// of a wider tensor, so that a concatenation of channels is never copied.
struct TensorView {
  float* data = nullptr;
  Shape shape;
  std::size_t stride = 0;  ///< floats from one pixel to the next, at least shape.channels

  float* pixel(std::size_t index) const { return data + index * stride; }
  float* pixel(int image, int y, int x) const {
    return pixel((static_cast<std::size_t>(image) * static_cast<std::size_t>(shape.height) +
                  static_cast<std::size_t>(y)) *
                     static_cast<std::size_t>(shape.width) +
                 static_cast<std::size_t>(x));
  }
  /// @return channels [first, first + count) of the same pixels
  TensorView channels(int first, int count) const;
  /// @return images [first, first + count)
  TensorView images(int first, int count) const;
};

struct FreeAligned {
  void operator()(float* p) const;
};
using AlignedFloats = std::unique_ptr<float[], FreeAligned>;

/// @return uninitialised floats, aligned to 64 bytes
AlignedFloats aligned_floats(std::size_t count);

/// @brief Activations with memory of their own, zero at first, aligned to 64 bytes, dense. One that
/// is made without a shape holds nothing.
class Tensor {
 public:
  Tensor() = default;
  explicit Tensor(Shape shape);

  const TensorView& view() const { return view_; }
  operator const TensorView&() const { return view_; }
  const Shape& shape() const { return view_.shape; }
  float* data() const { return view_.data; }

 private:
  AlignedFloats memory_;
  TensorView view_ = {nullptr, {0, 0, 0, 0}, 0};
};

/// @brief Scratch memory of a forward: a stack that grows in the first forward and is used again by
/// all later ones. Not for two threads at once.
class Workspace {
 public:
  /// What was taken since is given back at the end of the scope.
  class Scope {
   public:
    explicit Scope(Workspace& workspace);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Workspace& workspace_;
    std::size_t block_, used_;
  };

  /// @return a dense tensor, uninitialised, aligned to 64 bytes; stays where it is
  TensorView take(Shape shape);
  /// @return floats, uninitialised, aligned to 64 bytes
  float* take(std::size_t count);
  std::size_t bytes() const;  ///< held in all

 private:
  struct Block {
    AlignedFloats memory;
    std::size_t size = 0;
  };
  std::vector<Block> blocks_;
  std::size_t block_ = 0;  ///< the one in use
  std::size_t used_ = 0;   ///< floats of it
};

/// @brief From [images, channels, height, width] (torch's order), dense, to channels last.
void from_planes(const float* planes, const TensorView& out);

/// @brief From channels last to [images, channels, height, width], dense.
void to_planes(const TensorView& in, float* planes);

}  // namespace ps::nn
