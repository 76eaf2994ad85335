// SPDX-License-Identifier: BSD-3-Clause
// How fast each stage trains, and how much of that time its products take: were everything else
// free, it would be as many times as fast as the share is below 1.
#include <ATen/record_function.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "libps/core/clock.h"
#include "libps/core/error.h"
#include "libps/train/train.h"

namespace {

using ps::Instant;

/// Seconds in libtorch's outermost operators, by name, and in its products wherever they are.
std::map<std::string, double> operator_seconds;
double product_seconds = 0;
std::mutex guard;

struct Since : at::ObserverContext {
  Instant start = ps::now();
  bool operator_is_outermost = false, product_is_outermost = false;
};

bool is_product(const char* name) {
  static const std::set<std::string> products = {"aten::convolution", "aten::convolution_backward",
                                                 "aten::mm", "aten::bmm", "aten::addmm"};
  return products.count(name) > 0;
}

void watch_operators() {
  thread_local static int operators = 0, products = 0;
  at::addGlobalCallback(
      at::RecordFunctionCallback(
          [](const at::RecordFunction& f) -> std::unique_ptr<at::ObserverContext> {
            auto since = std::make_unique<Since>();
            since->operator_is_outermost = operators++ == 0;
            since->product_is_outermost = is_product(f.name()) && products++ == 0;
            return since;
          },
          [](const at::RecordFunction& f, at::ObserverContext* context) {
            const auto* since = static_cast<Since*>(context);
            const double seconds = ps::seconds_since(since->start);
            --operators;
            if (is_product(f.name())) --products;
            const std::lock_guard<std::mutex> lock(guard);
            if (since->operator_is_outermost) operator_seconds[f.name()] += seconds;
            if (since->product_is_outermost) product_seconds += seconds;
          })
          .scopes({at::RecordScope::FUNCTION, at::RecordScope::BACKWARD_FUNCTION}));
}

void print_costliest(int count, int steps) {
  std::vector<std::pair<double, std::string>> all;
  for (const auto& [name, seconds] : operator_seconds) all.push_back({seconds, name});
  std::sort(all.rbegin(), all.rend());
  all.resize(std::min(all.size(), static_cast<std::size_t>(count)));
  for (const auto& [seconds, name] : all) {
    std::printf("    %8.2f ms a step  %s\n", 1e3 * seconds / steps, name.c_str());
  }
}

/// Of runs' files; gone with the object.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("bench_train-" + std::to_string(::getpid()));
  ~Folder() { std::filesystem::remove_all(path); }
};

struct Speed {
  int batch = 0;
  double images_per_second = 0, products = 0;
};

Speed speed_of(ps::train::TrainOptions options, int steps, int warm_up) {
  options.steps = options.stop_after = warm_up + steps;
  options.test_every = options.save_every = 1 << 20;
  Instant start = ps::now();
  double seconds = 0;
  const auto progress = [&](const ps::train::TrainEvent& event) {
    if (event.evaluated) return true;
    if (event.step == warm_up) {
      operator_seconds.clear();
      product_seconds = 0;
      start = ps::now();
    }
    seconds = ps::seconds_since(start);
    return true;
  };
  std::filesystem::remove_all(options.out);  // else the stage before would be gone on with
  const int batch = ps::train::train(options, progress).batch;
  return {batch, steps * batch / seconds, product_seconds / seconds};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Speed of training, and its products' share of the time");
  ps::train::TrainOptions options;
  std::string codes = "data/weights/vqvae.safetensors", features;
  std::vector<std::string> stages = ps::train::stage_names();
  int steps = 40, warm_up = 10, costliest = 0;
  app.add_option("--data", options.train, "Folder of examples, as `train data` writes to train/")
      ->required();
  app.add_option("--stages", stages, "Names with commas between")->delimiter(',');
  app.add_option("--codes", codes, "Weights of a VQ-VAE")->capture_default_str();
  app.add_option("--features", features, "Weights of LPIPS, for refine");
  app.add_option("--arithmetic", options.arithmetic)->capture_default_str();
  app.add_option("--threads", options.threads, "0 = all");
  app.add_option("--steps", steps, "Steps that are timed; a multiple of 10")->capture_default_str();
  app.add_option("--operators", costliest, "How many of the costliest operators to tell");
  CLI11_PARSE(app, argc, argv);
  steps = std::max(steps / 10, 1) * 10;
  watch_operators();
  const Folder runs;
  options.out = runs.path;
  std::printf("%-12s %6s %16s %20s\n", "stage", "batch", "images a second", "share of products");
  for (const std::string& stage : stages) {
    options.stage = stage;
    options.codes = stage == "pixelcnn" || stage == "refine" ? codes : "";
    options.features = stage == "refine" ? features : "";
    try {
      const Speed speed = speed_of(options, steps, warm_up);
      std::printf("%-12s %6d %16.1f %18.0f %%\n", stage.c_str(), speed.batch,
                  speed.images_per_second, 100 * speed.products);
      print_costliest(costliest, steps);
    } catch (const ps::Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      return 1;
    }
  }
  return 0;
}
