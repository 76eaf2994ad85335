// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "libps/core/parallel.h"

namespace ps {
namespace {

TEST(Meter, tells_shares_of_stages_that_never_fall) {
  std::vector<double> told;
  Meter meter([&](double done) { told.push_back(done); });
  meter.stage(.5, 4);
  meter.add(1);
  meter.add(3);
  meter.add(5);  // more than there are
  meter.stage_of_rest(.5, 2);
  meter.add(1);
  meter.stage(.2, 1);  // before where it is
  meter.add(1);
  meter.stage(7, 0);
  meter.add(1);
  EXPECT_EQ(told, (std::vector<double>{0, .125, .5, .5, .5, .625, .75, .75, .75, 1}));
}

TEST(Meter, without_anybody_to_tell_counts_in_silence) {
  Meter meter({});
  meter.stage(1, 2);
  meter.add(2);
}

TEST(Meter, what_is_thrown_while_it_tells_comes_out) {
  Meter meter([](double done) {
    if (done > 0) throw std::runtime_error("enough");
  });
  meter.stage(1, 2);
  EXPECT_THROW(meter.add(1), std::runtime_error);
  EXPECT_THROW(meter.add(1), std::runtime_error) << "and it may be asked again";
}

TEST(Meter, is_told_by_many_threads_and_tells_from_one_at_a_time) {
  std::vector<double> told;
  Meter meter([&](double done) { told.push_back(done); });
  meter.stage(1, 1000);
  set_threads(4);
  parallel_for(1000, [&](std::size_t) { meter.add(1); });
  set_threads(0);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_LE(told.size(), 1001u);
  meter.stage(1, 1);
  EXPECT_EQ(told.back(), 1);
}

}  // namespace
}  // namespace ps
