// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/knob.h"

#include <algorithm>
#include <cmath>

#include "libps/core/error.h"

namespace ps {
namespace {

constexpr double kClock = 1e-9;  ///< seconds that the clock can tell apart

void check(const Knob& knob) {
  const auto defaults =
      std::count_if(knob.settings.begin(), knob.settings.end(),
                    [](const KnobSetting& setting) { return setting.is_default; });
  if (defaults != 1) throw Error(knob.name, std::to_string(defaults) + " defaults", "one");
  if (knob.scores.empty() || !knob.scores.front().higher_is_better) {
    throw Error(knob.name, "its first score is no accuracy", "one that is better when more");
  }
  if (knob.repeats < 1) throw Error(knob.name, "no repeats", "one at least");
}

std::vector<ScoreColumn> columns_of(const Knob& knob) {
  std::vector<ScoreColumn> columns = {{"seconds", "s", false}};
  columns.insert(columns.end(), knob.scores.begin(), knob.scores.end());
  return columns;
}

/// Counts runs.
class Runs {
 public:
  Runs(std::size_t total, const MeasureOptions& options) : total_(total), options_(options) {}
  void one_done() {
    ++done_;
    if (options_.progress) options_.progress(done_, total_);
  }

 private:
  std::size_t done_ = 0;
  const std::size_t total_;
  const MeasureOptions& options_;
};

/// Runs all settings on one sample, in turn.
std::vector<KnobTrial> trials_of(const Knob& knob, const KnobBench& bench, std::size_t shift,
                                 Runs& runs) {
  const std::size_t count = knob.settings.size();
  std::vector<KnobTrial> best(count);
  for (int repeat = 0; repeat < knob.repeats; ++repeat) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t s = (i + shift + static_cast<std::size_t>(repeat)) % count;
      KnobTrial trial = bench.run(s);
      if (repeat == 0) {
        best[s] = std::move(trial);
      } else {
        best[s].seconds = std::min(best[s].seconds, trial.seconds);
      }
      runs.one_done();
    }
  }
  return best;
}

void warm_up(const Knob& knob, const KnobBench& bench) {
  for (std::size_t s = 0; s < (knob.repeats > 1 ? knob.settings.size() : 1); ++s) bench.run(s);
}

void add(const Knob& knob, const KnobSample& sample, const std::vector<KnobTrial>& trials,
         ScoreTable& table) {
  for (std::size_t s = 0; s < trials.size(); ++s) {
    std::vector<double> values = {trials[s].seconds};
    values.insert(values.end(), trials[s].scores.begin(), trials[s].scores.end());
    table.add({knob.settings[s].name, sample.name, sample.group, std::move(values)});
  }
}

/// Geometric means: what slows the machine down multiplies times.
std::vector<Interval> seconds_of(const ScoreTable& table, const BootstrapOptions& options) {
  ScoreTable logarithms({table.columns().front()});
  for (ScoreRow row : table.rows()) {
    row.values = {std::log(std::max(row.values.front(), kClock))};
    logarithms.add(std::move(row));
  }
  std::vector<Interval> seconds = within_samples(logarithms, 0, options);
  for (Interval& interval : seconds) {
    for (double* value : {&interval.value, &interval.low, &interval.high}) {
      *value = std::exp(*value);
    }
  }
  return seconds;
}

}  // namespace

std::vector<KnobResult> measure(const std::vector<Knob>& knobs, std::size_t count,
                                const std::function<KnobSample(std::size_t)>& load,
                                const MeasureOptions& options) {
  std::size_t total = 0;
  std::vector<KnobResult> results;
  for (const Knob& knob : knobs) {
    check(knob);
    total += count * knob.settings.size() * static_cast<std::size_t>(knob.repeats);
    results.push_back({ScoreTable(columns_of(knob)), {}});
  }
  Runs runs(total, options);
  for (std::size_t i = 0; i < count; ++i) {
    const KnobSample sample = load(i);
    for (std::size_t k = 0; k < knobs.size(); ++k) {
      const KnobBench bench = knobs[k].prepare(sample);
      if (i == 0) warm_up(knobs[k], bench);
      std::vector<KnobTrial> trials = trials_of(knobs[k], bench, i, runs);
      add(knobs[k], sample, trials, results[k].table);
      if (i >= options.pictures) continue;
      KnobPictures pictures = {sample.name, sample.input.color, bench.truth, {}};
      for (KnobTrial& trial : trials) pictures.by_setting.push_back(std::move(trial.picture));
      results[k].pictures.push_back(std::move(pictures));
    }
  }
  return results;
}

std::vector<TradeoffPoint> points_of(const Knob& knob, const ScoreTable& table,
                                     const BootstrapOptions& options) {
  check(knob);
  const auto standard = std::find_if(knob.settings.begin(), knob.settings.end(),
                                     [](const KnobSetting& s) { return s.is_default; });
  const std::vector<Interval> seconds = seconds_of(table, options);
  const std::vector<Interval> accuracy = within_samples(table, 1, options);
  std::vector<TradeoffPoint> points;
  for (const KnobSetting& setting : knob.settings) {
    const auto at = std::find(table.methods().begin(), table.methods().end(), setting.name);
    if (at == table.methods().end()) throw Error(knob.name, setting.name + " was not measured");
    const auto m = static_cast<std::size_t>(at - table.methods().begin());
    points.push_back({knob.name, setting.name, setting.is_default, seconds[m], accuracy[m],
                      mean_change(table, setting.name, standard->name, 1, options)});
  }
  return points;
}

}  // namespace ps
