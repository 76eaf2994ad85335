// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/outpainter.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "libps/core/clock.h"
#include "libps/core/error.h"
#include "libps/outpaint/nearest_seen.h"
#include "libps/outpaint/progress.h"
#include "libps/outpaint/view_pictures.h"
#include "libps/outpaint/work.h"

namespace ps::outpaint {
namespace {

void check(const OutpaintOptions& options) {
  constexpr int kMostSamples = 1000;
  if (options.samples < 1 || options.samples > kMostSamples) {
    throw Error("samples", std::to_string(options.samples), "1 to " + std::to_string(kMostSamples));
  }
  if (!(options.temperature >= 0 && options.temperature <= 2)) {
    throw Error("temperature", std::to_string(options.temperature), "0 to 2");
  }
  if (!(options.guidance >= 0 && options.guidance <= 1000)) {
    throw Error("guidance", std::to_string(options.guidance), "0 to 1000");
  }
  if (options.refine_best < 0) {
    throw Error("completions to refine", std::to_string(options.refine_best), "0 (all) or more");
  }
  if (options.refine_best > 0 && options.until_settled) {
    throw Error("completions to refine", "a number, with samples drawn until settled",
                "one or the other: what settles is the best of those refined");
  }
}

std::vector<int> numbers_from(int first, int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

/// The numbers of the `count` greatest scores, rising.
std::vector<int> greatest(const std::vector<double>& scores, int count) {
  std::vector<int> numbers = numbers_from(0, static_cast<int>(scores.size()));
  std::stable_sort(numbers.begin(), numbers.end(), [&](int a, int b) {
    return scores[static_cast<std::size_t>(a)] > scores[static_cast<std::size_t>(b)];
  });
  numbers.resize(std::min(numbers.size(), static_cast<std::size_t>(count)));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<double> likelihoods_of(const std::vector<Completion>& completions) {
  std::vector<double> likelihoods;
  for (const Completion& completion : completions) {
    likelihoods.push_back(completion.log_likelihood);
  }
  return likelihoods;
}

/// The number of the one to keep where nobody scores pictures.
int kept(const std::vector<Completion>& completions, OutpaintOptions::Keep keep) {
  const bool agreed = keep == OutpaintOptions::Keep::agreed;
  return static_cast<int>(best_of(agreed ? agreement(completions) : likelihoods_of(completions)));
}

bool all_finite(const nn::TensorView& image) {
  const float* end = image.pixel(image.shape.pixels());
  return std::all_of<const float*>(image.data, end, [](float x) { return std::isfinite(x); });
}

}  // namespace

/// What is kept of a view while its completions pass by.
struct Outpainter::View {
  const OutpaintOptions& options;
  Outpainted& result;
  ViewPictures& pictures;
  Work work;
  Progress progress;
  int samples;                       ///< to be drawn at most
  int shown = -1;                    ///< the completion whose refined picture there is
  std::vector<float> guidance = {};  ///< see SampleOptions
  std::vector<Completion> completions = {};
  std::vector<Signal> signals = {};
};

Outpainter::Outpainter(Networks networks) : networks_(std::move(networks)) {
  if (!networks_.autoencoder || !networks_.pixel_cnn || !networks_.refiner) {
    throw Error("outpainter", "a network is missing", "autoencoder, PixelCNN and refiner");
  }
}

std::vector<std::int32_t> Outpainter::encode(View& view, const nn::TensorView& projection,
                                             const cv::Mat1b& background) {
  view.progress.at(0);
  const AddedSeconds clock(view.result.report.encode_seconds);
  const models::Autoencoder& autoencoder = *networks_.autoencoder;
  const nn::Shape grid = autoencoder.grid(projection.shape);
  std::vector<std::int32_t> codes(grid.pixels());
  nn::Tensor pre_quant(grid);
  const bool nothing_seen = cv::countNonZero(background) == background.size().area();
  const bool guided = view.options.guidance > 0 && !nothing_seen;
  if (guided || view.options.encode_nearest) {
    autoencoder.encode(with_nearest_colors(projection, background), pre_quant, workspace_);
    if (guided) guide(view, pre_quant);
  }
  if (!view.options.encode_nearest) autoencoder.encode(projection, pre_quant, workspace_);
  autoencoder.quantise(pre_quant, codes.data());
  return codes;
}

void Outpainter::guide(View& view, const nn::TensorView& pre_quant) {
  const nn::Codebook& codebook = networks_.autoencoder->codebook();
  const float spacing = codebook.spacing();
  if (!(spacing > 0)) return;
  view.guidance.resize(pre_quant.shape.pixels() * static_cast<std::size_t>(codebook.size()));
  codebook.excess(pre_quant, view.guidance.data());
  const auto scale = static_cast<float>(-view.options.guidance / spacing);
  for (float& logit : view.guidance) {
    logit *= scale;
    if (!std::isfinite(logit)) {
      throw Error("outpainter", "the encoding of what is seen is not finite",
                  "finite numbers: the autoencoder's weights overflow");
    }
  }
}

void Outpainter::sample(View& view, Sampler& sampler, int count) {
  const AddedSeconds clock(view.result.report.sample_seconds);
  const double work = count * view.work.sample;
  SampleOptions options;
  options.temperature = view.options.temperature;
  options.seed = view.options.seed;
  options.view = view.options.view;
  options.guidance = view.guidance.empty() ? nullptr : view.guidance.data();
  options.progress = [&](double done) {
    view.progress.at(done * work);
    return true;
  };
  std::vector<Completion> more = sampler.sample(view.result.report.drawn, count, options);
  std::move(more.begin(), more.end(), std::back_inserter(view.completions));
  view.result.report.drawn += count;
  view.progress.done(work);
}

void Outpainter::decode(View& view, int number) {
  const AddedSeconds clock(view.result.report.decode_seconds);
  view.pictures.decode(view.completions[static_cast<std::size_t>(number)].codes, workspace_);
  view.progress.done(view.work.decode);
}

void Outpainter::refine(View& view, int number) {
  const AddedSeconds clock(view.result.report.refine_seconds);
  view.pictures.refine(workspace_);
  view.shown = number;
  if (!all_finite(view.pictures.image())) {
    throw Error("outpainter",
                "the refined picture of completion " + std::to_string(number) +
                    " holds a value that is not finite",
                "finite numbers: the networks' weights overflow");
  }
  view.progress.done(view.work.refine);
}

void Outpainter::score(View& view, const nn::TensorView& image, int number,
                       std::vector<Signal>& signals) {
  const AddedSeconds clock(view.result.report.score_seconds);
  std::size_t signal = 0;
  for (const Scorer& scorer : networks_.scorers) {
    const double score = scorer.score(image, workspace_);
    if (std::isnan(score)) {
      throw Error("outpainter",
                  "the score of completion " + std::to_string(number) + " by " + scorer.name +
                      " is not a number",
                  "numbers");
    }
    signals[signal++].scores.push_back(score);
    view.progress.done(view.work.score / static_cast<double>(networks_.scorers.size()));
  }
  if (signal < signals.size()) {
    signals[signal].scores.push_back(
        view.completions[static_cast<std::size_t>(number)].log_likelihood);
  }
}

void Outpainter::refine_and_score(View& view, const std::vector<int>& numbers) {
  Outpainted& result = view.result;
  for (const int number : numbers) {
    decode(view, number);
    refine(view, number);
    score(view, view.pictures.image(), number, view.signals);
    result.refined.push_back(number);
  }
  result.totals = totals(view.signals);
  result.best = result.refined[best_of(result.totals)];
}

/// The numbers of the completions that are worth refining.
std::vector<int> Outpainter::screened(View& view) {
  if (networks_.scorers.empty()) return {kept(view.completions, view.options.keep)};
  const int count = view.options.refine_best;
  if (count == 0 || static_cast<std::size_t>(count) >= view.completions.size()) {
    return numbers_from(0, static_cast<int>(view.completions.size()));
  }
  if (view.options.screen == OutpaintOptions::Screen::likelihood) {
    return greatest(likelihoods_of(view.completions), count);
  }
  std::vector<Signal> signals = view.signals;
  nn::Tensor picture(view.pictures.image().shape());
  for (int number = 0; number < view.result.report.drawn; ++number) {
    decode(view, number);
    view.pictures.copy_unrefined(picture);
    score(view, picture, number, signals);
  }
  return greatest(totals(signals), count);
}

void Outpainter::draw(View& view, Sampler& sampler) {
  if (view.options.until_settled) return draw_until_settled(view, sampler);
  sample(view, sampler, view.samples);
  refine_and_score(view, screened(view));
}

void Outpainter::draw_until_settled(View& view, Sampler& sampler) {
  const bool judged = !networks_.scorers.empty();
  const int& drawn = view.result.report.drawn;
  for (int leader = -1; drawn < view.samples;) {
    const int count = std::min(OutpaintOptions::kRound, view.samples - drawn);
    sample(view, sampler, count);
    if (judged) refine_and_score(view, numbers_from(drawn - count, count));
    const int best = judged ? view.result.best : kept(view.completions, view.options.keep);
    if (best == leader && drawn >= 2 * (leader + 1)) break;
    leader = best;
  }
  if (!judged) refine_and_score(view, screened(view));
}

Outpainted Outpainter::outpaint(const nn::TensorView& projection, const cv::Mat1b& background,
                                const OutpaintOptions& options) {
  const Order order = order_of(background, models::Autoencoder::kCell);
  Outpainted result;
  if (cv::countNonZero(background) == 0) {
    result.image = nn::Tensor(projection.shape);
    for (std::size_t i = 0; i < projection.shape.pixels(); ++i) {
      std::copy_n(projection.pixel(i), 3, result.image.view().pixel(i));
    }
    Progress(options.progress, 1).finish();
    return result;
  }
  // One picture alone is soonest refined whole.
  const bool region = options.region && !networks_.scorers.empty();
  ViewPictures pictures(*networks_.autoencoder, *networks_.refiner, projection, background,
                        {options.seed, options.view}, region);
  OutpaintReport& report = result.report;
  report.changed = pictures.changed();
  report.cells = order.size();
  report.missing_cells = static_cast<std::size_t>(
      std::count(order.missing.begin(), order.missing.end(), std::uint8_t{1}));
  const bool differ = report.missing_cells > 0 && options.temperature > 0;
  const int samples = differ ? options.samples : 1;
  const Work work(options, samples, report.missing_cells, networks_.scorers.size(),
                  background.size().area(), report.changed.area());
  View view{options, result, pictures, work, Progress(options.progress, work.whole), samples};
  for (const Scorer& scorer : networks_.scorers) {
    view.signals.push_back({{}, scorer.higher_is_better, scorer.name});
  }
  if (options.likelihood || networks_.scorers.empty()) {
    view.signals.push_back({{}, true, "log-likelihood"});
  }
  Sampler sampler(*networks_.pixel_cnn, order, encode(view, projection, background));
  report.levels = sampler.levels();
  view.progress.done(work.encode);
  {
    const AddedSeconds clock(report.refine_seconds);
    pictures.refine_rest(workspace_);
  }
  view.progress.done(work.refine_rest);
  draw(view, sampler);
  if (view.shown != result.best) {
    decode(view, result.best);
    refine(view, result.best);
  }
  report.refined = static_cast<int>(result.refined.size());
  for (Signal& signal : view.signals) result.scores.push_back(std::move(signal.scores));
  result.codes = view.completions[static_cast<std::size_t>(result.best)].codes;
  result.image = std::move(pictures.image());
  view.progress.finish();
  return result;
}

Outpainted Outpainter::run(const nn::TensorView& projection, const cv::Mat1b& background,
                           const OutpaintOptions& options) {
  check(options);
  if (projection.shape != nn::Shape{1, background.rows, background.cols, 3}) {
    throw Error("outpainter", "a projection and a background that do not fit",
                "one picture of three channels, one mask of its size");
  }
  try {
    return outpaint(projection, background, options);
  } catch (const Stopped&) {
    return {};
  }
}

}  // namespace ps::outpaint
