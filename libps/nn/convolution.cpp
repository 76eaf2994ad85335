// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/convolution.h"

#include <algorithm>

#include "libps/core/error.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/indirect_product.h"
#include "libps/nn/winograd.h"

namespace ps::nn {
namespace {

constexpr int kFewChannels = 8;               ///< up to so many, patches are copied into rows
constexpr int kWinogradChannels = 16;         ///< fewer do not pay for the transforms
constexpr std::size_t kWinogradPixels = 256;  ///< of an output image; nor do fewer of these

/// The patches of output pixels, in their order.
class Patches {
 public:
  Patches(const TensorView& in, const Shape& out, int kernel, const ConvolutionOptions& options)
      : in_(in), out_(out), kernel_(kernel), options_(options) {}

  /// Sets a pointer for each tap of pixels [begin, end); null outside the image.
  void point(std::size_t begin, std::size_t end, const float** pointers) const {
    const int taps = kernel_ * kernel_;
    for_each_patch(begin, end, [&](std::size_t i, int image, int y0, int x0) {
      const float** to = pointers + slot_of(i, 0, taps);
      for (int ky = 0; ky < kernel_; ++ky) {
        const int y = y0 + ky * options_.dilation;
        const bool row_inside = y >= 0 && y < in_.shape.height;
        for (int kx = 0; kx < kernel_; ++kx, to += PackedMatrix::kRows) {
          const int x = x0 + kx * options_.dilation;
          *to = row_inside && x >= 0 && x < in_.shape.width ? in_.pixel(image, y, x) : nullptr;
        }
      }
    });
  }

  /// Whether the pixels that a line of the kernel covers lie behind each other.
  bool in_lines() const {
    return options_.dilation == 1 && in_.stride == static_cast<std::size_t>(in_.shape.channels);
  }

  /// Sets a pointer for each line of the kernel; lines that reach outside are copied, with zeros
  /// there, into `copies`: room for kernel^2 * channels floats for each pixel.
  void point_to_lines(std::size_t begin, std::size_t end, float* copies,
                      const float** pointers) const {
    const int span = kernel_ * in_.shape.channels;
    for_each_patch(begin, end, [&](std::size_t i, int image, int y0, int x0) {
      const float** to = pointers + slot_of(i, 0, kernel_);
      const bool whole = x0 >= 0 && x0 + kernel_ <= in_.shape.width;
      for (int ky = 0; ky < kernel_; ++ky, to += PackedMatrix::kRows) {
        const int y = y0 + ky;
        if (y < 0 || y >= in_.shape.height) {
          *to = nullptr;
        } else if (whole) {
          *to = in_.pixel(image, y, x0);
        } else {
          copy_line(image, y, x0, copies);
          *to = copies;
          copies += span;
        }
      }
    });
  }

 private:
  /// Calls visit(index from begin, image, y, x of the patch's first pixel).
  template <class Visit>
  void for_each_patch(std::size_t begin, std::size_t end, const Visit& visit) const {
    const auto width = static_cast<std::size_t>(out_.width);
    auto x = static_cast<int>(begin % width);
    auto line = static_cast<int>(begin / width);
    for (std::size_t i = begin; i < end; ++i) {
      visit(i - begin, line / out_.height, line % out_.height * options_.stride - options_.padding,
            x * options_.stride - options_.padding);
      if (++x == out_.width) {
        x = 0;
        ++line;
      }
    }
  }

  void copy_line(int image, int y, int x0, float* to) const {
    const int channels = in_.shape.channels;
    for (int kx = 0; kx < kernel_; ++kx, to += channels) {
      const int x = x0 + kx;
      if (x >= 0 && x < in_.shape.width) {
        std::copy_n(in_.pixel(image, y, x), channels, to);
      } else {
        std::fill_n(to, channels, 0.0f);
      }
    }
  }

  const TensorView& in_;
  const Shape& out_;
  int kernel_;
  const ConvolutionOptions& options_;
};

void check(const WeightTensor& weight, const ConvolutionOptions& options) {
  const auto& s = weight.shape;
  if (s.size() != 4 || s[2] != s[3] || s[2] == 0 || weight.values.size() != weight.elements()) {
    throw Error("convolution", "weights of shape " + to_string(s), "[out, in, k, k]");
  }
  if (options.stride < 1 || options.dilation < 1 || options.padding < 0) {
    throw Error("convolution", "a stride, dilation or padding out of range", "at least 1, 1 and 0");
  }
}

}  // namespace

Convolution::Convolution(const WeightTensor& weight, std::vector<float> bias,
                         const ConvolutionOptions& options)
    : options_(options), bias_(std::move(bias)) {
  check(weight, options);
  out_ = static_cast<int>(weight.shape[0]);
  in_ = static_cast<int>(weight.shape[1]);
  kernel_ = static_cast<int>(weight.shape[2]);
  check_bias(bias_, weight.shape[0], "convolution");
  const int taps = kernel_ * kernel_;
  matrix_ = PackedMatrix(
      taps, in_, out_,
      [&](int tap, int row, int column) {
        const std::size_t at =
            static_cast<std::size_t>(column) * weight.shape[1] + static_cast<std::size_t>(row);
        return weight.values[at * static_cast<std::size_t>(taps) + static_cast<std::size_t>(tap)];
      },
      options.storage);
  const bool fits = kernel_ == 3 && options.stride == 1 && options.dilation == 1;
  const bool pays = in_ >= kWinogradChannels;
  if (fits && options.method != Method::direct && (pays || options.method == Method::winograd)) {
    winograd_ = winograd_weights(weight, options.storage);
  }
}

Convolution::~Convolution() = default;
Convolution::Convolution(Convolution&&) noexcept = default;
Convolution& Convolution::operator=(Convolution&&) noexcept = default;

Shape Convolution::output(const Shape& in) const {
  const int reach = options_.dilation * (kernel_ - 1) + 1;
  const auto size = [&](int length) {
    const int room = length + 2 * options_.padding - reach;
    return room < 0 ? 0 : room / options_.stride + 1;
  };
  return {in.images, size(in.height), size(in.width), out_};
}

std::size_t Convolution::bytes() const {
  std::size_t sum = matrix_.bytes();
  if (winograd_) {
    for (const PackedMatrix& matrix : winograd_->products) sum += matrix.bytes();
  }
  return sum;
}

void Convolution::operator()(const TensorView& in, const TensorView& out, Workspace& workspace,
                             const Epilogue& given, const Prologue& prologue) const {
  check_same(in.shape, {in.shape.images, in.shape.height, in.shape.width, in_}, "convolution");
  check_same(out.shape, output(in.shape), "convolution");
  const Epilogue epilogue = with_bias(given, bias_, out.shape, "convolution");
  const bool forced = options_.method == Method::winograd;
  if (winograd_ &&
      (forced || std::size_t{1} * out.shape.height * out.shape.width >= kWinogradPixels)) {
    winograd_convolution(*winograd_, in, options_.padding, out, epilogue, prologue);
  } else if (prologue.scale) {
    const Workspace::Scope scope(workspace);
    const TensorView ready = workspace.take(in.shape);
    scale_shift(in, prologue.scale, prologue.shift, ready, kRelu);
    direct(ready, out, epilogue);
  } else {
    direct(in, out, epilogue);
  }
}

void Convolution::direct(const TensorView& in, const TensorView& out,
                         const Epilogue& epilogue) const {
  const Patches patches(in, out.shape, kernel_, options_);
  IndirectRows rows;
  rows.count = out.shape.pixels();
  if (in_ <= kFewChannels && patches.in_lines()) {
    rows.taps = kernel_;
    rows.sources = [&](std::size_t begin, std::size_t end, const float** pointers) {
      thread_local std::vector<float> copies;
      const std::size_t floats = IndirectRows::kSlots * matrix_.rows();
      copies.resize(std::max(copies.size(), floats));
      patches.point_to_lines(begin, end, copies.data(), pointers);
    };
  } else {
    rows.taps = kernel_ * kernel_;
    rows.sources = [&](std::size_t begin, std::size_t end, const float** pointers) {
      patches.point(begin, end, pointers);
    };
  }
  indirect_product(matrix_, rows, out, epilogue);
}

}  // namespace ps::nn
