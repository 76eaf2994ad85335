// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "libps/core/image.h"

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace ps {

struct Point;

namespace stress {

/// @brief What a method made of a disturbed input.
struct Outcome {
  /// Called once, after the runs; it may throw as Axis::run may. NaN = nothing to score.
  std::function<double()> score;
  Image picture;             ///< for people, and for the checks: it must be finite
  bool finite = true;        ///< of all else that was made
  std::uint64_t digest = 0;  ///< of all else that was made
  std::string overwritten;   ///< how what was observed was changed by what was invented; "" = not
};

/// @brief One thing that goes wrong, from not at all to past all use.
struct Axis {
  std::string name;            ///< "pose-noise"
  std::string what;            ///< what its values are, in a sentence
  std::string unit;            ///< of the values; may be empty
  std::vector<double> values;  ///< two at least; rising in difficulty, the first is undisturbed
  std::string score;           ///< "PSNR of views left out"
  std::string score_unit;
  bool higher_is_better = true;
  double limit = 0;                  ///< broken is what scores worse than this, or is no number
  bool geometry = true;              ///< concerns geometry: the README's claim is about these
  std::string rooms_alone;           ///< why given frames cannot have it; empty = they can
  std::vector<std::string> methods;  ///< the first is ours
  /// A function of its arguments alone, whatever the number of threads. A ps::Error is a refusal,
  /// which scores nothing; any other exception is a violation.
  std::function<Outcome(const std::string& method, double value)> run;
  std::function<Image(double value)> truth;  ///< what the picture should be; may be empty
};

/// @return where it is broken: "PSNR of views left out is under 20 dB"
std::string criterion_of(const Axis& axis);

/// @return whether a score is on the wrong side of the axis's limit; NaN is
bool broken(const Axis& axis, double score);

/// @brief Where a curve first crosses the limit: linear between the last step that holds and the
/// first that does not, which is the answer itself where its score is not finite.
/// @param scores  one for each of axis.values
/// @return infinite if it never breaks
double breaking_point(const Axis& axis, const std::vector<double>& scores);

/// @brief Steps where a curve gets worse at once as it does nowhere else: by more than four times
/// the median of its changes, and by more than a third of all that it loses.
/// @param scores  one for each of axis.values, one at least
/// @param others  curves of methods that share the input alone, each as long as `scores`: where one
/// of them falls by half as much, it is the input that jumps
/// @return indices of the values that it falls towards; steps from or to what is not finite are
/// none
std::vector<std::size_t> jumps(const Axis& axis, const std::vector<double>& scores,
                               const std::vector<std::vector<double>>& others);

struct Step {
  double value = 0;
  double score = 0;  ///< NaN = refused
  Image picture;
  std::string refused;  ///< the ps::Error's message
};

struct Curve {
  std::string method;
  std::vector<Step> steps;
  double breaks = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> jumps;

  std::vector<double> scores() const;
  /// @return index of the first step that is broken; steps.size() if none is
  std::size_t first_broken(const Axis& axis) const;
};

/// What must never happen, and did.
struct Violation {
  std::string axis, method;
  double value = 0;
  std::string what;
};

struct AxisResult {
  std::vector<Curve> curves;  ///< by axis.methods
  std::vector<Violation> violations;
};

/// @brief Runs all methods at all values, each on one thread and on two, and holds them to what
/// must be: no exception but ps::Error, everything finite, the same bytes on two threads, nothing
/// observed overwritten. Leaves set_threads() at `threads`.
/// @param threads  1: each is run on one thread alone, and bytes are not compared
/// @param progress  called after each step; it may throw to stop
/// Throws ps::Error when the axis has fewer than two values or no method.
AxisResult run_axis(const Axis& axis, int threads, const std::function<void()>& progress = {});

/// @return a hash of the bytes of a cloud's points: place, footprint, colour, view and origin
std::uint64_t digest_of(const pcl::PointCloud<Point>& cloud);

/// @return a hash of the bytes of a picture's colours, whatever they are
std::uint64_t digest_of(const Image& image);

/// @return whether all its points are finite
bool finite(const pcl::PointCloud<Point>& cloud);

}  // namespace stress
}  // namespace ps
