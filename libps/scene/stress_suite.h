// SPDX-License-Identifier: BSD-3-Clause
// Internal to the scene room: what the axes share.
#pragma once

#include <memory>
#include <optional>

#include "libps/scene/stress_axes.h"
#include "libps/scene/stress_world.h"

namespace ps::stress {

/// Something that takes a while to make, made when it is first asked for; not for two threads.
template <typename T>
class Lazy {
 public:
  explicit Lazy(std::function<T()> make) : make_(std::move(make)) {}
  const T& get() {
    if (!value_) value_.emplace(make_());
    return *value_;
  }

 private:
  std::function<T()> make_;
  std::optional<T> value_;
};

/// Pixels: of splats, of ours at their narrowest and at their widest.
constexpr float kRadius = 2, kDetail = 1.5f, kWidest = 64;

using Worlds = std::shared_ptr<Lazy<std::vector<World>>>;
/// @return the seed of room i, and of what goes wrong with its frames
std::uint64_t room_seed(const SuiteOptions& options, int i);
std::uint64_t draw_seed(const SuiteOptions& options, std::size_t i);
Worlds make_worlds(const SuiteOptions& options);

/// @return the values, with the ones half way between them if the suite is dense
std::vector<double> values_of(const SuiteOptions& options, std::vector<double> values);

/// @brief A cloud as a method of fusing shows it: ours by closed splats (closed_splat.h), the
/// others by splats of radius 2; renormalised.
Image picture_of(const std::string& method, const Cloud& cloud, const View& truth);

/// @return dB, mean over the views left out, where frames cover them; holes count as black. NaN for
/// an empty cloud.
double psnr_of(const std::string& method, const Cloud& cloud, const World& world);

/// @return the F-score in % of kNearEnough metres, of evenly spread points of both clouds
double f_score_of(const Cloud& cloud, const Cloud& truth);
constexpr double kNearEnough = .03;

/// Adds a cloud to what is checked of an outcome.
void note(const Cloud& cloud, Outcome* outcome);

}  // namespace ps::stress
