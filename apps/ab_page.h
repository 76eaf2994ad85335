// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "libps/eval/ab_study.h"

namespace ps::apps {

/// One pair of pictures, as data URIs.
struct AbPair {
  std::string name;
  std::string a, b;
  std::string input;               ///< what both were made of; empty = it is not shown
  std::string broken_a, broken_b;  ///< where a sentinel needs them; else empty
};

struct AbPage {
  std::string name_a, name_b;  ///< of the methods; shown at the end alone, in the result
  std::string question;
  std::uint64_t seed = 0;
  std::vector<AbPair> pairs;
  std::vector<AbTrial> trials;  ///< of these pairs
};

/// @brief One web page that needs nothing else and asks nothing of the network: it shows trial
/// after trial, takes keys 1 and 2 or clicks, and at the end shows the result as JSON (`<pre
/// id=result>`) and offers it as a file. The result counts a pair for a method when both votes are
/// for it.
std::string html_of(const AbPage& page);

}  // namespace ps::apps
