// SPDX-License-Identifier: BSD-3-Clause
#include "apps/progress.h"

#include <gtest/gtest.h>

namespace ps::apps {
namespace {

TEST(ProgressLine, tells_share_count_rate_and_time_left) {
  const std::string line = progress_line("fuse", 50, 200, 5, 80);
  EXPECT_NE(line.find("fuse"), std::string::npos);
  EXPECT_NE(line.find("25%"), std::string::npos);
  EXPECT_NE(line.find("50/200"), std::string::npos);
  EXPECT_NE(line.find("10.0/s"), std::string::npos);
  EXPECT_NE(line.find("0:15 left"), std::string::npos);
}

TEST(ProgressLine, its_bar_grows_with_the_share) {
  const auto full = [](const std::string& line) {
    return std::count(line.begin(), line.end(), '=');
  };
  EXPECT_EQ(full(progress_line("x", 0, 10, 1, 100)), 0);
  EXPECT_LT(full(progress_line("x", 2, 10, 1, 100)), full(progress_line("x", 8, 10, 1, 100)));
  EXPECT_EQ(progress_line("x", 10, 10, 1, 100).find('>'), std::string::npos);
}

TEST(ProgressLine, fits_the_terminal) {
  for (int width = 1; width < 200; ++width) {
    for (const std::size_t done : {0u, 1u, 99999u}) {
      const std::string line =
          progress_line("a long name of what is done", done, 99999, 3.7, width);
      EXPECT_LT(line.size(), static_cast<std::size_t>(std::max(width, 1) + 1)) << width;
    }
  }
}

TEST(ProgressLine, nothing_to_do_is_done) {
  EXPECT_NE(progress_line("x", 0, 0, 0, 80).find("100%"), std::string::npos);
}

TEST(OneLine, joins_lines_and_blanks) {
  EXPECT_EQ(one_line(" a\n  b\t\tc \n"), "a b c");
  EXPECT_EQ(one_line(""), "");
}

}  // namespace
}  // namespace ps::apps
