// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "libps/eval/tradeoff.h"
#include "libps/geometry/view.h"

namespace ps {

/// Views of one world, through one lens, that knobs are tried on.
struct KnobSample {
  std::string name;
  int group = 0;             ///< samples of one group are alike (bootstrap_mean())
  View input, target;        ///< with depth
  Depth whole_depth;         ///< the input's, holes filled; empty = it has none
  std::vector<View> others;  ///< further ones, with depth; may be empty
};

/// What one run of one setting gave.
struct KnobTrial {
  double seconds = 0;
  std::vector<double> scores;  ///< one for each of Knob::scores; NaN = not measured
  Image picture;               ///< what the scores are of
};

/// A knob's settings on one sample.
struct KnobBench {
  Image truth;                                        ///< what pictures should look like
  std::function<KnobTrial(std::size_t setting)> run;  ///< scores and pictures are always the same
};

struct KnobSetting {
  std::string name;
  bool is_default = false;
};

/// @brief Something that can be set, to have more accuracy or less time.
struct Knob {
  std::string name;                        ///< "radius"
  std::string what;                        ///< in a sentence
  std::string timed = {};                  ///< what the seconds are of
  std::vector<ScoreColumn> scores = {};    ///< the first one is the accuracy: the more the better
  std::vector<KnobSetting> settings = {};  ///< one is the default
  int repeats = 1;                         ///< of each setting; the least time counts
  std::function<KnobBench(const KnobSample&)> prepare = {};
};

/// Pictures of one sample.
struct KnobPictures {
  std::string sample;
  Image input, truth;
  std::vector<Image> by_setting;
};

struct KnobResult {
  ScoreTable table;  ///< methods are the settings; columns: seconds, then Knob::scores
  std::vector<KnobPictures> pictures;
};

struct MeasureOptions {
  std::size_t pictures = 2;  ///< of the first so many samples pictures are kept
  /// Told how many runs of how many are done; what it throws comes out of measure().
  std::function<void(std::size_t done, std::size_t total)> progress;
};

/// @brief Tries all settings of all knobs on all samples. Settings take turns, in an order that
/// shifts with sample and repeat, so that what else the machine does hits all alike; before its
/// first sample each knob's settings are run once for nothing where it repeats, else one of them.
/// @param load  gives sample i in [0, count); each is loaded once
/// @return one for each knob
/// Throws ps::Error when a knob has no single default, or its accuracy is better when less.
std::vector<KnobResult> measure(const std::vector<Knob>& knobs, std::size_t count,
                                const std::function<KnobSample(std::size_t)>& load,
                                const MeasureOptions& options = {});

/// @brief Points of the settings, in their order: within-sample intervals of seconds, which are
/// geometric means, and of accuracy, and changes against the default.
std::vector<TradeoffPoint> points_of(const Knob& knob, const ScoreTable& table,
                                     const BootstrapOptions& options = {});

}  // namespace ps
