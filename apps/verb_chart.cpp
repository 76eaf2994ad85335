// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/chart_knobs.h"
#include "apps/chart_page.h"
#include "apps/chart_samples.h"
#include "apps/display.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "io/photo.h"
#include "libps/core/words.h"

namespace ps::apps {
namespace {

using Path = std::filesystem::path;

struct ChartArguments {
  FramesArguments frames;
  std::string output;
  ChartKnobOptions knobs;
  std::string size = "small";
  int views = 0, side = 0;  ///< 0 = by size
};

/// What --size stands for.
struct ChartSize {
  int views, side;
};
constexpr ChartSize kSmall = {6, 384}, kFull = {24, 512};

ChartSize size_of(const ChartArguments& a) {
  ChartSize size = a.size == "full" ? kFull : kSmall;
  if (a.views > 0) size.views = a.views;
  if (a.side > 0) size.side = a.side;
  return size;
}

std::vector<KnobChart> measured(const ChartKnobs& knobs, const ChartSamples& samples,
                                const BootstrapOptions& bootstrap, const Context& context) {
  std::optional<Progress> progress;
  MeasureOptions options;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (!progress) progress.emplace(context, "chart", total);
    progress->update(done);
  };
  const auto load = [&](std::size_t i) {
    throw_if_interrupted();
    KnobSample sample = samples.load(i);
    knobs.complete(sample);
    return sample;
  };
  std::vector<KnobResult> results = measure(knobs.knobs(), samples.count, load, options);
  std::vector<KnobChart> charts;
  for (std::size_t k = 0; k < results.size(); ++k) {
    charts.push_back(chart_of(knobs.knobs()[k], std::move(results[k]), bootstrap));
  }
  return charts;
}

/// The files of a knob.
std::vector<std::string> knob_files(const std::string& knob) {
  return {knob + ".png", knob + ".svg", knob + ".samples.csv"};
}

void write_charts(OutputFolder& folder, const std::vector<KnobChart>& charts,
                  const BootstrapOptions& bootstrap, const std::string& about) {
  std::vector<Image> pictures;
  for (const KnobChart& chart : charts) {
    throw_if_interrupted();
    const ChartPicture picture = picture_of(chart);
    pictures.push_back(chart_image(picture));
    const std::vector<std::string> files = knob_files(chart.knob.name);
    folder.write(files[0], [&](const Path& file) { write_image(file, pictures.back()); });
    folder.write(files[1], [&](const Path& file) { write_chart_svg(file, picture); });
    folder.write(files[2], [&](const Path& file) { write_text(file, to_csv(chart.result.table)); });
  }
  folder.write("chart.png", [&](const Path& file) { write_image(file, grid_of(pictures, 2)); });
  folder.write("chart.csv", [&](const Path& file) { write_text(file, to_csv(charts)); });
  folder.write("index.html",
               [&](const Path& file) { write_text(file, html_of(charts, bootstrap, about)); });
}

std::string about_line(const Json& machine, const ChartSamples& samples, const Context& context) {
  return "pixelsynth " PS_VERSION ", data " + samples.report["data"].get<std::string>() +
         ", pairs of views " + std::to_string(samples.count) + ", seed " +
         std::to_string(context.seed) + ", threads " + machine["threads"].dump() + ", " +
         machine["processor"].get<std::string>() + ", load before " + machine["load_before"].dump();
}

void run_chart(const ChartArguments& a, const CLI::App& verb, const Context& context) {
  const ChartSize size = size_of(a);
  note_interrupts();
  const Stopwatch total;
  OutputFolder folder(a.output);
  for (const std::string& knob : knob_names()) folder.clears(knob_files(knob));
  const ChartKnobs knobs(a.knobs, context);
  const auto views = static_cast<std::size_t>(size.views);
  const ChartSamples samples = a.frames.data.empty() ? room_samples(views, size.side, context)
                                                     : frame_samples(a.frames, views, context);
  const Display display(Display::Need::picture);  // fails before the work
  const Json machine = machine_report();
  const BootstrapOptions bootstrap = bootstrap_of(context);
  const std::vector<KnobChart> charts = measured(knobs, samples, bootstrap, context);
  write_charts(folder, charts, bootstrap, about_line(machine, samples, context));
  Json report = {{"settings", settings_of(verb, context)},
                 {"machine", machine},
                 {"samples", samples.report},
                 {"knobs", to_json(charts)}};
  add_costs(report, total);
  folder.write("chart.json", [&](const Path& file) { write_json(file, report); });
  throw_if_interrupted();
  folder.commit();
  std::string text;
  for (const KnobChart& chart : charts) text += text_of(summary_of(chart, bootstrap)) + "\n";
  if (!context.json) print_text(text + "* default, + on the Pareto front\n");
  end_run(context, report, a.output,
          counted(charts.size(), "knob") + " on " +
              counted(samples.count, "pair of views", "pairs of views"));
}

void add_options(CLI::App& verb, ChartArguments& a) {
  a.frames.add_to(verb, "views of procedural rooms that nothing was trained on");
  verb.add_option(
          "-o,--output", a.output,
          "Folder: index.html, chart.png, chart.csv, chart.json, and of each knob a PNG, an "
          "SVG and the scores of every sample")
      ->required()
      ->type_name("DIR");
  add_names(verb, "--knobs", a.knobs.names, "Some of them", knob_names());
  verb.add_option(
          "--size", a.size,
          "small: 6 pairs of views, within five minutes on two cores; full: 24 larger ones, "
          "within twenty")
      ->type_name("SIZE")
      ->check(CLI::IsMember({"small", "full"}));
  verb.add_option("--views", a.views, "Other than --size has it: pairs of views")
      ->type_name("N")
      ->default_str("")
      ->check(whole_in(1, 1000));
  verb.add_option("--side", a.side, "Other than --size has it: pixels of views of rooms")
      ->type_name("PX")
      ->default_str("")
      ->check(whole_in(64, 2048));
  verb.add_option("--weights", a.knobs.weights,
                  "Weights: one file of all networks, or a folder (default: those that come with "
                  "the program)")
      ->type_name("FILE|DIR");
  verb.add_option("--widths", a.knobs.widths,
                  "Folder of depth-*.safetensors, depth networks of several widths, for the knob "
                  "width, which is left out else")
      ->type_name("DIR");
  add_lpips_option(verb, a.knobs.lpips,
                   " of whole pictures: in the knobs samples, guidance and selection alone");
}

}  // namespace

void add_chart(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "chart",
      "Accuracy against time on this machine for each knob: what settings cost and give, with 95 % "
      "intervals, the Pareto front, and the default marked. Accuracy is against true views (exact "
      "ones of rooms, or frames that were left out); settings take turns, so that what else the "
      "machine does hits all alike. A table on the terminal, pictures in a folder, and a page that "
      "shows what is behind each dot.");
  auto a = std::make_shared<ChartArguments>();
  add_options(*verb, *a);
  verb->callback([a, verb, &context] { run_chart(*a, *verb, context); });
}

}  // namespace ps::apps
