// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "libps/models/pixel_cnn.h"
#include "libps/outpaint/order.h"

namespace ps::outpaint {

struct SampleOptions {
  double temperature = 0.5;  ///< 0 = the likeliest code (the first of them), at most 2
  std::uint64_t seed = 0;
  std::uint32_t view = 0;  ///< views with one seed draw different numbers
  /// By cell, as many as the order has: taken in place of what would be drawn (teacher forcing);
  /// null = draw.
  const std::int32_t* forced = nullptr;
  /// [cells][codes], added to the logits before a code is drawn; null = nothing. What is said of a
  /// completion, and to `observe`, is without it.
  const float* guidance = nullptr;
  /// Told what share is done, from 0 to 1, never falling: one call at a time, from any thread.
  /// Sampling stops when it returns false, or throws.
  std::function<bool(double done)> progress;
  /// Told the logits of every cell as it is sampled, from any thread.
  std::function<void(int cell, int completion, const float* logits)> observe;
};

struct Completion {
  std::vector<std::int32_t> codes;  ///< by cell
  double log_likelihood = 0;  ///< mean of log p(code) over the missing cells, at temperature 1
};

/// @brief Samples the missing codes of a view (SPEC.md 7).
///
/// What a cell computes depends only on cells earlier in the order, and is final when it is
/// sampled; so each layer of each cell is computed once, not once for every later cell. Known cells
/// that see nothing missing are computed once for all completions. The others come in levels of
/// cells that do not see each other; each thread takes some completions through all levels, so that
/// each layer is one product of (cells x completions) rows. What no later cell sees is forgotten.
/// Memory does not grow with the number of completions beyond 16 for each thread. A completion is a
/// function of (network, order, codes, seed, view, its number): the same bits however many are
/// drawn, in whatever rounds, on however many threads. Not for two threads at once.
class Sampler {
 public:
  /// @param network  must outlive the sampler
  /// @param codes    by cell; those of missing cells are not read
  /// Throws ps::Error when sizes do not fit or a known code is not one of the network's.
  Sampler(const models::PixelCnn& network, const Order& order, std::vector<std::int32_t> codes);
  ~Sampler();
  Sampler(Sampler&&) noexcept;
  Sampler& operator=(Sampler&&) noexcept;

  /// @brief Draws completions [first, first + count).
  /// @return them, or nothing when options.progress stopped it
  /// Throws ps::Error when first or count is negative, the temperature not in [0, 2], a forced code
  /// unknown, or a logit not finite (which cell, of which completion).
  std::vector<Completion> sample(int first, int count, const SampleOptions& options = {});

  std::size_t missing() const;  ///< cells to sample in each completion
  std::size_t levels() const;   ///< steps that have to come one after another
  std::size_t bytes() const;    ///< memory held for activations

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ps::outpaint
