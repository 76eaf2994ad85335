// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/contact_sheet.h"
#include "apps/eval_models.h"
#include "apps/frames_arguments.h"
#include "apps/interrupt.h"
#include "apps/method_models.h"
#include "apps/output.h"
#include "apps/program.h"
#include "apps/progress.h"
#include "apps/scene_arguments.h"
#include "apps/score_report.h"
#include "apps/verb_eval.h"
#include "io/photo.h"
#include "libps/core/error.h"
#include "libps/core/words.h"
#include "libps/eval/frechet.h"
#include "libps/eval/view_scores.h"

namespace ps::apps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct EvalViewsArguments {
  FramesArguments frames;
  SceneArguments scene;  ///< sampling and weights of it are used
  std::vector<std::string> methods = default_methods();
  std::size_t pairs = 24;
  PairRange range;
  bool wide = false, estimate_depth = false;
  std::string lpips, output, pictures;
};

std::vector<ScoreColumn> columns() {
  return {{"PSNR", "dB", true}, {"PSNR visible", "dB", true}, {"PSNR invisible", "dB", true},
          {"SSIM", "", true},   {"LPIPS-squeeze", "", false}, {"seconds", "s", false}};
}

std::vector<FramePair> pairs_of(const EvalViewsArguments& a, const ChosenFrames& frames,
                                const Context& context) {
  const PairRange range = a.wide ? kWidePairs : a.range;
  std::vector<FramePair> pairs = choose_pairs_lazily(
      frames.worlds(), [&](std::size_t i) { return frames.pose(i); }, range, a.pairs, context.seed);
  if (!pairs.empty()) return pairs;
  throw Error(a.frames.data,
              "no two of its frames are " + in_digits(range.least_rotation) + " to " +
                  in_digits(range.most_rotation) + " degrees and at most " +
                  in_digits(range.most_distance) + " m apart",
              "a wider range, or more frames");
}

/// What is seen of a pair, by method.
struct PairPictures {
  Image input, truth;
  std::vector<SheetTile> shown;  ///< in the order of the methods

  PairPictures(const View& source, const View& target) : input(source.color), truth(target.color) {}
};

/// Each method's pictures in a folder of its own, as `eval ab` takes them, and for each pair a
/// sheet of all.
void write_pictures(OutputFolder& folder, std::size_t number, const PairPictures& pair) {
  constexpr int kColumns = 4;
  char name[32];
  std::snprintf(name, sizeof name, "pair_%05zu.png", number);
  std::vector<SheetTile> tiles = {{"input", pair.input}, {"truth", pair.truth}};
  tiles.insert(tiles.end(), pair.shown.begin(), pair.shown.end());
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    tiles[i].row = static_cast<int>(i) / kColumns;
    tiles[i].column = static_cast<int>(i) % kColumns;
    folder.write(tiles[i].name + "/" + name,
                 [&](const std::filesystem::path& file) { write_image(file, tiles[i].image); });
  }
  folder.write(name, [&](const std::filesystem::path& file) {
    write_image(file, contact_sheet(tiles, std::min(320, pair.truth.cols)));
  });
}

/// Of an image's pixels; null where that is not known.
Json share_of(const Mask& mask) { return mask.empty() ? Json() : Json(cv::mean(mask)[0]); }

/// Scores all methods on one pair after another.
class ViewsRun {
 public:
  ViewsRun(const EvalViewsArguments& arguments, const ChosenFrames& frames,
           const MethodModels& models, const PerceptualModel& perceptual, const Context& context)
      : a_(arguments),
        frames_(frames),
        models_(models),
        perceptual_(perceptual.distance()),
        table_(columns()) {
    if (const auto features = perceptual.features()) frechet_.emplace(*features);
    ViewMethodOptions options;
    options.scene = a_.scene.scene(context);
    options.scene.cloud.lift.estimated = a_.estimate_depth;
    options.scene.outpaint.progress = unless_interrupted;
    options.renderer.seed = context.seed;
    for (const std::string& name : a_.methods) {
      methods_.push_back(make_view_method(name, models.networks(), options));
    }
  }

  void measure(const std::vector<FramePair>& pairs, OutputFolder* folder, const Context& context) {
    Progress progress(context, "views", pairs.size() * methods_.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const PairPictures pictures = measure(pairs[i], progress);
      if (folder != nullptr) write_pictures(*folder, i, pictures);
    }
  }

  const ScoreTable& table() const { return table_; }
  const Json& pairs() const { return pairs_; }

  /// Says why parts of pictures have no score, where that is so.
  void warn_of_unknown_parts(const Context& context) const {
    if (without_depth_ == 0) return;
    context.warn(a_.frames.data + ": " + std::to_string(without_depth_) + " of " +
                 counted(pairs_.size(), "pair") +
                 " without true depth of both frames: what the input sees is not known there, and "
                 "not scored by itself");
  }

  ScoreSummary summary(const Context& context) const {
    ScoreSummary summary = summary_of(table_, bootstrap_of(context));
    if (!frechet_) return summary;
    // Without an interval: resamples repeat pictures, which narrows what is fitted to them.
    summary.columns.push_back({frechet_name(frechet_->network()), "", false});
    for (std::size_t r = 0; r < summary.rows.size(); ++r) {
      const std::string& method = summary.rows[r];
      summary.cells[r].push_back({frechet_->distance(method), kNaN, kNaN, frechet_->count(method)});
    }
    return summary;
  }

 private:
  PairPictures measure(const FramePair& pair, Progress& progress) {
    View input = frames_.load(pair.source);
    const View truth = frames_.load(pair.target);
    Visibility visibility;  // empty = not known
    if (has_depth(input) && has_depth(truth)) {
      visibility = true_visibility(input, truth);
    } else {
      ++without_depth_;
    }
    complete_depth(input, models_.depth(), a_.estimate_depth);
    const std::string name = frames_.name(pair.source) + " to " + frames_.name(pair.target);
    pairs_.push_back({{"pair", name},
                      {"rotation", pair.rotation},
                      {"distance", pair.distance},
                      {"visible_share", share_of(visibility.visible)},
                      {"invisible_share", share_of(visibility.invisible)}});
    PairPictures pictures(input, truth);
    if (frechet_) frechet_->add_truth(truth.color);
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      const Stopwatch watch;
      const Image shown = methods_[m]->show(input, truth.intrinsics, truth.world_from_cam).color;
      const double seconds = watch.seconds();
      const ViewScores s = view_scores(shown, truth.color, visibility, perceptual_);
      table_.add({a_.methods[m],
                  name,
                  frames_.groups[pair.source],
                  {s.psnr, s.psnr_visible, s.psnr_invisible, s.ssim, s.perceptual, seconds}});
      if (frechet_) frechet_->add(a_.methods[m], shown);
      pictures.shown.push_back({a_.methods[m], shown});
      progress.update(table_.rows().size());
    }
    return pictures;
  }

  const EvalViewsArguments& a_;
  const ChosenFrames& frames_;
  const MethodModels& models_;
  PerceptualDistance perceptual_;
  std::optional<FrechetScores> frechet_;
  std::vector<std::unique_ptr<ViewMethod>> methods_;
  ScoreTable table_;
  Json pairs_ = Json::array();
  std::size_t without_depth_ = 0;  ///< pairs
};

void run_eval_views(const EvalViewsArguments& a, const CLI::App& verb, const Context& context) {
  check_order("--min-rotation", a.range.least_rotation, "--max-rotation", a.range.most_rotation);
  check_score_files(a.output);
  note_interrupts();
  const Stopwatch total;
  std::optional<OutputFolder> folder;
  if (!a.pictures.empty()) {
    folder.emplace(a.pictures);
    for (const std::string& method : view_method_names()) folder->clears({method + "/pair_#.png"});
  }
  const ChosenFrames frames = choose_posed_frames(a.frames, context);
  const std::vector<FramePair> pairs = pairs_of(a, frames, context);
  const MethodModels models(a.scene.weights, a.methods, context);
  const PerceptualModel perceptual(a.lpips);
  ViewsRun run(a, frames, models, perceptual, context);
  run.measure(pairs, folder ? &*folder : nullptr, context);
  const ScoreSummary summary = run.summary(context);
  run.warn_of_unknown_parts(context);
  const Json measured = {{"frames", frames_report(a.frames, frames)}, {"pairs", run.pairs()}};
  ScoreRun scored = {
      a.output, a.frames.data, score_report(verb, context, measured, "methods", summary),
      summary,  &run.table(),  "views of " + counted(pairs.size(), "pair") + " scored"};
  scored.pictures = folder ? &*folder : nullptr;
  end_scores(context, std::move(scored), total);
}

void add_pair_options(CLI::App& verb, EvalViewsArguments& a) {
  verb.add_option("--pairs", a.pairs, "At most so many pairs, drawn by the seed")
      ->type_name("N")
      ->check(whole_in(1, 1000000));
  auto* wide = verb.add_flag("--wide", a.wide, "Pairs of 0 to 120 degrees");
  verb.add_option("--min-rotation", a.range.least_rotation, "Degrees between the views, at least")
      ->type_name("DEG")
      ->check(in_range(0, 180))
      ->excludes(wide);
  verb.add_option("--max-rotation", a.range.most_rotation, "... at most")
      ->type_name("DEG")
      ->check(in_range(0, 180))
      ->excludes(wide);
  verb.add_option("--max-distance", a.range.most_distance, "Metres between the cameras, at most")
      ->type_name("M")
      ->check(in_range(0, kNoBound))
      ->excludes(wide);
}

}  // namespace

void add_eval_views(CLI::App& eval, const Context& context) {
  auto* verb = eval.add_subcommand(
      "views",
      std::string(
          "How near views come to true ones: of pairs of frames one is the input, and what each "
          "method shows from where the other stands is held against it. PSNR is over all pixels, "
          "those whose surface the input sees by true depth of both, and those that it does not. "
          "With --lpips also LPIPS, and a Frechet distance on features that the table names: it is "
          "no FID.\n"
          "Methods: ours (keeps the completion that agrees most with all); one-completion (of "
          "ours); "
          "by-likelihood, by-classifier, by-discriminator, by-both (keep the best in these eyes); "
          "sequential, "
          "independent; no-outpainter (the refiner fills in); rgb (colours as codes); mean-colour, "
          "telea, navier-stokes, nearest (plain fills of what the cloud shows); copy (the input "
          "itself).") +
          kIntervalsHelp);
  auto a = std::make_shared<EvalViewsArguments>();
  a->frames.add_to(*verb);
  add_names(*verb, "--methods", a->methods, "Which of them", view_method_names());
  add_pair_options(*verb, *a);
  a->scene.add_sampling_options(*verb);
  verb->add_flag("--estimate-depth", a->estimate_depth, "Show the methods no true depth");
  add_lpips_option(*verb, a->lpips);
  add_score_output(*verb, a->output, "every pair");
  verb->add_option("--pictures", a->pictures,
                   "Folder for a sheet of each pair, and each method's pictures in a folder of "
                   "its own, as eval ab takes them")
      ->type_name("DIR");
  verb->callback([a, verb, &context] { run_eval_views(*a, *verb, context); });
}

}  // namespace ps::apps
