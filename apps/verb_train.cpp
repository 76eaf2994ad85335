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
#include "libps/core/words.h"

namespace ps::apps {
namespace {

namespace fs = std::filesystem;
using train::TrainOptions;

struct TrainArguments {
  TrainOptions options;
  std::string data, width = "0";
};

constexpr std::uint64_t kManySteps = 100000000;

/// What every stage takes, and `all` passes on to every stage.
void add_common_options(CLI::App& verb, TrainArguments& a) {
  TrainOptions& o = a.options;
  const auto path = [&](const char* name, auto& value, const char* what, const char* type) {
    return verb.add_option(name, value, what)->type_name(type);
  };
  const auto whole = [&](const char* name, auto& value, const char* what, std::uint64_t low,
                         std::uint64_t high) {
    return verb.add_option(name, value, what)->type_name("N")->check(whole_in(low, high));
  };
  path("--data", a.data, "Folder with train/ and test/, each of shards from `train data`", "DIR")
      ->required();
  path("-o,--output", o.out, "Folder of the run; a run in it is gone on with", "DIR")->required();
  path("--features", o.features, "LPIPS weights, for a perceptual loss (refine)", "FILE");
  verb.add_option("--width", a.width,
                  "Of the network: channels, or paper = the published ones; 0 = the shipped ones")
      ->type_name("N|paper")
      ->check(whole_in(0, 512) | CLI::IsMember({"paper"}));
  whole("--batch", o.batch, "Examples a step; 0 = the stage's own", 0, 4096);
  verb.add_option("--steps-scale", o.steps_scale, "Of the stage's own steps")
      ->type_name("R")
      ->check(in_range(1e-6, 1000));
  verb.add_option("--frames-share", o.frames_share, "Of examples, from real frames")
      ->type_name("R")
      ->check(in_range(0, 1));
  whole("--save-every", o.save_every, "Steps from checkpoint to checkpoint", 1, kManySteps);
  whole("--test-every", o.test_every, "Steps from evaluation to evaluation", 1, kManySteps);
  whole("--test-count", o.test_count, "Examples of each group in an evaluation", 1, 1000000);
  path("--device", o.device, "cpu or cuda", "DEVICE");
  verb.add_option("--arithmetic", o.arithmetic,
                  "Of convolutions' products: f32, or bf16, faster where the processor has "
                  "AMX")
      ->type_name("TYPE")
      ->check(CLI::IsMember({"f32", "bf16"}));
}

void add_depth_options(CLI::App& verb, TrainOptions& o) {
  verb.add_option("--supervision", o.supervision,
                  "What teaches depth: true depth where it is known, poses (the other view of a "
                  "pair, reprojected), or both")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"depth", "poses", "both"}));
}

void add_pair_options(CLI::App& verb, TrainOptions& o) {
  verb.add_option("--curriculum", o.curriculum,
                  "Steps in which the rotation between views grows to all; 0 = all from the "
                  "beginning")
      ->type_name("N")
      ->default_str("refine 5, else 0")
      ->check(whole_in(0, 1000));
}

/// What one stage alone takes.
void add_stage_options(CLI::App& verb, TrainOptions& o) {
  const bool coded = o.stage == "pixelcnn" || o.stage == "refine";
  const auto whole = [&](const char* name, auto& value, const char* what) {
    verb.add_option(name, value, what)->type_name("N")->check(whole_in(0, kManySteps));
  };
  if (coded) {
    verb.add_option("--codes", o.codes, "Weights of a trained vqvae, or the colours of cells")
        ->type_name("FILE|colours")
        ->required();
  }
  auto* init = verb.add_option("--init", o.init, "Weights to begin with")->type_name("FILE");
  if (o.stage == "vqvae") {
    verb.add_flag("--keep-codes", o.keep_codes,
                  "Train the decoder of --init alone: what was trained on its codes stays true")
        ->needs(init);
  }
  whole("--steps", o.steps, "Steps in all; 0 = the stage's own");
  whole("--stop-after", o.stop_after, "Stop after so many steps of this run; 0 = never");
  verb.add_option("--learning-rate", o.learning_rate, "At most; 0 = the stage's own")
      ->type_name("R")
      ->check(in_range(0, 1));
  if (o.stage == "depth") add_depth_options(verb, o);
  if (coded || o.stage == "depth") add_pair_options(verb, o);
}

std::string words_of(const std::map<std::string, double>& values) {
  std::string words;
  for (const auto& [name, value] : values) {
    words += (words.empty() ? "" : ", ") + name + " " + in_digits(value, 4);
  }
  return words;
}

void write_sheet(const fs::path& path, const train::Sheet& sheet) {
  const auto* pixels = reinterpret_cast<const cv::Vec3f*>(sheet.rgb.data());
  Image image(sheet.height, sheet.width);
  std::copy(pixels, pixels + image.total(), image.begin());
  write_image(path, image);
}

/// Fills in what does not stand in options of that name.
void resolve(TrainArguments& a, const Context& context) {
  TrainOptions& o = a.options;
  o.train = fs::path(a.data) / "train";
  o.test = fs::path(a.data) / "test";
  if (!fs::exists(o.test)) o.test.clear();
  o.width = a.width == "paper" ? train::kPaperWidth : std::stoi(a.width);
  o.seed = context.seed;
  o.threads = context.threads;
}

/// Trains one stage and writes what its folder says of it.
Json run_stage(const TrainOptions& o, const CLI::App& verb, const Context& context) {
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
  if (interrupted) throw Interrupted("interrupted; the same command goes on from the checkpoint");
  return report;
}

std::string words_of_run(const Json& report) {
  char what[96];
  std::snprintf(what, sizeof what, "%s, step %lld, %.1f images/s",
                report["stage"].get<std::string>().c_str(),
                static_cast<long long>(report["steps"].get<std::int64_t>()),
                report["images_per_second"].get<double>());
  return what;
}

void run_train(TrainArguments& a, const CLI::App& verb, const Context& context) {
  resolve(a, context);
  note_interrupts();
  const Json report = run_stage(a.options, verb, context);
  end_run(context, report, a.options.out.string(), words_of_run(report));
}

/// One stage after another, in the order in which they need each other.
void run_all(TrainArguments& a, const CLI::App& verb, const Context& context) {
  resolve(a, context);
  note_interrupts();
  const Stopwatch total;
  const fs::path runs = a.options.out;
  Json report = {{"output", runs.string()}, {"stages", Json::object()}};
  for (const char* stage : {"vqvae", "depth", "refine", "pixelcnn", "classifier"}) {
    TrainOptions o = a.options;
    o.stage = stage;
    o.out = runs / stage;
    o.codes = runs / "vqvae" / "weights.safetensors";
    const Json done = run_stage(o, verb, context);
    context.say(o.out.string() + ": " + words_of_run(done));
    context.flush();
    report["stages"][stage] = done;
  }
  add_costs(report, total);
  write_json(runs / "report.json", report);
  end_run(context, report, runs.string(), "five stages");
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
    add_common_options(*verb, *a);
    add_stage_options(*verb, a->options);
    verb->callback([a, verb, &context] { run_train(*a, *verb, context); });
  }
  auto* all = train->add_subcommand(
      "all",
      "vqvae, depth, refine, pixelcnn and classifier, one after another, each in a folder of its "
      "own in --output. The same command goes on after an interruption; what is finished is scored "
      "again.");
  auto a = std::make_shared<TrainArguments>();
  add_common_options(*all, *a);
  add_depth_options(*all, a->options);
  add_pair_options(*all, a->options);
  all->callback([a, all, &context] { run_all(*a, *all, context); });
}

}  // namespace ps::apps
