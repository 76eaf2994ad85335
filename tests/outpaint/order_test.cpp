// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/order.h"

#include <gtest/gtest.h>

#include <random>

#include "io/safetensors.h"
#include "tests/io/support.h"
#include "tests/models/support.h"

namespace ps::outpaint {
namespace {

using models::bytes_of;
using models::ints_of;

cv::Mat1b background_of(const FileTensor& tensor) {
  std::vector<std::uint8_t> bytes = bytes_of(tensor);
  return cv::Mat1b(256, 256, bytes.data()).clone();
}

class OrderReference : public testing::TestWithParam<const char*> {};

TEST_P(OrderReference, equals_the_published_code) {
  PS_NEED_SHARED("reference/c_order.safetensors");
  const TensorMap all = read_safetensors(shared("reference/c_order.safetensors"));
  const std::string name = GetParam() + std::string(".");
  const Order order = order_of(background_of(all.at(name + "bg256")));
  const auto expected = ints_of(all.at(name + "order"));  // row, column
  ASSERT_EQ(order.cells.size() * 2, expected.size());
  for (std::size_t i = 0; i < order.cells.size(); ++i) {
    ASSERT_EQ(order.cells[i], expected[2 * i] * 32 + expected[2 * i + 1]) << "place " << i;
  }
  EXPECT_EQ(order.distance, ints_of(all.at(name + "distance32")));
  EXPECT_EQ(order.missing, bytes_of(all.at(name + "missing32")));
  EXPECT_EQ(order.masks.first, bytes_of(all.at(name + "mask_init")));
  EXPECT_EQ(order.masks.later, bytes_of(all.at(name + "mask_undilated")));
  EXPECT_EQ(order.masks.dilated, bytes_of(all.at(name + "mask_dilated")));
}

INSTANTIATE_TEST_SUITE_P(cases, OrderReference,
                         testing::Values("R", "L", "U", "D", "UL", "holes", "island", "allfg",
                                         "allbg"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Order, equals_its_golden) {
  const TensorMap& golden = models::goldens();
  std::vector<std::uint8_t> background = models::golden_background();
  const Order order = order_of(cv::Mat1b(256, 256, background.data()));
  const auto expected = ints_of(golden.at("order.order"));
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_EQ(order.cells[i], expected[2 * i] * 32 + expected[2 * i + 1]) << "place " << i;
  }
  EXPECT_EQ(order.distance, ints_of(golden.at("order.distance32")));
  EXPECT_EQ(order.missing, bytes_of(golden.at("order.missing32")));
}

/// The same by a search over all cells at every step.
std::vector<int> slow_order(const Order& order) {
  const auto cells = static_cast<int>(order.size());
  std::vector<bool> taken(order.size(), false);
  std::vector<int> result;
  while (static_cast<int>(result.size()) < cells) {
    int best = -1;
    for (int cell = 0; cell < cells; ++cell) {
      const int y = cell / order.width, x = cell % order.width;
      const bool touches = (y > 0 && taken[cell - order.width]) ||
                           (y + 1 < order.height && taken[cell + order.width]) ||
                           (x > 0 && taken[cell - 1]) || (x + 1 < order.width && taken[cell + 1]);
      if (taken[cell] || !(touches || result.empty())) continue;
      if (best < 0 || order.distance[cell] > order.distance[best]) best = cell;
    }
    taken[best] = true;
    result.push_back(best);
  }
  return result;
}

TEST(Order, equals_a_search_over_all_cells_on_random_masks_of_any_size) {
  std::mt19937 random(4);
  for (int round = 0; round < 40; ++round) {
    const int height = 1 + static_cast<int>(random() % 12),
              width = 1 + static_cast<int>(random() % 12);
    cv::Mat1b background(8 * height, 8 * width, std::uint8_t{0});
    for (int box = 0; box < 4; ++box) {
      const int x = static_cast<int>(random() % background.cols),
                y = static_cast<int>(random() % background.rows);
      background(cv::Rect(x, y, std::min(40, background.cols - x),
                          std::min(40, background.rows - y))) = static_cast<int>(random() % 2);
    }
    const Order order = order_of(background);
    EXPECT_EQ(order.cells, slow_order(order)) << height << "x" << width;
    for (std::size_t cell = 0; cell < order.size(); ++cell) {
      EXPECT_EQ(order.cells[static_cast<std::size_t>(order.rank[cell])], static_cast<int>(cell));
    }
  }
}

TEST(Order, a_partly_missing_cell_is_kept) {
  cv::Mat1b background(16, 16, std::uint8_t{0});
  background(cv::Rect(8, 0, 8, 16)) = 1;
  background(3, 12) = 0;
  const Order order = order_of(background);
  EXPECT_EQ(order.missing, (std::vector<std::uint8_t>{0, 0, 0, 1}));
}

TEST(Order, errors_say_what_is_wrong) {
  EXPECT_TRUE(has(error_of([] { order_of(cv::Mat1b(12, 16)); }), "multiples of 8"));
  EXPECT_TRUE(has(error_of([] { order_of(cv::Mat1b()); }), "multiples of 8"));
  EXPECT_TRUE(has(error_of([] {
                    order_from(1, 2, {0, 0}, {1, 1});
                  }),
                  "every cell of the grid once"));
  EXPECT_TRUE(has(error_of([] {
                    order_from(1, 2, {0, 2}, {1, 1});
                  }),
                  "every cell of the grid once"));
  EXPECT_TRUE(has(error_of([] { order_from(1, 2, {0}, {1, 1}); }), "2 of each"));
}

}  // namespace
}  // namespace ps::outpaint
