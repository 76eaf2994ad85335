// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "libps/outpaint/sampler.h"

namespace ps::outpaint {

/// @brief One opinion about all completions of a view.
struct Signal {
  std::vector<double> scores;  ///< one for each completion
  bool higher_is_better = true;
  std::string name = {};  ///< for messages
};

/// @return the place of every value in ascending order, from 0; of equal values the first comes
/// first
std::vector<int> ranks(const std::vector<double>& values);

/// @brief The total of each completion (SPEC.md 9): the mean over signals of its rank, counted so
/// that more is better. With the published two, discriminator and classifier entropy, this is their
/// total. Throws ps::Error when there is no signal, they differ in length, or a
/// score is NaN (whose, and of which completion).
std::vector<double> totals(const std::vector<Signal>& signals);

/// @brief How far each completion agrees with all: the mean share of them, itself included, that
/// have its code in a cell. The greatest has the least expected number of wrong cells, if each
/// completion is as likely to be true (minimum Bayes risk: Kumar and Byrne, NAACL 2004).
/// @param completions  of one size; codes are 0 or more
std::vector<double> agreement(const std::vector<Completion>& completions);

/// @return the first of the greatest
std::size_t best_of(const std::vector<double>& totals);

/// @return -sum of p log p over the softmax of the logits, in nats
double entropy(const std::vector<float>& logits);

}  // namespace ps::outpaint
