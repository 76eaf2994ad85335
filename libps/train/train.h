// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace ps::train {

/// TrainOptions::width of the published networks (SPEC.md 2).
constexpr int kPaperWidth = -1;

/// TrainOptions::codes that are colours.
constexpr char kColors[] = "colours";

/// What is trained, on what, for how long.
struct TrainOptions {
  std::string stage;            ///< one of stage_names()
  std::filesystem::path train;  ///< folder of shards to train on (shard.h)
  std::filesystem::path test;   ///< folder of shards to evaluate on, never trained on; may be empty
  std::filesystem::path out;    ///< folder of the run: checkpoint, log, weights; made when missing
  /// Weights of a trained VQ-VAE, for pixelcnn and refine; or kColors: models::color_codes().
  std::filesystem::path codes;
  std::filesystem::path features;  ///< weights of LPIPS, a perceptual loss of refine; may be empty
  std::filesystem::path init;      ///< weights to begin with instead of random ones; may be empty
  int width = 0;                   ///< of the network; 0 = the size that is shipped; or kPaperWidth
  int batch = 0;                   ///< examples a step; 0 = the stage's own
  std::int64_t steps = 0;  ///< in all; the learning rate falls to 0 by then; 0 = the stage's own
  double steps_scale = 1;  ///< of the stage's own steps
  std::int64_t stop_after =
      0;  ///< stop after so many steps of this call, as if interrupted; 0 = never
  double learning_rate = 0;    ///< 0 = the stage's own
  double frames_share = 0.35;  ///< of examples that come from real frames, where there are any
  /// The VQ-VAE's codes stay what they are, and what was trained on them stays true: the decoder
  /// alone is trained. With `init`.
  bool keep_codes = false;
  /// What teaches depth: "depth", where it is known; "poses", by reprojection; "both".
  std::string supervision = "depth";
  /// Pairs are drawn whose views are turned by no more than a limit, which grows to all in so many
  /// equal steps over the run (SPEC.md 10); 0 = none; below 0 = the stage's own
  int curriculum = -1;
  std::uint64_t seed = 0;
  std::string device = "cpu";  ///< or "cuda"
  /// Of the products of convolutions and what goes from one to the next: "f32", or "bf16", which is
  /// faster where the processor has AMX; scores are always of f32.
  std::string arithmetic = "f32";
  int threads = 0;  ///< 0 = all
  std::int64_t save_every = 500, test_every = 1000;
  std::int64_t test_count = 128;  ///< examples of each group in an evaluation
};

/// A picture of what the networks do: RGB in [0,1], row-major.
struct Sheet {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

struct TrainEvent {
  std::int64_t step = 0, steps = 0;
  std::map<std::string, double> values;  ///< losses since the last event; or scores, when evaluated
  bool evaluated = false;
  const Sheet* sheet = nullptr;  ///< with an evaluation
};

/// Told of progress; returns false to stop after a checkpoint.
using TrainProgress = std::function<bool(const TrainEvent&)>;

struct TrainReport {
  std::int64_t steps = 0;  ///< done in all
  int batch = 0;           ///< examples a step
  double seconds = 0;      ///< of this call
  double images_per_second = 0;
  std::int64_t parameters = 0;
  std::map<std::string, double> scores;  ///< of the last evaluation
  std::filesystem::path weights;
};

const std::vector<std::string>& stage_names();

/// @brief Trains one stage (SPEC.md 10), or goes on with it: `out/checkpoint.safetensors`, when
/// there is one of the same stage and width, is resumed, and the rest of the run is what it would
/// have been without the interruption. Writes `out/log.csv` and, at each evaluation and at the end,
/// `out/weights.safetensors` (averaged weights, F32, under the published names, with metadata).
/// Throws ps::Error when folders, files or options are unsound.
TrainReport train(const TrainOptions& options, const TrainProgress& progress);

}  // namespace ps::train
