// SPDX-License-Identifier: BSD-3-Clause
// What the tests of this room share: reproducible random numbers, slices of wider tensors,
// comparisons.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "libps/nn/isa.h"
#include "libps/nn/packed_matrix.h"
#include "libps/nn/tensor.h"
#include "libps/nn/weights.h"
#include "tests/nn/reference.h"

namespace ps::nn {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  int integer(int least, int most) {
    return least + static_cast<int>(engine_() % static_cast<unsigned>(most - least + 1));
  }
  bool coin() { return integer(0, 1) == 1; }
  int pick(const std::vector<int>& of) {
    return of[static_cast<std::size_t>(integer(0, static_cast<int>(of.size()) - 1))];
  }
  float real(float least = -1, float most = 1) {
    return least + (most - least) * static_cast<float>(engine_() >> 8) * 0x1p-24f;
  }
  std::vector<float> reals(std::size_t count, float least = -1, float most = 1) {
    std::vector<float> values(count);
    for (float& v : values) v = real(least, most);
    return values;
  }
  WeightTensor weights(const std::vector<int>& shape) {
    WeightTensor tensor;
    std::size_t count = 1;
    for (const int n : shape) {
      tensor.shape.push_back(static_cast<std::size_t>(n));
      count *= static_cast<std::size_t>(n);
    }
    tensor.values = reals(count);
    return tensor;
  }
  /// Sizes around those at which vectors, tiles and blocks end.
  int channels() {
    return pick({1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 32, 33, 48, 63, 64, 65, 70});
  }
  int images() { return pick({1, 1, 2, 3}); }
  /// One in eight has nothing in it.
  Shape shape() { return shape(channels()); }
  Shape shape(int channels) {
    Shape s = {images(), integer(1, 11), integer(1, 11), channels};
    const int empty = integer(0, 31);
    if (empty == 0) s.images = 0;
    if (empty == 1) s.height = 0;
    if (empty == 2) s.width = 0;
    if (empty == 3) s.channels = 0;
    return s;
  }

 private:
  std::mt19937 engine_;
};

/// A tensor that is a slice of the channels of a wider one, the rest of which must stay as it is.
class Slice {
 public:
  /// @param margin  channels on each side; 0 = dense
  Slice(const Shape& shape, int margin) : margin_(margin), shape_(shape) {
    Shape wide = shape;
    wide.channels += 2 * margin;
    tensor_ = Tensor(wide);
    std::fill_n(tensor_.data(), wide.pixels() * static_cast<std::size_t>(wide.channels), kMark);
    view_ = tensor_.view().channels(margin, shape.channels);
  }
  Slice(const Shape& shape, int margin, Random& random, float least = -1, float most = 1)
      : Slice(shape, margin) {
    for (std::size_t i = 0; i < shape.pixels(); ++i) {
      for (int c = 0; c < shape.channels; ++c) view_.pixel(i)[c] = random.real(least, most);
    }
  }

  operator const TensorView&() const { return view_; }
  const TensorView& view() const { return view_; }
  const Shape& shape() const { return shape_; }

  bool margins_untouched() const {
    for (std::size_t i = 0; i < shape_.pixels(); ++i) {
      for (int c = 0; c < margin_; ++c) {
        if (view_.pixel(i)[-1 - c] != kMark || view_.pixel(i)[shape_.channels + c] != kMark) {
          return false;
        }
      }
    }
    return true;
  }

 private:
  static constexpr float kMark = 12345;
  int margin_;
  Shape shape_;
  Tensor tensor_;
  TensorView view_;
};

inline void copy(const TensorView& from, const TensorView& to) {
  for (std::size_t i = 0; i < from.shape.pixels(); ++i) {
    std::copy_n(from.pixel(i), from.shape.channels, to.pixel(i));
  }
}

/// An instruction set, for as long as this lives.
class UseIsa {
 public:
  explicit UseIsa(Isa isa) : before_(nn::isa()) { set_isa(isa); }
  ~UseIsa() { set_isa(before_); }
  UseIsa(const UseIsa&) = delete;
  UseIsa& operator=(const UseIsa&) = delete;

 private:
  Isa before_;
};

inline void on_every_isa(const std::function<void()>& test) {
  for (const Isa isa : available_isas()) {
    const UseIsa use(isa);
    SCOPED_TRACE(to_string(isa));
    test();
  }
}

inline std::string text(const Shape& s) {
  return std::to_string(s.images) + "x" + std::to_string(s.height) + "x" + std::to_string(s.width) +
         "x" + std::to_string(s.channels);
}

/// @brief Every value within `bound` times the largest expected one, or times 1 if that is more.
inline testing::AssertionResult near(const TensorView& view, const reference::Values& expected,
                                     double bound) {
  if (view.shape != expected.shape) {
    return testing::AssertionFailure()
           << text(view.shape) << " in place of " << text(expected.shape);
  }
  const reference::Values got(view);
  const double allowed = bound * std::max(1.0, expected.largest());
  double worst = -1;
  std::size_t where = 0;
  for (std::size_t i = 0; i < got.values.size(); ++i) {
    const double error = std::abs(got.values[i] - expected.values[i]);
    if (!(error <= worst)) {
      worst = error;
      where = i;
    }
    if (std::isnan(error)) break;
  }
  if (worst <= allowed) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << text(view.shape) << ": value " << where << " is " << got.values[where]
         << " in place of " << expected.values[where] << ", off by " << worst << "; allowed "
         << allowed;
}

/// @brief The same bytes of all values.
inline bool same_bytes(const TensorView& a, const TensorView& b) {
  if (a.shape != b.shape) return false;
  const std::size_t bytes = static_cast<std::size_t>(a.shape.channels) * sizeof(float);
  for (std::size_t i = 0; i < a.shape.pixels(); ++i) {
    if (std::memcmp(a.pixel(i), b.pixel(i), bytes) != 0) return false;
  }
  return true;
}

/// @return the weights as bf16 holds them: to nearest, ties to even
inline WeightTensor rounded_to_bf16(WeightTensor weight) {
  for (float& value : weight.values) {
    const double step = std::ldexp(1.0, std::ilogb(value == 0 ? 1 : value) - 7);
    value = static_cast<float>(std::nearbyint(value / step) * step);
  }
  return weight;
}

/// A random epilogue: what there is of it, and what it does to values.
class RandomEpilogue {
 public:
  /// @param out  becomes the residual itself, now and then
  RandomEpilogue(Random& random, const Slice& out, int margin)
      : residual_(out.shape(), margin, random) {
    const auto channels = static_cast<std::size_t>(out.shape().channels);
    if (random.coin()) {
      scale_ = random.reals(channels, 0.5f, 1.5f);
      shift_ = random.reals(channels);
      epilogue_.scale = scale_.data();
      epilogue_.shift = shift_.data();
    }
    if (random.coin()) {
      in_place_ = random.coin();
      expected_residual_ = reference::Values(residual_);
      epilogue_.residual = in_place_ ? &out.view() : &residual_.view();
    }
    epilogue_.activation.slope = random.coin() ? 1.0f : random.coin() ? 0.0f : 0.2f;
  }

  const Epilogue& epilogue() const { return epilogue_; }

  /// To be called before each run: puts the residual where it is read.
  void prepare(const TensorView& out) const {
    if (in_place_) copy(residual_, out);
  }

  reference::Values applied(reference::Values sum) const {
    if (epilogue_.scale) sum = reference::scale_shift(sum, scale_, shift_);
    if (epilogue_.residual) sum = reference::map(sum, expected_residual_, std::plus<>());
    return reference::activation(sum, epilogue_.activation.slope);
  }

 private:
  Slice residual_;
  reference::Values expected_residual_;
  std::vector<float> scale_, shift_;
  Epilogue epilogue_;
  bool in_place_ = false;
};

}  // namespace ps::nn
