// SPDX-License-Identifier: BSD-3-Clause
// score_cloud CLOUD --walk DIR: how well a fused cloud tells of the frames that were left out of
// it. Prints one JSON object. The truth is every pixel with a depth of those frames, lifted,
// unfiltered.
#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "held_out.h"
#include "io/cloud_file.h"
#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/cloud_metrics.h"
#include "libps/eval/depth_metrics.h"
#include "libps/eval/image_metrics.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/splat.h"

namespace ps {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string cloud;
  std::string walk;
  std::size_t hold_out = 10;
  std::vector<double> thresholds = {0.01, 0.02};
  std::vector<float> radii = {2, 4};
  int threads = 0;
  bool per_view = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Adds up figures by name; a figure that is NaN (a view without pixels) counts in no mean.
class Means {
 public:
  void add(const Json& figures) {
    for (const auto& [name, value] : figures.items()) {
      if (!value.is_number() || std::isnan(value.get<double>())) continue;
      Entry& entry = entries_[name];
      entry.sum += value.get<double>();
      ++entry.count;
    }
  }

  Json json() const {
    Json out;
    for (const auto& [name, entry] : entries_) out[name] = entry.sum / entry.count;
    return out;
  }

 private:
  struct Entry {
    double sum = 0;
    int count = 0;
  };
  nlohmann::ordered_map<std::string, Entry> entries_;
};

void put(Json& figures, const std::string& name, const DepthErrors& errors) {
  figures[name + "_median_rel"] = errors.median_rel;
  figures[name + "_abs_rel"] = errors.abs_rel;
  figures[name + "_rmse"] = errors.rmse;
  figures[name + "_delta1"] = errors.delta[0];
}

/// Compares one rendered view with the photo and depth that were left out, where the cloud hits and
/// the true depth is known; `hit` is the share of the known pixels that the cloud hits.
Json view_figures(const Cloud& cloud, const View& view, float radius) {
  SplatOptions options;
  options.radius = radius;
  options.renormalise = true;
  const Splat splatted = splat(cloud, view.intrinsics, view.world_from_cam, options);
  const Mask known = view.depth > 0;
  const Mask visible = known & (splatted.hit > 0);
  Json figures;
  figures["hit"] = static_cast<double>(cv::countNonZero(visible)) / cv::countNonZero(known);
  figures["psnr"] = psnr(splatted.color, view.color, visible);
  figures["ssim"] = ssim(splatted.color, view.color, visible);
  put(figures, "first", depth_errors(splatted.first_depth, view.depth, visible));
  put(figures, "expected", depth_errors(splatted.expected_depth, view.depth, visible));
  return figures;
}

Json score_views(const Cloud& cloud, const RgbdFolder& folder, const std::vector<RgbdFrame>& frames,
                 const Options& options) {
  std::vector<Means> means(options.radii.size());
  Json per_view = Json::array();
  for (const RgbdFrame& frame : frames) {
    const View view = load_frame(folder, frame);
    for (std::size_t r = 0; r < options.radii.size(); ++r) {
      Json figures = view_figures(cloud, view, options.radii[r]);
      means[r].add(figures);
      if (options.per_view) {
        figures["radius"] = options.radii[r];
        figures["timestamp"] = frame.timestamp;
        per_view.push_back(std::move(figures));
      }
    }
  }
  Json out;
  for (std::size_t r = 0; r < means.size(); ++r) {
    Json mean = means[r].json();
    mean["radius"] = options.radii[r];
    out["views"].push_back(std::move(mean));
  }
  if (options.per_view) out["per_view"] = std::move(per_view);
  return out;
}

Cloud true_cloud(const RgbdFolder& folder, const std::vector<RgbdFrame>& frames) {
  Cloud truth;
  for (const RgbdFrame& frame : frames) {
    const View view = load_frame(folder, frame);
    truth += lift(view, view.depth > 0, 0, Origin::observed);
  }
  return truth;
}

Json score(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  set_threads(options.threads);
  const Cloud cloud = read_cloud(options.cloud);
  const RgbdFolder folder = open_rgbd_folder(options.walk);
  const std::vector<RgbdFrame> frames = chosen_frames(folder, options.hold_out, true);
  if (frames.empty())
    throw Error("--hold-out", "no frame is left out", "1 or more, below the number of frames");

  Json out;
  out["cloud"] = options.cloud;
  out["points"] = cloud.size();
  out["held_out_frames"] = frames.size();
  const Cloud truth = true_cloud(folder, frames);
  out["true_points"] = truth.size();
  for (const CloudScore& score : cloud_scores(cloud, truth, options.thresholds)) {
    out["cloud_scores"].push_back({{"threshold", score.threshold},
                                   {"accuracy", score.accuracy},
                                   {"completeness", score.completeness},
                                   {"f_score", score.f_score}});
  }
  out["cloud_seconds"] = seconds_since(start);
  out.update(score_views(cloud, folder, frames, options));
  out["seconds"] = seconds_since(start);
  return out;
}

}  // namespace
}  // namespace ps

int main(int argc, char** argv) {
  ps::Options options;
  CLI::App app{
      "Scores a fused cloud against the frames of an RGB-D folder that were left out of it"};
  app.add_option("cloud", options.cloud, "PLY or PCD")->required();
  app.add_option("--walk", options.walk, "RGB-D folder")->required();
  app.add_option("--hold-out", options.hold_out,
                 "every N-th frame (index % N == N / 2) was left out");
  app.add_option("--thresholds", options.thresholds, "metres, for the cloud's scores");
  app.add_option("--radius", options.radii, "pixels, one or more, for the rendered views");
  app.add_option("--threads", options.threads, "0 = one for each core");
  app.add_flag("--per-view", options.per_view, "also list every view's figures");
  CLI11_PARSE(app, argc, argv);
  try {
    std::cout << ps::score(options).dump(1) << std::endl;
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "score_cloud: " << error.what() << std::endl;
    return 1;
  }
}
