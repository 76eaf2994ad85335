// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/display.h"
#include "apps/interrupt.h"
#include "apps/method_models.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/stress_data.h"
#include "apps/stress_report.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/scene/stress_axes.h"

namespace ps::apps {
namespace {

struct StressArguments {
  FramesArguments frames;
  std::string output;
  std::vector<std::string> axes;
  std::string size = "small", weights;
};

/// Axes that need no networks, and those that do.
struct Axes {
  std::vector<stress::Axis> plain, photos;
};

Axes all_axes(const stress::SuiteOptions& options, const stress::NetworksSource& networks) {
  Axes all = {stress::fusion_axes(options), stress::photo_axes(options, networks)};
  for (stress::Axis& axis : stress::cloud_axes(options)) all.plain.push_back(std::move(axis));
  return all;
}

std::vector<stress::Axis> joined(Axes all) {
  std::move(all.photos.begin(), all.photos.end(), std::back_inserter(all.plain));
  return std::move(all.plain);
}

std::vector<std::string> axis_names() {
  std::vector<std::string> names;
  for (const stress::Axis& axis : joined(all_axes({}, {}))) names.push_back(axis.name);
  return names;
}

void keep(Axes* all, const std::function<bool(const stress::Axis&)>& wanted) {
  for (std::vector<stress::Axis>* axes : {&all->plain, &all->photos}) {
    axes->erase(std::remove_if(axes->begin(), axes->end(),
                               [&](const stress::Axis& axis) { return !wanted(axis); }),
                axes->end());
  }
}

Axes chosen_axes(const StressArguments& a, const stress::SuiteOptions& options,
                 const stress::NetworksSource& networks) {
  Axes all = all_axes(options, networks);
  keep(&all, [&](const stress::Axis& axis) {
    return a.axes.empty() || std::find(a.axes.begin(), a.axes.end(), axis.name) != a.axes.end();
  });
  return all;
}

/// Leaves out what DATA cannot give, and says so. Throws ps::Error when that is everything.
void leave_out(Axes* all, const std::string& name, const stress::GivenFrames& given,
               const Context& context) {
  std::string left_out;
  const auto note = [&](const std::string& axes, const std::string& why) {
    left_out += (left_out.empty() ? "" : ", ") + axes + " (" + why + ")";
  };
  keep(all, [&](const stress::Axis& axis) {
    if (!axis.rooms_alone.empty()) note(axis.name, axis.rooms_alone);
    return axis.rooms_alone.empty();
  });
  if (!all->plain.empty() && given.walks.empty()) {
    note("all of fusing and of clouds", "no world has three frames");
    all->plain.clear();
  }
  if (!all->photos.empty() && given.pairs.empty()) {
    note("all of photos", "no two frames of one world look 20 to 60 degrees apart within a metre");
    all->photos.clear();
  }
  if (left_out.empty()) return;
  if (all->plain.empty() && all->photos.empty()) {
    throw Error(name, "cannot be put under stress by " + left_out, "other --axes or frames");
  }
  context.say(name + ": left out: " + left_out);
}

std::vector<StressRow> run_axes(const std::vector<stress::Axis>& axes, OutputFolder& out,
                                const Context& context) {
  std::size_t steps = 0, done = 0;
  for (const stress::Axis& axis : axes) steps += axis.values.size() * axis.methods.size();
  Progress progress(context, "stress", steps);
  std::vector<StressRow> rows;
  for (const stress::Axis& axis : axes) {
    rows.push_back(
        {axis, stress::run_axis(axis, context.threads, [&] { progress.update(++done); })});
    write_axis_pictures(out, rows.back());
  }
  return rows;
}

void run_stress(const StressArguments& a, const CLI::App& verb, const Context& context) {
  note_interrupts();
  const Stopwatch total;
  OutputFolder out(a.output);
  for (const std::string& axis : axis_names()) out.clears(axis_files(axis));
  const Display display(Display::Need::picture);  // fails before the work
  std::unique_ptr<MethodModels> models;
  const auto networks = [&] { return models->networks(); };
  stress::SuiteOptions options =
      a.size == "full" ? stress::full_suite(context.seed) : stress::small_suite(context.seed);
  Axes axes = chosen_axes(a, options, networks);
  const StressData data =
      load_stress_data(a.frames, options, !axes.plain.empty(), !axes.photos.empty(), context);
  if (data.given) {
    options.given = data.given;
    axes = chosen_axes(a, options, networks);
    leave_out(&axes, a.frames.data, *data.given, context);
  }
  // Not when they are first needed: there an error would be the method's.
  if (!axes.photos.empty()) {
    models = std::make_unique<MethodModels>(a.weights, std::vector<std::string>{"ours"}, context);
  }
  const std::vector<StressRow> rows = run_axes(joined(axes), out, context);
  const std::string where = data.given ? a.frames.data : "procedural rooms";
  Json report = {
      {"settings", settings_of(verb, context)}, {"data", data.report}, {"axes", to_json(rows)}};
  add_costs(report, total);
  out.write("stress.json", [&](const auto& path) { write_json(path, report); });
  out.write("stress.csv", [&](const auto& path) { write_text(path, to_csv(rows)); });
  out.write("stress.md", [&](const auto& path) { write_text(path, stress_markdown(rows, where)); });
  out.commit();
  if (!context.json) print_text(breaking_table(rows));
  for (const std::string& note : stress_notes(rows)) context.say(note);
  std::size_t violations = 0;
  for (const StressRow& row : rows) violations += row.result.violations.size();
  end_run(context, report, a.output, counted(rows.size(), "axis", "axes") + " put under stress");
  if (violations > 0) {
    throw Error(a.output, counted(violations, "violation") + ", see stress.md", "none");
  }
}

}  // namespace

void add_stress(CLI::App& program, const Context& context) {
  auto* verb = program.add_subcommand(
      "stress",
      "Where things break: procedural rooms, or frames of your own, with one thing going wrong at "
      "a time, from not at all to past all use, ours beside other methods. Writes stress.md (the "
      "table of breaking points), stress.csv, stress.json, and of each axis its curves (PNG, SVG) "
      "and pictures just before and just after ours breaks, and each other method does.\n"
      "Of DATA a few frames, made smaller, take the place of the rooms': those fused are spread "
      "evenly, views between them are left out and are the truth, and so is the cloud of the "
      "undisturbed frames; photos are pairs of frames, 20 to 60 degrees apart. What only rooms "
      "can give is left out.\n"
      "Every step is also held to what must always be: no crash, everything finite, the same bytes "
      "on one thread and on two (with --threads 1 it runs on one alone), nothing observed "
      "overwritten by what was invented (beside seams, 1 % of it may be shown otherwise; of DATA, "
      "whose photos are farther apart, 10 %). Exit status 1 if any is not, after everything is "
      "written.");
  auto a = std::make_shared<StressArguments>();
  a->frames.add_to(*verb, "procedural rooms");
  verb->add_option("-o,--output", a->output, "Folder")->required()->type_name("DIR");
  add_names(*verb, "--axes", a->axes, "Of them all: these alone", axis_names());
  verb->add_option("--size", a->size, "small = minutes, full = a night")
      ->type_name("SIZE")
      ->check(CLI::IsMember({"small", "full"}));
  verb->add_option("--weights", a->weights,
                   "Folder of weights; empty = what comes with the program")
      ->type_name("DIR");
  verb->callback([a, verb, &context] { run_stress(*a, *verb, context); });
}

}  // namespace ps::apps
