// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/outpainter.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <numeric>

#include "libps/core/error.h"
#include "libps/core/random.h"

namespace ps::outpaint {
namespace {

constexpr int kCell = models::Autoencoder::kCell;
constexpr int kDecoderReach = 4 * kCell;  ///< pixels of the image that a code can reach
constexpr int kRefinerReach =
    48;  ///< and that a pixel of the refiner's input can (41), in whole cells
constexpr std::uint32_t kNoise = 1;  ///< purpose of a random number, in its counter

cv::Rect grown(const cv::Rect& rect, int by, const cv::Size& size) {
  const cv::Rect all(0, 0, size.width, size.height);
  return cv::Rect(rect.x - by, rect.y - by, rect.width + 2 * by, rect.height + 2 * by) & all;
}

/// The smallest rectangle of whole cells around the background; empty without any.
cv::Rect cells_around(const cv::Mat1b& background) {
  cv::Rect rect;
  for (int y = 0; y < background.rows; y += kCell) {
    for (int x = 0; x < background.cols; x += kCell) {
      const cv::Rect cell(x, y, kCell, kCell);
      if (cv::countNonZero(background(cell)) > 0) rect = rect.empty() ? cell : rect | cell;
    }
  }
  return rect;
}

/// Copies channels of a rectangle from one place to another of the same kind.
void copy(const nn::TensorView& from, cv::Point from_at, const nn::TensorView& to, cv::Point to_at,
          cv::Size size, int channels) {
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      std::copy_n(from.pixel(0, from_at.y + y, from_at.x + x), channels,
                  to.pixel(0, to_at.y + y, to_at.x + x));
    }
  }
}

class Clock {
 public:
  explicit Clock(double& seconds) : seconds_(seconds) {}
  ~Clock() {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start_;
    seconds_ += took.count();
  }

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void check(const OutpaintOptions& options) {
  if (options.samples < 1) throw Error("samples", std::to_string(options.samples), "at least 1");
  if (options.refine_best < 0) {
    throw Error("completions to refine", std::to_string(options.refine_best), "0 (all) or more");
  }
  if (options.refine_best > 0 && options.until_settled) {
    throw Error("completions to refine", "a number, with samples drawn until settled",
                "one or the other: what settles is the best of those refined");
  }
}

/// The numbers of the `count` greatest scores, rising.
std::vector<int> greatest(const std::vector<double>& scores, int count) {
  std::vector<int> numbers(scores.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  std::stable_sort(numbers.begin(), numbers.end(), [&](int a, int b) {
    return scores[static_cast<std::size_t>(a)] > scores[static_cast<std::size_t>(b)];
  });
  numbers.resize(std::min(numbers.size(), static_cast<std::size_t>(count)));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace

Scorer discriminator_scorer(const models::Discriminator& network) {
  return {"discriminator", true, [&](const nn::TensorView& image, nn::Workspace& workspace) {
            float score = 0;
            network.score(image, &score, workspace);
            return static_cast<double>(score);
          }};
}

Scorer entropy_scorer(const models::Classifier& network) {
  return {"entropy", false, [&](const nn::TensorView& image, nn::Workspace& workspace) {
            const nn::Workspace::Scope scope(workspace);
            const nn::TensorView normal = workspace.take(image.shape);
            models::Classifier::normalise(image, normal);
            std::vector<float> logits(static_cast<std::size_t>(network.classes()));
            network.forward(normal, {logits.data(), {1, 1, 1, network.classes()}, logits.size()},
                            workspace);
            return entropy(logits);
          }};
}

/// What is kept of a view while its completions pass by.
struct Outpainter::View {
  const cv::Mat1b& background;
  const OutpaintOptions& options;
  Outpainted& result;
  cv::Size size;
  cv::Rect missing;       ///< the background, in whole cells
  cv::Rect changed = {};  ///< what it can change
  std::vector<float> noise = {};
  nn::Tensor combined = {};  ///< [1, h, w, 4]: the refiner's input
  nn::Tensor image = {};     ///< the refined picture of the last completion
  bool whole_done = false;
  std::vector<Completion> completions = {};
  std::vector<Signal> signals = {};
};

Outpainter::Outpainter(Networks networks) : networks_(std::move(networks)) {
  if (!networks_.autoencoder || !networks_.pixel_cnn || !networks_.refiner) {
    throw Error("outpainter", "a network is missing", "autoencoder, PixelCNN and refiner");
  }
}

void Outpainter::decode(View& view, const Completion& completion) {
  const Clock clock(view.result.report.decode_seconds);
  const nn::Workspace::Scope scope(workspace_);
  const cv::Rect part = grown(view.missing, kDecoderReach, view.size);
  const int columns = view.size.width / kCell;
  std::vector<std::int32_t> codes;
  for (int y = part.y / kCell; y < part.br().y / kCell; ++y) {
    for (int x = part.x / kCell; x < part.br().x / kCell; ++x) {
      codes.push_back(completion.codes[static_cast<std::size_t>(y * columns + x)]);
    }
  }
  const nn::TensorView decoded = workspace_.take({1, part.height, part.width, 3});
  networks_.autoencoder->decode(codes.data(), decoded, workspace_);
  for (int y = view.missing.y; y < view.missing.br().y; ++y) {
    for (int x = view.missing.x; x < view.missing.br().x; ++x) {
      if (!view.background(y, x)) continue;
      std::copy_n(decoded.pixel(0, y - part.y, x - part.x), 3, view.combined.view().pixel(0, y, x));
    }
  }
}

void Outpainter::refine(View& view) {
  const Clock clock(view.result.report.refine_seconds);
  const nn::Workspace::Scope scope(workspace_);
  const cv::Rect all(cv::Point(), view.size);
  const cv::Rect out = view.whole_done ? view.changed : all;
  const cv::Rect in = grown(out, kRefinerReach, view.size);
  const nn::TensorView input = workspace_.take({1, in.height, in.width, 4});
  const nn::TensorView output = workspace_.take({1, in.height, in.width, 3});
  copy(view.combined, in.tl(), input, {}, in.size(), 4);
  networks_.refiner->forward(input, view.noise.data(), output, workspace_);
  copy(output, out.tl() - in.tl(), view.image, out.tl(), out.size(), 3);
  view.whole_done = true;
}

void Outpainter::score(View& view, const nn::TensorView& image, const Completion& completion,
                       std::vector<Signal>& signals) {
  const Clock clock(view.result.report.score_seconds);
  std::size_t signal = 0;
  for (const Scorer& scorer : networks_.scorers) {
    signals[signal++].scores.push_back(scorer.score(image, workspace_));
  }
  if (signal < signals.size()) signals[signal].scores.push_back(completion.log_likelihood);
}

void Outpainter::refine_and_score(View& view, const std::vector<int>& numbers) {
  Outpainted& result = view.result;
  for (const int number : numbers) {
    const Completion& completion = view.completions[static_cast<std::size_t>(number)];
    decode(view, completion);
    refine(view);
    score(view, view.image, completion, view.signals);
    result.refined.push_back(number);
  }
  result.totals = totals(view.signals);
  result.best = result.refined[best_of(result.totals)];
}

/// The numbers of the completions that are worth refining.
std::vector<int> Outpainter::screened(View& view) {
  const int count = view.options.refine_best;
  if (count == 0 || static_cast<std::size_t>(count) >= view.completions.size()) {
    std::vector<int> all(view.completions.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::vector<double> likelihoods;
  std::vector<Signal> signals = view.signals;
  nn::Tensor picture({1, view.size.height, view.size.width, 3});
  for (const Completion& completion : view.completions) {
    likelihoods.push_back(completion.log_likelihood);
    if (view.options.screen == OutpaintOptions::Screen::likelihood) continue;
    decode(view, completion);
    copy(view.combined, {}, picture, {}, view.size, 3);
    score(view, picture, completion, signals);
  }
  const bool cheapest = view.options.screen == OutpaintOptions::Screen::likelihood;
  return greatest(cheapest ? likelihoods : totals(signals), count);
}

bool Outpainter::draw(View& view, Sampler& sampler) {
  const OutpaintOptions& o = view.options;
  const bool one_is_all = sampler.missing() == 0;  // then all are the same
  const int most = one_is_all ? 1 : o.samples;
  const int round = o.until_settled ? std::min(OutpaintOptions::kRound, most) : most;
  SampleOptions options;
  options.temperature = o.temperature;
  options.seed = o.seed;
  options.view = o.view;
  int& drawn = view.result.report.drawn;
  for (int leader = -1; drawn < most;) {
    const int count = std::min(round, most - drawn);
    if (o.progress) {
      options.progress = [&](double done) { return o.progress((drawn + done * count) / most); };
    }
    {
      const Clock clock(view.result.report.sample_seconds);
      std::vector<Completion> more = sampler.sample(drawn, count, options);
      if (more.empty()) return false;
      std::move(more.begin(), more.end(), std::back_inserter(view.completions));
    }
    drawn += count;
    if (!o.until_settled) break;
    std::vector<int> numbers(static_cast<std::size_t>(count));
    std::iota(numbers.begin(), numbers.end(), drawn - count);
    refine_and_score(view, numbers);
    if (view.result.best == leader && drawn >= 2 * (leader + 1)) break;
    leader = view.result.best;
  }
  if (!o.until_settled) refine_and_score(view, screened(view));
  return true;
}

std::vector<std::int32_t> Outpainter::encode(View& view, const nn::TensorView& projection) {
  const Clock clock(view.result.report.encode_seconds);
  std::vector<std::int32_t> codes(networks_.autoencoder->grid(projection.shape).pixels());
  networks_.autoencoder->encode(projection, codes.data(), workspace_);
  return codes;
}

void Outpainter::prepare(View& view, const nn::TensorView& projection) const {
  view.changed = grown(view.missing, kRefinerReach, view.size);
  view.result.report.changed = view.changed;
  view.combined = nn::Tensor({1, view.size.height, view.size.width, 4});
  copy(projection, {}, view.combined, {}, view.size, 3);
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      view.combined.view().pixel(0, y, x)[3] = view.background(y, x) ? 0.0f : 1.0f;
    }
  }
  const std::size_t count = networks_.refiner->noise_count();
  for (std::uint32_t i = 0; view.noise.size() < count; ++i) {
    const auto pair = random_normal(view.options.seed, {view.options.view, 0, i, kNoise});
    view.noise.push_back(static_cast<float>(pair[0]));
    if (view.noise.size() < count) view.noise.push_back(static_cast<float>(pair[1]));
  }
  for (const Scorer& scorer : networks_.scorers) {
    view.signals.push_back({{}, scorer.higher_is_better});
  }
  if (view.options.likelihood || networks_.scorers.empty()) view.signals.push_back({{}, true});
}

Outpainted Outpainter::run(const nn::TensorView& projection, const cv::Mat1b& background,
                           const OutpaintOptions& options) {
  check(options);
  const nn::Shape& shape = projection.shape;
  if (shape != nn::Shape{1, background.rows, background.cols, 3}) {
    throw Error("outpainter", "a projection and a background that do not fit",
                "one picture of three channels, one mask of its size");
  }
  const Order order = order_of(background, kCell);
  Outpainted result;
  View view{background, options, result, background.size(), cells_around(background)};
  view.image = nn::Tensor(shape);
  copy(projection, {}, view.image, {}, view.size, 3);
  if (view.missing.empty()) {
    result.image = std::move(view.image);
    return result;
  }
  prepare(view, projection);
  Sampler sampler(*networks_.pixel_cnn, order, encode(view, projection));
  result.report.missing_cells = sampler.missing();
  result.report.levels = sampler.levels();
  if (!draw(view, sampler)) return result;
  const Completion& best = view.completions[static_cast<std::size_t>(result.best)];
  decode(view, best);
  view.whole_done = false;
  refine(view);
  result.report.refined = static_cast<int>(result.refined.size());
  for (Signal& signal : view.signals) result.scores.push_back(std::move(signal.scores));
  result.codes = best.codes;
  result.image = std::move(view.image);
  return result;
}

}  // namespace ps::outpaint
