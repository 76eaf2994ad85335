// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libps/core/error.h"

namespace ps {
namespace {

/// One column of a method's rows.
struct Scores {
  std::vector<std::string> samples;
  std::vector<int> groups;
  std::vector<double> values;
};

Scores scores_of(const ScoreTable& table, const std::string& method, std::size_t column) {
  Scores scores;
  for (const ScoreRow& row : table.rows()) {
    if (row.method != method) continue;
    scores.samples.push_back(row.sample);
    scores.groups.push_back(row.group);
    scores.values.push_back(row.values.at(column));
  }
  return scores;
}

void check_same(const Scores& a, const Scores& b, const std::string& method) {
  if (a.samples == b.samples) return;
  throw Error(method, "was tried on other samples than the others", "the same in the same order");
}

bool any_number(const Scores& scores) {
  return std::any_of(scores.values.begin(), scores.values.end(),
                     [](double value) { return !std::isnan(value); });
}

/// Takes out samples that some method has no score of; methods without any score do not count.
void keep_complete(std::vector<Scores>& all) {
  std::vector<bool> complete(all.front().values.size(), true);
  for (const Scores& scores : all) {
    for (std::size_t i = 0; any_number(scores) && i < complete.size(); ++i) {
      complete[i] = complete[i] && !std::isnan(scores.values[i]);
    }
  }
  for (Scores& scores : all) {
    if (!any_number(scores)) {
      scores = {};
      continue;
    }
    Scores kept;
    for (std::size_t i = 0; i < complete.size(); ++i) {
      if (!complete[i]) continue;
      kept.samples.push_back(scores.samples[i]);
      kept.groups.push_back(scores.groups[i]);
      kept.values.push_back(scores.values[i]);
    }
    scores = kept;
  }
}

/// Takes away what is easy or hard for all, as within_samples() says; means stay.
void take_away_samples(const std::vector<Scores*>& all) {
  const auto methods = static_cast<double>(all.size());
  std::vector<double> of_samples(all.front()->values.size(), 0);
  for (const Scores* scores : all) {
    for (std::size_t i = 0; i < of_samples.size(); ++i)
      of_samples[i] += scores->values[i] / methods;
  }
  const double grand = mean(of_samples), stretch = std::sqrt(methods / (methods - 1));
  for (Scores* scores : all) {
    const double middle = mean(scores->values);
    for (std::size_t i = 0; i < of_samples.size(); ++i) {
      const double change = scores->values[i] - of_samples[i];
      scores->values[i] = middle + stretch * (change - (middle - grand));
    }
  }
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<TradeoffPoint>& points) {
  const auto measured = [](const TradeoffPoint& point) {
    return !std::isnan(point.seconds.value) && !std::isnan(point.accuracy.value);
  };
  const auto beats =  // NaN beats nothing
      [](const TradeoffPoint& a, const TradeoffPoint& b) {
        const double s = a.seconds.value, t = b.seconds.value;
        const double p = a.accuracy.value, q = b.accuracy.value;
        return s <= t && p >= q && (s < t || p > q);
      };
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool beaten = std::any_of(points.begin(), points.end(), [&](const TradeoffPoint& other) {
      return beats(other, points[i]);
    });
    if (!beaten && measured(points[i])) front.push_back(i);
  }
  std::stable_sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
    return points[a].seconds.value < points[b].seconds.value;
  });
  return front;
}

std::vector<Interval> within_samples(const ScoreTable& table, std::size_t column,
                                     const BootstrapOptions& options) {
  std::vector<Scores> all;
  for (const std::string& method : table.methods()) {
    all.push_back(scores_of(table, method, column));
    check_same(all.back(), all.front(), method);
  }
  if (all.empty()) return {};
  keep_complete(all);
  std::vector<double> means;
  std::vector<Scores*> compared;
  for (Scores& scores : all) {
    means.push_back(mean(scores.values));
    if (!scores.values.empty()) compared.push_back(&scores);
  }
  if (compared.size() > 1) take_away_samples(compared);
  std::vector<Interval> intervals;
  for (std::size_t m = 0; m < all.size(); ++m) {
    intervals.push_back(bootstrap_mean(all[m].values, all[m].groups, options));
    intervals.back().value = means[m];
  }
  return intervals;
}

Interval mean_change(const ScoreTable& table, const std::string& method, const std::string& other,
                     std::size_t column, const BootstrapOptions& options) {
  Scores scores = scores_of(table, method, column);
  const Scores base = scores_of(table, other, column);
  check_same(scores, base, method);
  for (std::size_t i = 0; i < scores.values.size(); ++i) scores.values[i] -= base.values[i];
  return bootstrap_mean(scores.values, scores.groups, options);
}

}  // namespace ps
