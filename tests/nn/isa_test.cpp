// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/isa.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libps/core/error.h"

namespace ps::nn {
namespace {

TEST(Isa, the_baseline_runs_everywhere_and_the_fastest_is_used) {
  const std::vector<Isa> all = available_isas();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front(), Isa::baseline);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_EQ(isa(), all.back());
}

TEST(Isa, can_be_chosen_or_is_refused) {
  const Isa before = isa();
  const std::vector<Isa> all = available_isas();
  for (const Isa one : {Isa::baseline, Isa::avx2, Isa::avx512}) {
    if (std::find(all.begin(), all.end(), one) == all.end()) {
      EXPECT_THROW(set_isa(one), Error);
    } else {
      set_isa(one);
      EXPECT_EQ(isa(), one);
    }
  }
  set_isa(before);
}

TEST(Isa, has_a_name) {
  EXPECT_EQ(to_string(Isa::baseline), "baseline");
  EXPECT_EQ(to_string(Isa::avx2), "avx2");
  EXPECT_EQ(to_string(Isa::avx512), "avx512");
}

}  // namespace
}  // namespace ps::nn
