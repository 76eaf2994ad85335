// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/train.h"

#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "libps/core/clock.h"
#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/train/checkpoint.h"
#include "libps/train/layers.h"
#include "libps/train/shard.h"
#include "libps/train/stage.h"

namespace fs = std::filesystem;

namespace ps::train {
namespace {

using Maker = std::unique_ptr<Stage> (*)(const TrainOptions&, torch::Device);

const std::vector<std::pair<std::string, Maker>>& stages() {
  static const std::vector<std::pair<std::string, Maker>> all = {
      {"vqvae", make_vqvae_stage},
      {"depth", make_depth_stage},
      {"classifier", make_classifier_stage},
      {"refine", make_refine_stage},
      {"pixelcnn", make_pixelcnn_stage}};
  return all;
}

Maker maker_of(const std::string& stage) {
  std::string names;
  for (const auto& [name, maker] : stages()) {
    if (name == stage) return maker;
    names += (names.empty() ? "" : ", ") + name;
  }
  throw Error("train", "there is no stage '" + stage + "'", names);
}

torch::Device device_of(const std::string& name) {
  if (name == "cpu") return torch::kCPU;
  if (name != "cuda") throw Error("--device", "'" + name + "' is no device", "cpu or cuda");
  if (!torch::cuda::is_available()) throw Error("--device", "there is no CUDA device", "cpu");
  return torch::kCUDA;
}

bool is_narrow(const std::string& arithmetic) {
  if (arithmetic != "f32" && arithmetic != "bf16") {
    throw Error("--arithmetic", "'" + arithmetic + "' is unknown", "f32 or bf16");
  }
  return arithmetic == "bf16";
}

/// Rises over the first steps, then falls along a cosine to 0.
double rate_at(std::int64_t step, std::int64_t steps, double rate) {
  const double warm = std::min<double>(200, .05 * static_cast<double>(steps) + 1);
  const auto at = static_cast<double>(step);
  const double rise = std::min(1.0, (at + 1) / warm);
  return rate * rise * .5 * (1 + std::cos(3.14159265358979 * at / static_cast<double>(steps)));
}

/// Adds up values by name and gives their means.
class Means {
 public:
  void add(const Values& values) {
    for (const auto& [name, value] : values) sums_[name] += value;
    ++count_;
  }
  Values take() {
    for (auto& [name, sum] : sums_) sum /= std::max(count_, 1);
    count_ = 0;
    return std::exchange(sums_, {});
  }

 private:
  Values sums_;
  int count_ = 0;
};

Sheet sheet_of(const std::vector<std::vector<Tensor>>& rows) {
  std::vector<Tensor> lines;
  for (const auto& row : rows) lines.push_back(torch::cat(row, 2));
  const Tensor all =
      ((torch::cat(lines, 1) + 1) / 2).clamp(0, 1).permute({1, 2, 0}).cpu().contiguous();
  const float* const data = all.data_ptr<float>();
  return {static_cast<int>(all.size(1)), static_cast<int>(all.size(0)), {data, data + all.numel()}};
}

/// One call of train().
class Run {
 public:
  Run(const TrainOptions& options, const TrainProgress& progress)
      : options_(options),
        progress_(progress),
        device_(device_of(options.device)),
        narrow_(is_narrow(options.arithmetic)),
        stage_(maker_of(options.stage)(options, device_)),
        wanted_(stage_->wanted()),
        train_(options.train),
        shares_(shares_of(train_)) {
    if (wanted_.partners && !train_.posed()) {
      throw Error(options.train.string(), "no pair's pose is known",
                  "examples with poses, which `train data` writes now");
    }
    if (!options.test.empty()) test_.emplace(options.test);
    const StageDefaults defaults = stage_->defaults();
    if (options_.batch == 0) options_.batch = defaults.batch;
    if (options_.steps == 0) {
      const double scaled = static_cast<double>(defaults.steps) * options_.steps_scale;
      options_.steps = std::max<std::int64_t>(std::llround(scaled), 1);
    }
    if (options_.learning_rate == 0) options_.learning_rate = defaults.learning_rate;
    if (options_.curriculum < 0) options_.curriculum = defaults.curriculum;
    std::error_code failed;
    fs::create_directories(options_.out, failed);
    if (failed) throw Error(options_.out.string(), failed.message(), "a folder that can be made");
    if (!options_.init.empty()) load_weights(*stage_, options_.init);
    step_ = load_checkpoint(*stage_, options_);
    if (test_) stage_->look_at(train_);
  }

  TrainReport go() {
    const Instant start = now();
    const std::int64_t first = step_;
    bool wanted = true;
    while (wanted && step_ < options_.steps) {
      one();
      const bool end = step_ == options_.steps ||
                       (options_.stop_after > 0 && step_ == first + options_.stop_after);
      const bool test = step_ % options_.test_every == 0 || step_ == options_.steps;
      if (step_ % 10 == 0 || end) wanted = tell({step_, options_.steps, means_.take()});
      if (test) wanted = evaluate() && wanted;
      if (end) break;
      if (step_ % options_.save_every == 0) save_checkpoint(*stage_, options_, step_);
    }
    if (first == options_.steps) evaluate();  // what was finished is scored again
    save_checkpoint(*stage_, options_, step_);
    report_.weights = save_weights(*stage_, options_, step_);
    report_.steps = step_;
    report_.batch = options_.batch;
    report_.seconds = seconds_since(start);
    report_.images_per_second =
        static_cast<double>((step_ - first) * options_.batch) / std::max(training_seconds_, 1e-9);
    for (const auto& network : stage_->networks())
      report_.parameters += network.parameters->count();
    return report_;
  }

 private:
  /// Whether a group has what the stage wants.
  bool is_of_use(const std::string& group) const { return group != kPosed || !wanted_.depth; }

  /// Groups of one kind share by their sizes.
  std::vector<double> shares_of(const Dataset& data) const {
    const auto real = [](const std::string& group) { return group == kFrames || group == kPosed; };
    double sizes[2] = {0, 0};
    for (std::size_t g = 0; g < data.groups().size(); ++g) {
      const std::string& group = data.groups()[g];
      if (is_of_use(group)) sizes[real(group)] += static_cast<double>(data.size(g));
    }
    if (sizes[0] + sizes[1] == 0) {
      throw Error(options_.train.string(), "no example's depth is known",
                  "others, or `train depth --supervision poses`");
    }
    const bool both = sizes[0] > 0 && sizes[1] > 0;
    std::vector<double> shares;
    for (std::size_t g = 0; g < data.groups().size(); ++g) {
      const std::string& group = data.groups()[g];
      const double kind = real(group) ? options_.frames_share : 1 - options_.frames_share;
      const double part = static_cast<double>(data.size(g)) / sizes[real(group)];
      shares.push_back(is_of_use(group) ? (both ? kind : 1) * part : 0);
    }
    return shares;
  }

  void one() {
    const AddedSeconds clock(training_seconds_);
    torch::Generator generator = generator_of(options_.seed, step_);
    Batch batch = train_.batch(
        train_.draw(options_.batch, shares_, wanted_.splats, generator,
                    turn_limit(step_, options_.steps, options_.curriculum, train_.most_turn())),
        wanted_, device_);
    augment(batch, stage_->augmentation(), generator);
    const NarrowProducts arithmetic(narrow_);
    means_.add(
        stage_->step(batch, generator, rate_at(step_, options_.steps, options_.learning_rate)));
    ++step_;
  }

  bool evaluate() {
    if (!test_) return true;
    for (const auto& network : stage_->networks()) network.adam->swap_average();
    Values scores;
    std::vector<std::vector<Tensor>> pictures;
    for (std::size_t g = 0; g < test_->groups().size(); ++g) {
      if (!is_of_use(test_->groups()[g])) continue;
      for (const auto& [name, value] : scores_of(g, pictures)) {
        scores[test_->groups()[g] + "_" + name] = value;
      }
    }
    for (const auto& network : stage_->networks()) network.adam->swap_average();
    report_.scores = scores;
    save_weights(*stage_, options_, step_);
    const Sheet sheet = sheet_of(pictures);
    return tell({step_, options_.steps, scores, true, &sheet});
  }

  Values scores_of(std::size_t group, std::vector<std::vector<Tensor>>& pictures) {
    constexpr std::size_t kShown = 6, kAtOnce = 16;
    const auto chosen = test_->spread(group, options_.test_count, wanted_.splats);
    Values sums;
    for (std::size_t i = 0; i < chosen.size(); i += kAtOnce) {
      const std::size_t end = std::min(i + kAtOnce, chosen.size());
      const auto count = static_cast<double>(end - i);
      const Batch batch = test_->batch({chosen.begin() + static_cast<std::ptrdiff_t>(i),
                                        chosen.begin() + static_cast<std::ptrdiff_t>(end)},
                                       wanted_, device_);
      for (const auto& [name, value] : stage_->test(batch)) {
        sums[name] += value * count / static_cast<double>(chosen.size());
      }
    }
    const auto shown = test_->spread(group, kShown, wanted_.splats);
    for (auto& row : stage_->pictures(test_->batch(shown, wanted_, device_))) {
      pictures.push_back(std::move(row));
    }
    return sums;
  }

  bool tell(const TrainEvent& event) {
    std::ofstream log(options_.out / "log.csv", std::ios::app);
    for (const auto& [name, value] : event.values) {
      log << event.step << ',' << (event.evaluated ? "test" : "train") << ',' << name << ','
          << value << ',' << training_seconds_ << '\n';
    }
    return !progress_ || progress_(event);
  }

  TrainOptions options_;
  const TrainProgress& progress_;
  torch::Device device_;
  bool narrow_;
  std::unique_ptr<Stage> stage_;
  Wanted wanted_;
  Dataset train_;
  std::optional<Dataset> test_;
  std::vector<double> shares_;
  Means means_;
  std::int64_t step_ = 0;
  double training_seconds_ = 0;
  TrainReport report_;
};

}  // namespace

Parameters& on_device(Parameters& parameters, torch::Device device) {
  parameters.to(device);
  return parameters;
}

double turn_limit(std::int64_t step, std::int64_t steps, int curriculum, double most) {
  if (curriculum == 0) return Dataset::kAnyTurn;
  const auto part = static_cast<double>(step * curriculum / steps + 1);
  return most * (part / curriculum);
}

const std::vector<std::string>& stage_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, maker] : stages()) all.push_back(name);
    return all;
  }();
  return names;
}

TrainReport train(const TrainOptions& options, const TrainProgress& progress) {
  if (options.threads > 0) at::set_num_threads(options.threads);
  set_threads(options.threads);
  try {
    return Run(options, progress).go();
  } catch (const c10::Error& error) {
    throw Error("train " + options.stage, error.what_without_backtrace());
  }
}

}  // namespace ps::train
