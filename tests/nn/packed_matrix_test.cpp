// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/packed_matrix.h"

#include <gtest/gtest.h>

#include <numeric>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

constexpr int kRows = PackedMatrix::kRows;

/// Rows of `taps` pieces each, that lie scattered, and the matrix they are multiplied with.
struct Product {
  Product(Random& random, int taps_, int depth_, int columns_)
      : taps(taps_),
        depth(depth_),
        columns(columns_),
        weights(random.weights({taps, depth, columns})),
        values(random.reals(static_cast<std::size_t>(kRows * taps * depth + 1))) {}

  PackedMatrix packed(Storage storage = Storage::f32) const {
    return PackedMatrix(
        taps, depth, columns, [&](int t, int i, int c) { return weight(t, i, c); }, storage);
  }
  float weight(int tap, int row, int column) const {
    return weights.values[static_cast<std::size_t>((tap * depth + row) * columns + column)];
  }
  const float* piece(int tap, int row) const {
    return values.data() + static_cast<std::size_t>((tap * kRows + row) * depth);
  }
  /// Multiplies rows [first, first + count), panels one by one in any order.
  std::vector<float> run(const PackedMatrix& matrix, int first, int count) const {
    std::vector<const float*> rows(static_cast<std::size_t>(std::max(1, taps) * kRows));
    for (int t = 0; t < taps; ++t) {
      for (int r = 0; r < count; ++r)
        rows[static_cast<std::size_t>(t * kRows + r)] = piece(t, first + r);
    }
    std::vector<float> out(static_cast<std::size_t>(count * columns) + 1, 12345.0f);
    std::vector<int> order(static_cast<std::size_t>(taps));
    std::iota(order.begin(), order.end(), 0);
    std::vector<float*> places;
    for (int r = 0; r < count; ++r) places.push_back(out.data() + r * columns);
    for (int panel = matrix.panels() - 1; panel >= 0; --panel) {
      matrix.multiply({rows.data(), order.data(), taps, count, places.data(), nullptr}, taps, {},
                      panel, panel + 1);
    }
    EXPECT_EQ(out.back(), 12345.0f) << "written behind the last column";
    out.pop_back();
    return out;
  }

  int taps, depth, columns;
  WeightTensor weights;
  std::vector<float> values;
};

TEST(PackedMatrix, multiplies_as_the_sum_over_taps_and_depth) {
  Random random(101);
  for (int i = 0; i < 120; ++i) {
    const Product product(random, random.integer(0, 9), random.channels() * (i % 20 > 0),
                          random.channels() * (i % 19 > 0));
    on_every_isa([&] {
      const PackedMatrix matrix = product.packed();
      const int count = random.integer(1, kRows);
      const std::vector<float> out = product.run(matrix, 0, count);
      for (int r = 0; r < count; ++r) {
        for (int c = 0; c < product.columns; ++c) {
          double sum = 0;
          for (int t = 0; t < product.taps; ++t) {
            for (int d = 0; d < product.depth; ++d)
              sum += product.piece(t, r)[d] * product.weight(t, d, c);
          }
          EXPECT_NEAR(out[static_cast<std::size_t>(r * product.columns + c)], sum, 3e-5);
        }
      }
    });
  }
}

TEST(PackedMatrix, a_row_has_the_same_bytes_among_any_others) {
  Random random(102);
  for (const int columns : {1, 15, 64, 97, 200}) {
    const Product product(random, 9, 33, columns);
    for (const Storage storage : {Storage::f32, Storage::bf16}) {
      on_every_isa([&] {
        const PackedMatrix matrix = product.packed(storage);
        const std::vector<float> all = product.run(matrix, 0, kRows);
        for (int first = 0; first < kRows; ++first) {
          for (int count = 1; first + count <= kRows; ++count) {
            const std::vector<float> some = product.run(matrix, first, count);
            EXPECT_EQ(
                std::memcmp(some.data(), all.data() + first * columns, some.size() * sizeof(float)),
                0)
                << count << " rows from " << first;
          }
        }
      });
    }
  }
}

TEST(PackedMatrix, stays_with_the_instruction_set_it_was_packed_for) {
  Random random(103);
  const Product product(random, 1, 20, 70);
  for (const Storage storage : {Storage::f32, Storage::bf16}) {
    for (const Isa packed_for : available_isas()) {
      const auto packed = [&] {
        const UseIsa use(packed_for);
        return product.packed(storage);
      };
      const PackedMatrix matrix = packed();
      const std::vector<float> expected = product.run(matrix, 0, kRows);
      on_every_isa([&] { EXPECT_EQ(product.run(matrix, 0, kRows), expected); });
      EXPECT_NEAR(expected[0], product.run(product.packed(storage), 0, kRows)[0], 1e-5);
    }
  }
}

TEST(PackedMatrix, rounds_weights_to_the_nearest_bf16_ties_to_even) {
  for (const auto& [weight, rounded] :
       std::vector<std::pair<float, float>>{{1.0f, 1.0f},
                                            {0x1.01p0f, 0x1.00p0f},
                                            {0x1.03p0f, 0x1.04p0f},
                                            {0x1.011p0f, 0x1.02p0f},
                                            {-0x1.01p0f, -0x1.00p0f},
                                            {0x1.ffp-3f, 0x1.00p-2f}}) {
    on_every_isa([w = weight, r = rounded] {
      const PackedMatrix matrix(
          1, 1, 1, [&](int, int, int) { return w; }, Storage::bf16);
      const float one = 1;
      const float* rows[kRows] = {&one};
      float out = 0;
      float* place = &out;
      const int tap = 0;
      matrix.multiply({rows, &tap, 1, 1, &place, nullptr}, 1, {}, 0, 1);
      EXPECT_EQ(out, r);
    });
  }
}

TEST(PackedMatrix, refuses_negative_sizes) {
  const auto value = [](int, int, int) { return 0.0f; };
  EXPECT_THROW(PackedMatrix(-1, 1, 1, value), Error);
  EXPECT_THROW(PackedMatrix(1, -1, 1, value), Error);
  EXPECT_THROW(PackedMatrix(1, 1, -1, value), Error);
}

}  // namespace
}  // namespace ps::nn
