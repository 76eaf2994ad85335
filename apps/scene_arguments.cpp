// SPDX-License-Identifier: BSD-3-Clause
#include "apps/scene_arguments.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "apps/program.h"
#include "apps/scene_models.h"

namespace ps::apps {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

void SceneArguments::add_view_options(CLI::App& verb) {
  add_names(verb, "--directions", directions,
            "Which of left, right, up, down, up-left, up-right, down-left, down-right",
            direction_names());
  verb.add_option("--range-horizontal", range_horizontal,
                  "How far the camera turns to the left and right: radians, or degrees as 34deg")
      ->type_name("ANGLE");
  verb.add_option("--range-vertical", range_vertical, "The same up and down")->type_name("ANGLE");
  verb.add_option("--orbit", orbit, "Turn about the point so many metres ahead; 0 = on the spot")
      ->type_name("M")
      ->check(in_range(0, 1e6));
}

void SceneArguments::add_sampling_options(CLI::App& verb) {
  verb.add_option("--samples", samples,
                  "Completions drawn for each outpainted view, the best is kept: 1 to 1000, or "
                  "auto = until more would not help, 50 at most (default; 50 with --refine-best)")
      ->type_name("N|auto");
  verb.add_option("--temperature", temperature, "Of the sampling; 0 = always the likeliest code")
      ->type_name("T")
      ->check(in_range(0, 2));
  verb.add_option("--guidance", guidance,
                  "How much the sampling is held to the nearest seen colours: 0 = not, as "
                  "published; from about 10 on, only their stripes are left")
      ->type_name("W")
      ->check(in_range(0, 1000));
  verb.add_option(
          "--refine-best", refine_best,
          "With judges that look at pictures: refine only so many completions, the best by a "
          "look at the unrefined; 0 = all")
      ->type_name("N")
      ->check(whole_in(0, 1000));
  verb.add_option(
          "--weights", weights,
          "Weights: one file of all networks, or a folder of depth, vqvae, pixelcnn, refine "
          "and classifier.safetensors (default: those that come with the program)")
      ->type_name("FILE|DIR");
}

void SceneArguments::add_outpaint_options(CLI::App& verb) {
  add_sampling_options(verb);
  verb.add_option(
          "--select", select,
          "What keeps the best completion: consensus = that which agrees most with all drawn; "
          "likelihood = the PixelCNN's likeliest; both refine that one alone. Others look at "
          "all refined: discriminator, classifier, or both (the sum of ranks, as published)")
      ->type_name("NAME")
      ->check(CLI::IsMember(selection_names()));
}

namespace {

void add_strategy_options(CLI::App& verb, SceneArguments& a) {
  verb.add_option("--support-views", a.support_views,
                  "Trajectory file of further views to outpaint, in the scene's world")
      ->type_name("FILE");
  verb.add_option("--strategy", a.strategy,
                  "support: outpaint at the extremes, splat in between; sequential: outpaint every "
                  "view, nearest first; independent: every view for itself")
      ->type_name("NAME")
      ->check(CLI::IsMember({"support", "sequential", "independent"}));
  verb.add_option("--views-per-direction", a.views_per_direction,
                  "Views on the way to each extreme, itself included")
      ->type_name("N")
      ->check(whole_in(1, 1000));
  verb.add_flag("--no-outpaint", a.no_outpaint, "Invent nothing: only what the photo shows");
}

void add_picture_options(CLI::App& verb, SceneArguments& a) {
  verb.add_option("--budget", a.budget,
                  "How many points stay: auto = no more than the views and videos can show, none = "
                  "all, points=N, or psnr=DB between the views of the thinned and the whole cloud "
                  "(default: auto, with --no-outpaint none)")
      ->type_name("BUDGET");
  verb.add_option("--view-size", a.view_size,
                  "Long side of the pictures, at most, pixels; of a photo of more than twice that, "
                  "what half a "
                  "pixel of them cannot show is left out")
      ->type_name("PX")
      ->check(whole_in(16, 8192));
  verb.add_option("--paths", a.paths,
                  "Videos to make, NAME.mp4: circle, sway, a direction, or a trajectory file")
      ->type_name("PATH,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--path-frames", a.path_frames, "Frames of each built-in path")
      ->type_name("N")
      ->check(whole_in(1, 100000));
  verb.add_option("--fps", a.frames_per_second, "Frames per second of the videos")
      ->type_name("N")
      ->check(in_range(1, 1000));
}

}  // namespace

double parse_angle(const std::string& text, const std::string& option) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const double radians = unit == "deg" ? value * kPi / 180 : value;
  const bool known = unit.empty() || unit == "rad" || unit == "deg";
  if (end == text.c_str() || !known || !(radians >= 0 && radians <= kPi + 1e-9)) {
    throw CLI::ValidationError(option, "'" + text +
                                           "' is no angle from 0 to 180 degrees; expected radians, "
                                           "as 0.6, or degrees, as 34deg");
  }
  return std::min(radians, kPi);
}

void SceneArguments::add_to(CLI::App& verb) {
  input.add_to(verb);
  verb.add_option("-o,--output", output, "Folder to write")->required()->type_name("OUT");
  add_view_options(verb);
  add_strategy_options(verb, *this);
  add_outpaint_options(verb);
  add_picture_options(verb, *this);
  verb.add_flag("--resume", resume,
                "Go on with what an interrupted run of the same command has done");
}

PlanOptions SceneArguments::plan() const {
  PlanOptions options;
  options.strategy = strategy_of(strategy);
  options.directions = directions;
  options.views_per_direction = views_per_direction;
  options.range.range_horizontal = parse_angle(range_horizontal, "--range-horizontal");
  options.range.range_vertical = parse_angle(range_vertical, "--range-vertical");
  options.range.orbit_radius = orbit;
  return options;
}

std::optional<BudgetOptions> SceneArguments::point_budget() const {
  BudgetOptions options;
  const std::string text = budget_text();
  if (text == "none") return std::nullopt;
  if (text == "auto") return options;
  const auto equals = text.find('=');
  const std::string what = text.substr(0, equals);
  char* end = nullptr;
  const double value =
      equals == std::string::npos ? 0 : std::strtod(text.c_str() + equals + 1, &end);
  const bool sound = end != nullptr && *end == '\0' && value >= 1 && value <= kNoBound;
  const bool whole = what == "points" && value == std::floor(value);
  if (!sound || !(whole || what == "psnr")) {
    throw CLI::ValidationError("--budget",
                               "'" + text + "'; expected none, auto, points=N or psnr=DB");
  }
  if (what == "points") options.points = static_cast<std::size_t>(value);
  if (what == "psnr") options.psnr = value;
  return options;
}

SceneOptions SceneArguments::scene(const Context& context) const {
  SceneOptions options;
  options.cloud.lift = input.lift;
  outpaint::OutpaintOptions& o = options.outpaint;
  const std::string number = samples_text();
  if (number == "auto") {
    o.until_settled = true;
  } else {
    char* end = nullptr;
    const long count = std::strtol(number.c_str(), &end, 10);
    if (number.empty() || *end != '\0' || count < 1 || count > 1000) {
      throw CLI::ValidationError("--samples", "'" + number + "'; expected 1 to 1000, or auto");
    }
    o.samples = static_cast<int>(count);
  }
  if (o.until_settled && refine_best > 0) {
    throw CLI::ValidationError("--refine-best",
                               "does not go with --samples auto; expected a number of samples");
  }
  if (refine_best > 0 && !has_judges(select)) {
    throw CLI::ValidationError("--refine-best", "does not go with --select " + select +
                                                    ", which looks at no pictures; expected "
                                                    "discriminator, classifier or both");
  }
  o.temperature = temperature;
  o.guidance = guidance;
  o.refine_best = refine_best;
  o.seed = context.seed;
  if (select == "likelihood") o.keep = outpaint::OutpaintOptions::Keep::likeliest;
  return options;
}

}  // namespace ps::apps
