// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "libps/models/autoencoder.h"
#include "libps/models/pixel_cnn.h"
#include "libps/models/refiner.h"
#include "libps/outpaint/sampler.h"
#include "libps/outpaint/scorer.h"
#include "libps/outpaint/selection.h"

namespace ps::outpaint {

struct OutpaintOptions {
  int samples = 50;  ///< completions drawn, 1 to 1000; at most, when `until_settled`
  /// Draw in rounds of kRound until the best of all came in the first half of what is drawn and the
  /// last round did not change it. Were totals independent, one more round would then change it
  /// with a chance of kRound / (drawn + kRound); agreements (`keep`) are not quite that.
  bool until_settled = false;
  static constexpr int kRound = 8;
  double temperature = 0.5;  ///< 0 (greedy) to 2; published: 0.7, and 0.5 indoors
  std::uint64_t seed = 0;
  std::uint32_t view = 0;
  /// Which completion is kept where there are no scorers: that which agrees most with all that were
  /// drawn (selection.h), or the PixelCNN's likeliest.
  enum class Keep { agreed, likeliest };
  Keep keep = Keep::agreed;
  bool likelihood = false;  ///< count the PixelCNN's own mean log-likelihood beside the scorers
  /// Refine and score only so many, the best by a cheaper score; 0 = all. Without scorers, one.
  int refine_best = 0;
  enum class Screen {
    likelihood,  ///< the PixelCNN's own mean log-likelihood: costs nothing
    unrefined,   ///< the same scorers, on the picture before the refiner
  };
  Screen screen = Screen::unrefined;
  /// Encode the projection with the nearest colours where it is missing, so that the codes of cells
  /// that are seen in part continue what is seen. false, as published: missing pixels are grey.
  bool encode_nearest = true;
  /// How much what is drawn is held to the nearest seen colours: before temperature divides it, the
  /// logit of a code falls by guidance x (how much farther the code is from their encoding than the
  /// nearest code is, in squared distance) / nn::Codebook::spacing(). 0, as published: not at all;
  /// up to 1000.
  double guidance = kGuidance;
  static constexpr double kGuidance = 1;
  /// Decode and refine for each completion only what it can change; false: whole pictures.
  bool region = true;
  /// Told what share of the view is done, from 0 to 1 and never falling, in all stages: one call at
  /// a time, from any thread, at least once for every network that is run. Shares are estimates;
  /// samples that need not be drawn make it leap to 1. When it returns false all stops, and what is
  /// returned is empty; what it throws comes out of `run`. Either way `run` may be called again.
  std::function<bool(double done)> progress;
};

/// What it took; seconds are of this run.
struct OutpaintReport {
  std::size_t cells = 0, missing_cells = 0, levels = 0;
  int drawn = 0, refined = 0;
  cv::Rect changed;  ///< the pixels in which completions can differ
  double encode_seconds = 0, sample_seconds = 0, decode_seconds = 0, refine_seconds = 0,
         score_seconds = 0;
};

struct Outpainted {
  nn::Tensor image;  ///< [1, h, w, 3]: the best one, refined; without pixels when it was stopped
  int best = -1;     ///< its number; -1 when it was stopped, or nothing is missing
  std::vector<std::int32_t> codes;
  std::vector<double> totals;  ///< by completion that was refined, in the order of `refined`
  std::vector<int> refined;    ///< their numbers
  std::vector<std::vector<double>> scores;  ///< by signal, then as `totals`
  OutpaintReport report;
};

/// @brief Fills in what nothing was projected to (SPEC.md 1, 6 to 9): encode, sample completions,
/// decode, combine, refine, keep the best.
///
/// Completions differ in a part of the view alone, so only that part, grown by what the networks
/// can reach, is decoded and refined for each; the rest once. A picture and its scores are the same
/// bytes whichever others are refined, or how many; and within 1e-4 of what the whole view gives.
/// Scorers see the whole picture: the discriminator's instance norms average over all of it, so
/// that every pixel a completion changes reaches every one of its outputs. All completions of a
/// view share the refiner's noise. Not for two threads at once.
class Outpainter {
 public:
  /// Networks must outlive this.
  struct Networks {
    const models::Autoencoder* autoencoder = nullptr;
    const models::PixelCnn* pixel_cnn = nullptr;
    const models::Refiner* refiner = nullptr;
    /// May be empty: then one is kept by its codes (`keep`), and it alone is decoded and refined.
    std::vector<Scorer> scorers;
  };
  explicit Outpainter(Networks networks);

  /// @param projection  [1, h, w, 3], RGB in [-1,1], 0 where nothing was projected; sides multiples
  /// of 8
  /// @param background  not 0 = missing (dilated, SPEC.md 4); of the same size
  /// @return where nothing is missing, the projection as it is
  /// Throws ps::Error when shapes do not fit, options are out of range, or a logit, a refined
  /// picture or a score (which, of which completion) is not a finite number.
  Outpainted run(const nn::TensorView& projection, const cv::Mat1b& background,
                 const OutpaintOptions& options);

 private:
  struct View;
  Outpainted outpaint(const nn::TensorView& projection, const cv::Mat1b& background,
                      const OutpaintOptions& options);
  std::vector<std::int32_t> encode(View& view, const nn::TensorView& projection,
                                   const cv::Mat1b& background);
  void guide(View& view, const nn::TensorView& pre_quant);
  void draw(View& view, Sampler& sampler);
  void draw_until_settled(View& view, Sampler& sampler);
  void sample(View& view, Sampler& sampler, int count);
  std::vector<int> screened(View& view);
  void refine_and_score(View& view, const std::vector<int>& numbers);
  void decode(View& view, int number);
  void refine(View& view, int number);
  void score(View& view, const nn::TensorView& image, int number, std::vector<Signal>& signals);

  Networks networks_;
  nn::Workspace workspace_;
};

}  // namespace ps::outpaint
