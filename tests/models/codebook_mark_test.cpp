// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/codebook_mark.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <random>

namespace ps::models {
namespace {

std::vector<float> codebook(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<float> embed(32 * 512);
  for (float& value : embed) value = normal(random);
  return embed;
}

TEST(CodebookMark, is_the_same_for_a_codebook_in_half_precision) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<float> whole = codebook(seed);
    std::vector<float> half = whole, brain = whole;
    for (float& value : half) value = static_cast<float>(Eigen::half(value));
    for (float& value : brain) value = static_cast<float>(Eigen::bfloat16(value));
    EXPECT_TRUE(same_codebook(codebook_mark(whole), codebook_mark(half)));
    EXPECT_TRUE(same_codebook(codebook_mark(whole), codebook_mark(brain)));
  }
}

TEST(CodebookMark, differs_for_another_codebook_and_for_another_order_of_codes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<float> embed = codebook(seed);
    const std::string mark = codebook_mark(embed);
    EXPECT_FALSE(same_codebook(mark, codebook_mark(codebook(seed + 100))));
    std::rotate(embed.begin(), embed.begin() + 1, embed.end());
    EXPECT_FALSE(same_codebook(mark, codebook_mark(embed)));
  }
}

TEST(CodebookMark, that_is_none_says_nothing) {
  const std::string mark = codebook_mark(codebook(1));
  for (const char* other : {"", "1 2 3", "x", "1 2 3 4 5 6 7 8 9", "nan nan"}) {
    EXPECT_TRUE(same_codebook(mark, other));
    EXPECT_TRUE(same_codebook(other, mark));
  }
}

TEST(CodebookMark, is_a_constant_of_the_file_format) {
  std::vector<float> embed(64);
  for (std::size_t i = 0; i < embed.size(); ++i) embed[i] = static_cast<float>(i);
  EXPECT_EQ(codebook_mark(embed), "620 64 384 -162 -134 -308 -534 -298");
}

}  // namespace
}  // namespace ps::models
