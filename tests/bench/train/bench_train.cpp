// SPDX-License-Identifier: BSD-3-Clause
// How fast each stage trains, and how much of that time its products take: were everything else
// free, it would be as many times as fast as the share is below 1.
#include <ATen/record_function.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

#include "libps/core/clock.h"
#include "libps/core/error.h"
#include "libps/train/train.h"

namespace {

using ps::Instant;

std::atomic<std::int64_t> product_nanoseconds{0};

struct Since : at::ObserverContext {
  Instant start = ps::now();
};

/// Adds up the time of libtorch's outermost products, forwards and backwards.
void watch_products() {
  static const std::set<std::string> products = {"aten::convolution", "aten::convolution_backward",
                                                 "aten::bmm", "aten::mm", "aten::addmm"};
  thread_local static int depth = 0;
  at::addGlobalCallback(
      at::RecordFunctionCallback(
          [](const at::RecordFunction& f) -> std::unique_ptr<at::ObserverContext> {
            if (products.count(f.name()) == 0 || depth++ > 0) return nullptr;
            return std::make_unique<Since>();
          },
          [](const at::RecordFunction& f, at::ObserverContext* context) {
            if (products.count(f.name()) == 0) return;
            --depth;
            if (context == nullptr) return;
            const double seconds = ps::seconds_since(static_cast<Since*>(context)->start);
            product_nanoseconds += static_cast<std::int64_t>(seconds * 1e9);
          })
          .scopes({at::RecordScope::FUNCTION}));
}

struct Speed {
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
      product_nanoseconds = 0;
      start = ps::now();
    }
    seconds = ps::seconds_since(start);
    return true;
  };
  ps::train::train(options, progress);
  const double products = static_cast<double>(product_nanoseconds) * 1e-9;
  return {steps * options.batch / seconds, products / seconds};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Speed of training, and its products' share of the time");
  ps::train::TrainOptions options;
  std::string codes = "data/weights/vqvae.safetensors",
              stages = "vqvae depth classifier refine pixelcnn";
  std::string features;
  int steps = 40, warm_up = 10;
  app.add_option("--data", options.train, "Folder of examples, as `train data` writes to train/")
      ->required();
  app.add_option("--stages", stages, "Names with spaces between")->capture_default_str();
  app.add_option("--codes", codes, "Weights of a VQ-VAE")->capture_default_str();
  app.add_option("--features", features, "Weights of LPIPS, for refine");
  app.add_option("--arithmetic", options.arithmetic)->capture_default_str();
  app.add_option("--threads", options.threads, "0 = all");
  app.add_option("--steps", steps, "Steps that are timed; a multiple of 10")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  steps = std::max(steps / 10, 1) * 10;
  watch_products();
  std::printf("%-12s %6s %16s %20s\n", "stage", "batch", "images a second", "share of products");
  for (const std::string& stage : CLI::detail::split(stages, ' ')) {
    options.stage = stage;
    options.codes = stage == "pixelcnn" || stage == "refine" ? codes : "";
    options.features = stage == "refine" ? features : "";
    options.batch = stage == "vqvae"        ? 24
                    : stage == "classifier" ? 32
                    : stage == "pixelcnn"   ? 16
                                            : 8;
    options.out =
        std::filesystem::temp_directory_path() / ("bench_train-" + std::to_string(::getpid()));
    try {
      const Speed speed = speed_of(options, steps, warm_up);
      std::printf("%-12s %6d %16.1f %18.0f %%\n", stage.c_str(), options.batch,
                  speed.images_per_second, 100 * speed.products);
    } catch (const ps::Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      return 1;
    }
    std::filesystem::remove_all(options.out);
  }
  return 0;
}
