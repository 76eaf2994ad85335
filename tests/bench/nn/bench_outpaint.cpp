// SPDX-License-Identifier: BSD-3-Clause
// The incremental sampler at the published widths: against whole forwards, against the number of
// completions and of missing cells. See tests/bench/README.md.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "libps/core/parallel.h"
#include "libps/outpaint/outpainter.h"
#include "tests/bench/nn/peers.h"
#include "tests/support/random_weights.h"

namespace ps::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSide = 256;
constexpr double kReferencePeak = 189;

/// A view that turned to the right: cells of columns from the right end on are missing, `cells` in
/// all.
outpaint::Order right_side(int cells) {
  cv::Mat1b background(kSide, kSide, std::uint8_t{0});
  for (int i = 0; i < cells; ++i) {
    background(cv::Rect(8 * (31 - i / 32), 8 * (i % 32), 8, 8)) = 1;
  }
  return outpaint::order_of(background);
}

std::vector<std::int32_t> some_codes() {
  std::vector<std::int32_t> codes;
  for (int i = 0; i < 1024; ++i) codes.push_back(i * 7 % 512);
  return codes;
}

struct Timed {
  double seconds = 0;
  double mib = 0;
};

/// Everything from the codes of a view on, with memory that is there already.
Timed time_sampler(const models::PixelCnn& net, int cells, int completions) {
  const outpaint::Order order = right_side(cells);
  Timed timed;
  outpaint::Sampler warm(net, order, some_codes());
  warm.sample(0, completions);
  timed.mib = static_cast<double>(warm.bytes()) / (1 << 20);
  timed.seconds = fastest(completions > 100 ? 1 : 3, [&] {
    outpaint::Sampler sampler(net, order, some_codes());
    sampler.sample(0, completions);
  });
  return timed;
}

void print(const char* what, int cells, int completions, const Timed& timed) {
  std::printf("%-14s %4d cells, %4d completions: %7.3f s  %6.0f MiB\n", what, cells, completions,
              timed.seconds, timed.mib);
}

Json row(int cells, int completions, const Timed& timed) {
  return {{"cells", cells},
          {"completions", completions},
          {"seconds", timed.seconds},
          {"mib", timed.mib}};
}

Json against_whole_forwards(const models::PixelCnn& net, double scale) {
  const outpaint::Order order = right_side(450);
  const auto codes = some_codes();
  nn::Tensor logits({1, 32, 32, net.codes()});
  nn::Workspace workspace;
  const double forward =
      fastest(9, [&] { net.forward(codes.data(), order.masks, logits, workspace); });
  const Timed fifty = time_sampler(net, 450, 50), one = time_sampler(net, 450, 1);
  const double published = forward * 450 * 50;
  std::printf("one whole forward: %.1f ms; 450 cells x 50 completions of them would take %.0f s\n",
              forward * 1e3, published);
  std::printf("incremental: %.3f s (target %.2f s), ratio %.0f; %.0f MiB\n", fifty.seconds,
              2.0 * scale, published / fifty.seconds, fifty.mib);
  std::printf("one completion: %.3f s (target %.2f s)\n\n", one.seconds, 0.2 * scale);
  return {{"forward_ms", forward * 1e3},    {"published_seconds", published},
          {"fifty_seconds", fifty.seconds}, {"ratio", published / fifty.seconds},
          {"fifty_mib", fifty.mib},         {"one_seconds", one.seconds}};
}

/// Everything of one support view at the published widths.
Json whole_view() {
  const models::Autoencoder autoencoder(models::random_autoencoder());
  const models::PixelCnn pixel_cnn(models::random_pixel_cnn());
  const models::Refiner refiner(models::random_refiner());
  const models::Discriminator discriminator(models::random_discriminator());
  const models::Classifier classifier(models::random_classifier());
  outpaint::Outpainter painter(
      {&autoencoder,
       &pixel_cnn,
       &refiner,
       {outpaint::discriminator_scorer(discriminator), outpaint::entropy_scorer(classifier)}});
  nn::Tensor projection({1, kSide, kSide, 3});
  for (std::size_t i = 0; i < projection.shape().pixels() * 3; ++i) {
    projection.data()[i] = std::sin(0.01f * static_cast<float>(i % 3001));
  }
  cv::Mat1b background(kSide, kSide, std::uint8_t{0});
  background(cv::Rect(kSide - 112, 0, 112, kSide)) = 1;
  struct Way {
    int samples, refined;
    bool region;
    const char* name;
  };
  using Screen = outpaint::OutpaintOptions::Screen;
  const std::pair<Way, Screen> ways[] = {
      {{1, 0, true, "one completion"}, Screen::unrefined},
      {{50, 0, false, "whole pictures, all refined"}, Screen::unrefined},
      {{50, 0, true, "region, all refined"}, Screen::unrefined},
      {{50, 8, false, "whole pictures, best 8 before refinement"}, Screen::unrefined},
      {{50, 8, true, "region, best 8 before refinement"}, Screen::unrefined},
      {{50, 8, true, "region, likeliest 8"}, Screen::likelihood},
  };
  Json rows = Json::array();
  painter.run(projection, background, {});  // memory is there afterwards
  for (const auto& [way, screen] : ways) {
    outpaint::OutpaintOptions options;
    options.samples = way.samples;
    options.refine_best = way.refined;
    options.region = way.region;
    options.screen = screen;
    outpaint::OutpaintReport r;
    const double seconds =
        fastest(1, [&] { r = painter.run(projection, background, options).report; });
    std::printf(
        "%-40s %2d completions, %2d refined: %6.2f s (encode %.3f, sample %.3f, decode %.3f, "
        "refine %.3f, score %.3f)\n",
        way.name, way.samples, r.refined, seconds, r.encode_seconds, r.sample_seconds,
        r.decode_seconds, r.refine_seconds, r.score_seconds);
    rows.push_back({{"way", way.name},
                    {"completions", way.samples},
                    {"refined", r.refined},
                    {"seconds", seconds},
                    {"encode", r.encode_seconds},
                    {"sample", r.sample_seconds},
                    {"decode", r.decode_seconds},
                    {"refine", r.refine_seconds},
                    {"score", r.score_seconds}});
  }
  return rows;
}

/// How often the best of 50 is among the few that a cheaper score lets through to the refiner. Half
/// the published widths; weights by chance, so that a score knows nothing but what the networks
/// share.
Json screens() {
  const models::Autoencoder autoencoder(models::random_autoencoder(64, 32, 16));
  const models::PixelCnn pixel_cnn(models::random_pixel_cnn(40));
  const models::Refiner refiner(models::random_refiner(32));
  const models::Discriminator discriminator(models::random_discriminator(32));
  const models::Classifier classifier(models::random_classifier(32));
  outpaint::Outpainter painter(
      {&autoencoder,
       &pixel_cnn,
       &refiner,
       {outpaint::discriminator_scorer(discriminator), outpaint::entropy_scorer(classifier)}});
  constexpr int kViews = 12, kKept = 8;
  int by_likelihood = 0, by_unrefined = 0;
  for (int i = 0; i < kViews; ++i) {
    nn::Tensor projection({1, kSide, kSide, 3});
    for (std::size_t k = 0; k < projection.shape().pixels() * 3; ++k) {
      projection.data()[k] =
          std::sin(0.01f * static_cast<float>(k % static_cast<std::size_t>(2000 + 321 * i)));
    }
    cv::Mat1b background(kSide, kSide, std::uint8_t{0});
    background(cv::Rect(i % 2 ? 0 : kSide - 112, 0, 112, kSide)) = 1;
    outpaint::OutpaintOptions options;
    options.seed = static_cast<std::uint64_t>(i);
    const int best = painter.run(projection, background, options).best;
    options.refine_best = kKept;
    options.screen = outpaint::OutpaintOptions::Screen::likelihood;
    const auto likely = painter.run(projection, background, options).refined;
    options.screen = outpaint::OutpaintOptions::Screen::unrefined;
    const auto unrefined = painter.run(projection, background, options).refined;
    by_likelihood += std::count(likely.begin(), likely.end(), best) > 0;
    by_unrefined += std::count(unrefined.begin(), unrefined.end(), best) > 0;
  }
  std::printf(
      "the best of 50 is among the %d refined: %d of %d views by likelihood, %d by the unrefined "
      "picture "
      "(by chance: %.1f)\n",
      kKept, by_likelihood, kViews, by_unrefined, kViews * kKept / 50.0);
  return {{"views", kViews},
          {"kept", kKept},
          {"likelihood", by_likelihood},
          {"unrefined", by_unrefined}};
}

double peak_memory_mib() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// A process that samples and does nothing else, so that its peak memory is the sampler's.
void memory_of(int completions) {
  const models::PixelCnn net(models::random_pixel_cnn());
  const outpaint::Order order = right_side(450);
  const double before = peak_memory_mib();
  outpaint::Sampler sampler(net, order, some_codes());
  sampler.sample(0, completions);
  std::printf("450 cells, %d completions: peak %.0f MiB, %.0f of them before it began\n",
              completions, peak_memory_mib(), before);
}

void run(const std::string& json_file, const std::string& only) {
  const auto wanted = [&](const char* part) { return only.empty() || only == part; };
  const Peak blas = peak_of_openblas(), eigen = peak_of_eigen();
  const Peak& peak = blas.gflops > eigen.gflops ? blas : eigen;
  std::printf("sgemm 2048^3, %s: %.0f GFLOP/s, %d threads\n", peak.name.c_str(), peak.gflops,
              threads());
  Json json = {{"sgemm", peak.name}, {"sgemm_gflops", peak.gflops}, {"threads", threads()}};
  const models::PixelCnn net(models::random_pixel_cnn());
  if (wanted("headline")) {
    json["headline"] = against_whole_forwards(net, kReferencePeak / peak.gflops);
  }
  const auto time = [&](const char* part, int cells, int completions) {
    const Timed timed = time_sampler(net, cells, completions);
    print(part, cells, completions, timed);
    json[part].push_back(row(cells, completions, timed));
  };
  if (wanted("by_completions")) {
    for (const int n : {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000}) time("by_completions", 450, n);
  }
  if (wanted("by_cells")) {
    for (const int n : {0, 1, 10, 32, 64, 128, 256, 450, 700, 1024}) time("by_cells", n, 50);
  }
  if (wanted("whole_view")) json["whole_view"] = whole_view();
  if (wanted("screens")) json["screens"] = screens();
  if (!json_file.empty()) std::ofstream(json_file) << json.dump(1) << '\n';
}

}  // namespace
}  // namespace ps::bench

int main(int argc, char** argv) {
  CLI::App app("Times the sampler and a whole view.");
  std::string json, only;
  int memory = 0;
  app.add_option("--json", json, "File to write");
  app.add_option("--only", only, "headline, by_completions, by_cells, whole_view or screens");
  app.add_option("--memory", memory, "Only the peak memory of so many completions");
  CLI11_PARSE(app, argc, argv);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // minutes pass: what is measured is told at once
  if (memory > 0) {
    ps::bench::memory_of(memory);
  } else {
    ps::bench::run(json, only);
  }
}
