// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/selection.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "libps/core/error.h"

namespace ps::outpaint {

std::vector<int> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<int> rank(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<int>(i);
  return rank;
}

std::vector<double> totals(const std::vector<Signal>& signals) {
  if (signals.empty()) throw Error("selection", "no signal", "at least one");
  const std::size_t count = signals.front().scores.size();
  std::vector<double> total(count, 0);
  for (const Signal& signal : signals) {
    if (signal.scores.size() != count) {
      throw Error("selection",
                  "signals of " + std::to_string(count) + " and " +
                      std::to_string(signal.scores.size()) + " completions",
                  "one score for each");
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isnan(signal.scores[i])) continue;
      throw Error("selection",
                  "score " + std::to_string(i) + " of signal " + signal.name + " is not a number",
                  "numbers");
    }
    const std::vector<int> rank = ranks(signal.scores);
    for (std::size_t i = 0; i < count; ++i) {
      const int better = signal.higher_is_better ? rank[i] : static_cast<int>(count) - 1 - rank[i];
      total[i] += static_cast<double>(better) / static_cast<double>(signals.size());
    }
  }
  return total;
}

std::vector<double> agreement(const std::vector<Completion>& completions) {
  std::vector<double> shares(completions.size());
  if (completions.empty()) return shares;
  const std::size_t cells = completions.front().codes.size();
  std::int32_t most = 0;
  for (const Completion& completion : completions) {
    for (const std::int32_t code : completion.codes) most = std::max(most, code);
  }
  std::vector<int> votes(static_cast<std::size_t>(most) + 1);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const auto votes_of = [&](const Completion& completion) -> int& {
      return votes[static_cast<std::size_t>(completion.codes[cell])];
    };
    for (const Completion& completion : completions) ++votes_of(completion);
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] += votes_of(completions[i]);
    for (const Completion& completion : completions) votes_of(completion) = 0;
  }
  for (double& share : shares) share /= static_cast<double>(cells * completions.size());
  return shares;
}

std::size_t best_of(const std::vector<double>& totals) {
  return static_cast<std::size_t>(std::max_element(totals.begin(), totals.end()) - totals.begin());
}

double entropy(const std::vector<float>& logits) {
  if (logits.empty()) return 0;
  const double most = *std::max_element(logits.begin(), logits.end());
  double sum = 0, weighted = 0;
  for (const float logit : logits) {
    const double e = std::exp(logit - most);
    sum += e;
    weighted += e * (logit - most);
  }
  return std::log(sum) - weighted / sum;
}

}  // namespace ps::outpaint
