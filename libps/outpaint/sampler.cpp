// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/sampler.h"

#include <algorithm>
#include <cmath>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/core/random.h"
#include "libps/nn/softmax.h"
#include "libps/outpaint/cell_forward.h"

namespace ps::outpaint {
namespace {

constexpr std::size_t kMemory = std::size_t{700} << 20;  ///< bytes for activations that differ
constexpr std::size_t kMostAtOnce = 60;                  ///< completions; more rows gain nothing

void check(const SampleOptions& options, int first, int count, const Order& order, int codes) {
  if (first < 0) throw Error("first completion", std::to_string(first), "0 or more");
  if (count < 0) throw Error("completions", std::to_string(count), "0 or more");
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
    std::vector<Completion> all;
    if (missing_ > 0 && count > 0 && shared_logits_.empty()) run_shared();
    const std::size_t at_once = completions_at_once();
    const auto wanted = static_cast<std::size_t>(count);
    const std::size_t rounds = (wanted + at_once - 1) / std::max<std::size_t>(at_once, 1);
    for (std::size_t round = 0; round < rounds; ++round) {
      const std::size_t begin = wanted * round / rounds, end = wanted * (round + 1) / rounds;
      const auto report = [&](double done) {
        return !options.progress ||
               options.progress((static_cast<double>(round) + done) / static_cast<double>(rounds));
      };
      if (!sample_round(first + static_cast<int>(begin), end - begin, options, report, all))
        return {};
    }
    return all;
  }

  std::size_t missing() const { return missing_; }
  std::size_t levels() const { return plan_.levels.size(); }
  std::size_t bytes() const { return forward_.bytes() + shared_logits_.size() * sizeof(float); }

 private:
  std::size_t completions_at_once() const {
    const std::size_t each = std::max<std::size_t>(plan_.varying * forward_.bytes_each(), 1);
    return std::min(std::max<std::size_t>(kMemory / each, 1), kMostAtOnce);
  }

  void run_shared() {
    const nn::TensorView logits = forward_.run(plan_.shared, true, [this](int cell, std::size_t) {
      return known_[static_cast<std::size_t>(cell)];
    });
    shared_logits_.assign(logits.data, logits.pixel(logits.shape.pixels()));
  }

  template <class Report>
  bool sample_round(int first, std::size_t count, const SampleOptions& options,
                    const Report& report, std::vector<Completion>& all) {
    const std::size_t begin = all.size();
    all.resize(begin + count, {known_, 0});
    Completion* completions = all.data() + begin;
    forward_.resize(count);
    const auto codes = static_cast<std::size_t>(network_.codes());
    const auto sample = [&](const Group& group, std::size_t rows_each, const float* logits) {
      parallel_chunks(count, 4, [&](std::size_t from, std::size_t to) {
        for (std::size_t k = from; k < to; ++k) {
          for (std::size_t i = 0; i < group.missing; ++i) {
            take(group.cells[i], first + static_cast<int>(k),
                 logits + (i * rows_each + k % rows_each) * codes, options, completions[k]);
          }
        }
      });
    };
    sample(plan_.shared, 1, shared_logits_.data());
    std::size_t done = plan_.shared.missing;
    for (const Group& level : plan_.levels) {
      if (!report(static_cast<double>(done) / static_cast<double>(missing_))) return false;
      const nn::TensorView logits = forward_.run(level, false, [&](int cell, std::size_t k) {
        return completions[k].codes[static_cast<std::size_t>(cell)];
      });
      sample(level, count, logits.data);
      done += level.missing;
    }
    for (std::size_t k = 0; k < count && missing_ > 0; ++k) {
      completions[k].log_likelihood /= static_cast<double>(missing_);
    }
    return report(1);
  }

  /// Chooses one cell's code.
  void take(int cell, int completion, const float* logits, const SampleOptions& options,
            Completion& to) const {
    thread_local std::vector<float> probabilities;
    const int codes = network_.codes();
    const auto likeliest =
        static_cast<std::size_t>(std::max_element(logits, logits + codes) - logits);
    auto code = static_cast<std::int32_t>(likeliest);
    if (options.forced) {
      code = options.forced[cell];
    } else if (static_cast<float>(options.temperature) > 0) {
      softmax_of(logits, codes, options.temperature, probabilities);
      code = draw(probabilities,
                  random_unit(options.seed, {options.view, static_cast<std::uint32_t>(completion),
                                             static_cast<std::uint32_t>(cell), 0}));
    }
    softmax_of(logits, codes, 1, probabilities);
    to.log_likelihood += static_cast<double>(logits[code]) - logits[likeliest] +
                         std::log(static_cast<double>(probabilities[likeliest]));
    to.codes[static_cast<std::size_t>(cell)] = code;
    if (options.observe) options.observe(cell, completion, logits);
  }

  const models::PixelCnn& network_;
  Order order_;
  std::vector<std::int32_t> known_;
  Plan plan_;
  CellForward forward_;
  std::size_t missing_ = 0;
  std::vector<float> shared_logits_;  ///< of the shared cells that are missing
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
