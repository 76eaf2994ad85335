// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/interrupt.h"
#include "apps/part.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/report.h"
#include "apps/train_data.h"
#include "apps/train_part.h"
#include "io/photo.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

using train::TrainOptions;

struct TrainArguments {
  TrainOptions options;
  std::string data;
};

void add_stage_options(CLI::App& verb, TrainArguments& a) {
  TrainOptions& o = a.options;
  verb.add_option("--data", a.data,
                  "Folder with train/ and test/, each of shards from `train-data`")
      ->required()
      ->type_name("DIR");
  verb.add_option("-o,--output", o.out, "Folder of the run; a run in it is gone on with")
      ->required()
      ->type_name("DIR");
  verb.add_option("--codes", o.codes, "Weights of a trained vqvae (pixelcnn, refine)")
      ->type_name("FILE");
  verb.add_option("--features", o.features, "LPIPS weights, for a perceptual loss (refine)")
      ->type_name("FILE");
  verb.add_option("--init", o.init, "Weights to begin with")->type_name("FILE");
  verb.add_option("--width", o.width, "Of the network; 0 = the shipped one")
      ->type_name("N")
      ->check(whole_in(0, 512));
  verb.add_option("--batch", o.batch, "Examples a step; 0 = the stage's own")
      ->type_name("N")
      ->check(whole_in(0, 4096));
  verb.add_option("--steps", o.steps, "Steps in all; 0 = the stage's own")
      ->type_name("N")
      ->check(whole_in(0, 100000000));
  verb.add_option("--stop-after", o.stop_after, "Stop after so many steps of this run; 0 = never")
      ->type_name("N")
      ->check(whole_in(0, 100000000));
  verb.add_option("--learning-rate", o.learning_rate, "At most; 0 = the stage's own")
      ->type_name("R")
      ->check(in_range(0, 1));
  verb.add_option("--frames-share", o.frames_share, "Of examples, from real frames")
      ->type_name("R")
      ->check(in_range(0, 1));
  verb.add_option("--save-every", o.save_every, "Steps from checkpoint to checkpoint")
      ->type_name("N")
      ->check(whole_in(1, 100000000));
  verb.add_option("--test-every", o.test_every, "Steps from evaluation to evaluation")
      ->type_name("N")
      ->check(whole_in(1, 100000000));
  verb.add_option("--test-count", o.test_count, "Examples of each group in an evaluation")
      ->type_name("N")
      ->check(whole_in(1, 1000000));
  verb.add_option("--device", o.device, "cpu or cuda")->type_name("DEVICE");
}

std::string words_of(const std::map<std::string, double>& values) {
  std::string words;
  for (const auto& [name, value] : values) {
    char text[96];
    std::snprintf(text, sizeof text, "%s%s %.4g", words.empty() ? "" : ", ", name.c_str(), value);
    words += text;
  }
  return words;
}

void write_sheet(const std::filesystem::path& path, const train::Sheet& sheet) {
  const auto* pixels = reinterpret_cast<const cv::Vec3f*>(sheet.rgb.data());
  Image image(sheet.height, sheet.width);
  std::copy(pixels, pixels + image.total(), image.begin());
  write_image(path, image);
}

void run_train(TrainArguments& a, const CLI::App& verb, const Context& context) {
  TrainOptions& o = a.options;
  o.train = std::filesystem::path(a.data) / "train";
  o.test = std::filesystem::path(a.data) / "test";
  if (!std::filesystem::exists(o.test)) o.test.clear();
  o.seed = context.seed;
  o.threads = context.threads;
  note_interrupts();
  const Stopwatch total;
  std::unique_ptr<Progress> bar;
  bool interrupted = false;
  const train::TrainProgress progress = [&](const train::TrainEvent& event) {
    if (!bar)
      bar = std::make_unique<Progress>(context, "train " + o.stage,
                                       static_cast<std::size_t>(event.steps));
    if (event.evaluated || context.verbose) {
      context.say("step " + std::to_string(event.step) + ": " + words_of(event.values));
      context.flush();
    }
    if (event.sheet != nullptr) write_sheet(o.out / "sheet.png", *event.sheet);
    try {
      bar->update(static_cast<std::size_t>(event.step));
    } catch (const Interrupted&) {
      interrupted = true;  // libtorch's part of the program must not be unwound
    }
    return !interrupted;
  };
  train::TrainReport done;
  function_of_part<decltype(pixelsynth_train)>("train", "pixelsynth_train")(o, progress, &done);
  bar.reset();
  Json report = {{"stage", o.stage},
                 {"output", o.out.string()},
                 {"weights", done.weights.string()},
                 {"steps", done.steps},
                 {"parameters", done.parameters},
                 {"images_per_second", done.images_per_second},
                 {"scores", done.scores}};
  write_json(o.out / "settings.json", settings_of(verb, context));
  add_costs(report, total);
  write_json(o.out / "report.json", report);
  char what[96];
  std::snprintf(what, sizeof what, "%s, step %lld, %.1f images/s", o.stage.c_str(),
                static_cast<long long>(done.steps), done.images_per_second);
  end_run(context, report, o.out.string(), what);
  if (interrupted) throw Interrupted("interrupted; the same command goes on from the checkpoint");
}

}  // namespace

void add_train(CLI::App& program, const Context& context) {
  auto* train = program.add_subcommand("train", "Makes examples, and trains the networks on them.");
  train->require_subcommand(1);
  add_train_data(*train, context);
  const std::map<std::string, std::string> stages = {
      {"classifier", "What kind of room it is, for the entropy signal."},
      {"vqvae", "The autoencoder: pictures as codes and back."},
      {"depth", "The depth network, on true depth or poses."},
      {"refine", "The refinement network and the discriminator; needs --codes."},
      {"pixelcnn", "The autoregressive model of codes; needs --codes."}};
  for (const auto& [name, what] : stages) {
    auto* verb = train->add_subcommand(name, what);
    auto a = std::make_shared<TrainArguments>();
    a->options.stage = name;
    add_stage_options(*verb, *a);
    if (name == "depth") {
      verb->add_option(
              "--supervision", a->options.supervision,
              "What it learns from: true depth where it is known, poses (the other view of "
              "a pair, reprojected), or both")
          ->type_name("WHAT")
          ->check(CLI::IsMember({"depth", "poses", "both"}));
    }
    verb->callback([a, verb, &context] { run_train(*a, *verb, context); });
  }
}

}  // namespace ps::apps
