// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/packed_matrix.h"

#include <gtest/gtest.h>

#include <numeric>

#include "libps/core/error.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

constexpr int kRows = PackedMatrix::kRows;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Rows of `taps` pieces each, that lie scattered, and the matrix they are multiplied with.
struct Product {
  Product(Random& random, int taps_, int depth_, int columns_)
      : taps(taps_),
        depth(depth_),
        columns(columns_),
        weights(random.weights({taps, depth, columns})),
        values(random.reals(index(kRows) * index(taps) * index(depth) + 1)) {}

  PackedMatrix packed(Storage storage = Storage::f32) const {
    const auto value = [&](int t, int i, int c) { return weight(t, i, c); };
    return PackedMatrix(taps, depth, columns, value, storage);
  }
  float weight(int tap, int row, int column) const {
    return weights.values[index((tap * depth + row) * columns + column)];
  }
  /// The pieces of a row lie behind each other.
  const float* piece(int tap, int row) const { return &values[index((row * taps + tap) * depth)]; }

  std::vector<int> all_taps() const {
    std::vector<int> which(index(taps));
    std::iota(which.begin(), which.end(), 0);
    return which;
  }
  /// Multiplies rows [first, first + count), panels one by one, with the pieces of these taps.
  std::vector<float> run(const PackedMatrix& matrix, int first, int count,
                         const std::vector<int>& which, int cut) const {
    std::vector<const float*> rows((which.size() + 1) * index(kRows));
    for (std::size_t t = 0; t < which.size(); ++t) {
      for (int r = 0; r < count; ++r)
        rows[t * index(kRows) + index(r)] = piece(which[t], first + r);
    }
    std::vector<float> out(index(count * columns) + 1, 12345.0f);
    float* places[kRows] = {};
    for (int r = 0; r < count; ++r) places[r] = &out[index(r * columns)];
    const auto given = static_cast<int>(which.size());
    for (int panel = matrix.panels() - 1; panel >= 0; --panel) {
      matrix.multiply({rows.data(), which.data(), given, count, places, nullptr}, cut, {}, panel,
                      panel + 1);
    }
    EXPECT_EQ(out.back(), 12345.0f) << "written behind the last column";
    out.pop_back();
    return out;
  }
  std::vector<float> run(const PackedMatrix& matrix, int first, int count) const {
    return run(matrix, first, count, all_taps(), taps);
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
          EXPECT_NEAR(out[index(r * product.columns + c)], sum, 3e-5);
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
                std::memcmp(some.data(), &all[index(first * columns)], some.size() * sizeof(float)),
                0)
                << count << " rows from " << first;
          }
        }
      });
    }
  }
}

TEST(PackedMatrix, a_tap_left_out_is_one_of_zeros) {
  Random random(104);
  for (const Storage storage : {Storage::f32, Storage::bf16}) {
    Product product(random, 9, 20, 70);
    std::vector<int> left;
    for (int tap = 0; tap < 9; ++tap) {
      if (tap % 4 != 1) left.push_back(tap);
    }
    on_every_isa([&] {
      const PackedMatrix matrix = product.packed(storage);
      const std::vector<float> some = product.run(matrix, 0, kRows, left, 9);
      Product zeroed = product;
      for (const int tap : {1, 5}) {
        for (int r = 0; r < kRows; ++r) {
          std::fill_n(&zeroed.values[index((r * 9 + tap) * 20)], 20, 0.0f);
        }
      }
      EXPECT_EQ(some, zeroed.run(matrix, 0, kRows));
    });
  }
}

TEST(PackedMatrix, taps_behind_each_other_may_be_multiplied_as_fewer) {
  Random random(105);
  const Product product(random, 6, 5, 33);
  on_every_isa([&] {
    const PackedMatrix matrix = product.packed();
    const std::vector<float> expected = product.run(matrix, 0, kRows);
    EXPECT_EQ(product.run(matrix, 0, kRows, {0}, 1), expected);
  });
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
