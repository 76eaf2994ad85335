// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/sampler.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "libps/nn/softmax.h"
#include "libps/outpaint/cell_forward.h"

namespace ps::outpaint {
namespace {

constexpr std::size_t kMemory = std::size_t{700} << 20;  ///< bytes that all lanes keep
constexpr std::size_t kMost = 16;  ///< completions of a lane; more rows gain nothing

void check(const SampleOptions& options, int first, int count, const Order& order, int codes) {
  if (first < 0) throw Error("first completion", std::to_string(first), "0 or more");
  if (count < 0) throw Error("completions", std::to_string(count), "0 or more");
  if (first > std::numeric_limits<int>::max() - count) {
    throw Error("completions", std::to_string(count) + " from " + std::to_string(first) + " on",
                "numbers of 31 bits");
  }
  if (!(options.temperature >= 0 && options.temperature <= 2)) {
    throw Error("temperature", std::to_string(options.temperature), "0 to 2");
  }
  if (!options.forced) return;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order.missing[i] && (options.forced[i] < 0 || options.forced[i] >= codes)) {
      throw Error("forced code of cell " + std::to_string(i), std::to_string(options.forced[i]),
                  "0 to " + std::to_string(codes - 1));
    }
  }
}

/// The first of the greatest logits.
std::int32_t likeliest(const float* logits, int codes) {
  return static_cast<std::int32_t>(std::max_element(logits, logits + codes) - logits);
}

/// The softmax of one row of logits.
void softmax_of(const float* logits, int codes, double temperature, std::vector<float>& out) {
  out.resize(static_cast<std::size_t>(codes));
  const auto stride = static_cast<std::size_t>(codes);
  nn::softmax({const_cast<float*>(logits), {1, 1, 1, codes}, stride},
              {out.data(), {1, 1, 1, codes}, stride}, static_cast<float>(temperature));
}

/// The code at which the sum of probabilities first exceeds `unit` of the whole.
std::int32_t draw(const std::vector<float>& probabilities, double unit) {
  double whole = 0;
  for (const float p : probabilities) whole += p;
  double sum = 0;
  std::int32_t last = 0;  // rounding may leave the sum below its end
  for (std::size_t i = 0; i < probabilities.size(); ++i) {
    if (probabilities[i] <= 0) continue;
    last = static_cast<std::int32_t>(i);
    sum += probabilities[i];
    if (sum > unit * whole) return last;
  }
  return last;
}

}  // namespace

class Sampler::Impl {
 public:
  Impl(const models::PixelCnn& network, const Order& order, std::vector<std::int32_t> codes)
      : network_(network),
        order_(order),
        known_(std::move(codes)),
        plan_(order),
        forward_(network, plan_) {
    if (known_.size() != order.size()) {
      throw Error("sampler", std::to_string(known_.size()) + " codes",
                  std::to_string(order.size()) + ", one for each cell");
    }
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (!order.missing[i] && (known_[i] < 0 || known_[i] >= network.codes())) {
        throw Error("sampler",
                    "code " + std::to_string(known_[i]) + " in cell " + std::to_string(i),
                    "0 to " + std::to_string(network.codes() - 1));
      }
    }
    missing_ = static_cast<std::size_t>(
        std::count_if(order.missing.begin(), order.missing.end(), [](auto m) { return m != 0; }));
  }

  std::vector<Completion> sample(int first, int count, const SampleOptions& options) {
    check(options, first, count, order_, network_.codes());
    const auto wanted = static_cast<std::size_t>(count);
    Run run{options, first, std::vector<Completion>(wanted, Completion{known_, 0})};
    run.whole = std::max<std::size_t>(wanted * missing_, 1);
    if (!run.report(0)) return {};
    if (missing_ > 0 && count > 0) {
      run_shared();
      const std::size_t parts = parts_of(wanted);
      parallel_for(parts, [&](std::size_t i) {
        sample_part(run, wanted * i / parts, wanted * (i + 1) / parts);
      });
    }
    if (!run.report(run.whole - run.done)) return {};
    return std::move(run.completions);
  }

  std::size_t missing() const { return missing_; }
  std::size_t levels() const { return plan_.levels.size(); }
  std::size_t bytes() const {
    std::size_t sum = forward_.bytes() + shared_logits_.size() * sizeof(float);
    for (const auto& lane : idle_lanes_) sum += lane->bytes();
    return sum;
  }

 private:
  /// One call of sample.
  struct Run {
    const SampleOptions& options;
    int first;
    std::vector<Completion> completions;
    std::size_t done = 0, whole = 1;  ///< cells of all completions
    bool stopped = false;
    std::mutex mutex = {};

    /// @return whether to go on
    bool report(std::size_t more) {
      const std::lock_guard<std::mutex> lock(mutex);
      done += more;
      if (!options.progress || stopped) return !stopped;
      stopped = true;  // should it throw
      stopped = !options.progress(static_cast<double>(done) / static_cast<double>(whole));
      return !stopped;
    }
  };

  /// How many parts completions are split into. Each goes through all levels by itself, on one
  /// thread; so no thread waits for another, and reads what it wrote itself.
  std::size_t parts_of(std::size_t count) const {
    const auto cores = static_cast<std::size_t>(threads());
    const std::size_t fit = kMemory / std::max<std::size_t>(forward_.bytes_each() * cores, 1);
    const std::size_t most = std::min(std::max<std::size_t>(fit, 1), kMost);
    const std::size_t turns = (count + most * cores - 1) / (most * cores);
    return std::min(count, turns * cores);
  }

  void run_shared() {
    if (shared_done_) return;
    const nn::TensorView logits = forward_.run_shared(
        [this](int cell, std::size_t) { return known_[static_cast<std::size_t>(cell)]; });
    shared_logits_.assign(logits.data, logits.pixel(logits.shape.pixels()));
    shared_done_ = true;
  }

  /// Samples completions [begin, end) of a run, all levels.
  void sample_part(Run& run, std::size_t begin, std::size_t end) {
    std::unique_ptr<Lane> lane = take_lane();
    forward_.resize(*lane, end - begin);
    const Completion* completions = run.completions.data() + begin;
    const auto codes = static_cast<std::size_t>(network_.codes());
    /// `logits` are [missing cells][rows_each][codes]; rows_each is 1, or end - begin.
    const auto sample = [&](const Group& group, std::size_t rows_each, const float* logits) {
      for (std::size_t k = begin; k < end; ++k) {
        for (std::size_t i = 0; i < group.missing; ++i) {
          take(group.cells[i], run.first + static_cast<int>(k),
               logits + (i * rows_each + (k - begin) % rows_each) * codes, run.options,
               run.completions[k]);
        }
      }
      return run.report(group.missing * (end - begin));
    };
    bool go_on = sample(plan_.shared, 1, shared_logits_.data());
    for (std::size_t i = 0; i < plan_.levels.size() && go_on; ++i) {
      const Group& level = plan_.levels[i];
      const nn::TensorView logits = forward_.run(level, *lane, [&](int cell, std::size_t k) {
        return completions[k].codes[static_cast<std::size_t>(cell)];
      });
      go_on = sample(level, end - begin, logits.data);
    }
    for (std::size_t k = begin; k < end; ++k) {
      run.completions[k].log_likelihood /= static_cast<double>(missing_);
    }
    give_back(std::move(lane));
  }

  std::unique_ptr<Lane> take_lane() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (idle_lanes_.empty()) return std::make_unique<Lane>();
    std::unique_ptr<Lane> lane = std::move(idle_lanes_.back());
    idle_lanes_.pop_back();
    return lane;
  }
  void give_back(std::unique_ptr<Lane> lane) {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_lanes_.push_back(std::move(lane));
  }

  void check_finite(int cell, int completion, const float* logits) const {
    const float* end = logits + network_.codes();
    const float* bad = std::find_if_not(logits, end, [](float x) { return std::isfinite(x); });
    if (bad == end) return;
    const int row = cell / order_.width, column = cell % order_.width;
    throw Error("sampler",
                "logit " + std::to_string(bad - logits) + " of cell " + std::to_string(cell) +
                    " (row " + std::to_string(row) + ", column " + std::to_string(column) +
                    ") of completion " + std::to_string(completion) + " is " + std::to_string(*bad),
                "finite numbers: the network's weights overflow");
  }

  /// Chooses one cell's code.
  void take(int cell, int completion, const float* logits, const SampleOptions& options,
            Completion& to) const {
    thread_local std::vector<float> guided, probabilities;
    const int codes = network_.codes();
    check_finite(cell, completion, logits);
    const float* choice = logits;
    if (options.guidance) {
      const float* add =
          options.guidance + static_cast<std::size_t>(cell) * static_cast<std::size_t>(codes);
      guided.resize(static_cast<std::size_t>(codes));
      std::transform(logits, logits + codes, add, guided.begin(), std::plus<>());
      choice = guided.data();
    }
    std::int32_t code = likeliest(choice, codes);
    if (options.forced) {
      code = options.forced[cell];
    } else if (static_cast<float>(options.temperature) > 0) {
      softmax_of(choice, codes, options.temperature, probabilities);
      code = draw(probabilities,
                  random_unit(options.seed, {options.view, static_cast<std::uint32_t>(completion),
                                             static_cast<std::uint32_t>(cell), 0}));
    }
    softmax_of(logits, codes, 1, probabilities);
    const auto best = static_cast<std::size_t>(likeliest(logits, codes));
    to.log_likelihood += static_cast<double>(logits[code]) - logits[best] +
                         std::log(static_cast<double>(probabilities[best]));
    to.codes[static_cast<std::size_t>(cell)] = code;
    if (options.observe) options.observe(cell, completion, logits);
  }

  const models::PixelCnn& network_;
  Order order_;
  std::vector<std::int32_t> known_;
  Plan plan_;
  CellForward forward_;
  std::size_t missing_ = 0;
  bool shared_done_ = false;
  std::vector<float> shared_logits_;  ///< of the shared cells that are missing
  std::mutex mutex_;
  std::vector<std::unique_ptr<Lane>> idle_lanes_;
};

Sampler::Sampler(const models::PixelCnn& network, const Order& order,
                 std::vector<std::int32_t> codes)
    : impl_(std::make_unique<Impl>(network, order, std::move(codes))) {}
Sampler::~Sampler() = default;
Sampler::Sampler(Sampler&&) noexcept = default;
Sampler& Sampler::operator=(Sampler&&) noexcept = default;

std::vector<Completion> Sampler::sample(int first, int count, const SampleOptions& options) {
  return impl_->sample(first, count, options);
}
std::size_t Sampler::missing() const { return impl_->missing(); }
std::size_t Sampler::levels() const { return impl_->levels(); }
std::size_t Sampler::bytes() const { return impl_->bytes(); }

}  // namespace ps::outpaint
