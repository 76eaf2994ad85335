// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/depth_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <vector>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/geometry/depth_fit.h"
#include "libps/geometry/membrane.h"

namespace ps {
namespace {

constexpr float kLeastDepth = 1e-9f, kMostDepth = 1e9f;
constexpr float kFirm = 100;  ///< a spring that hardly gives
constexpr std::size_t kRowsAtATime = 16;

bool known(float depth) { return depth >= kLeastDepth && depth <= kMostDepth; }

template <class Body>
void for_pixels(cv::Size size, const Body& body) {
  parallel_chunks(size.height, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < size.width; ++x) body(y, x);
    }
  });
}

/// Both depths as logarithms, 0 where unknown.
struct Logs {
  cv::Mat1f cloud, estimate;
  Mask seen;       ///< the cloud is visible, known and not missing
  Mask estimated;  ///< the estimate is known
  Mask both;
};

Logs logs_of(const Depth& estimate, const Depth& cloud_depth, const Mask& visible,
             const Mask& missing) {
  const cv::Size size = estimate.size();
  Logs logs{cv::Mat1f(size, 0.f), cv::Mat1f(size, 0.f), Mask(size), Mask(size), Mask(size)};
  for_pixels(size, [&](int y, int x) {
    const float cloud = cloud_depth(y, x), guess = estimate(y, x);
    const bool seen = visible(y, x) != 0 && missing(y, x) == 0 && known(cloud);
    if (seen) logs.cloud(y, x) = std::log(cloud);
    if (known(guess)) logs.estimate(y, x) = std::log(guess);
    logs.seen(y, x) = seen;
    logs.estimated(y, x) = known(guess);
    logs.both(y, x) = seen && known(guess);
  });
  return logs;
}

/// Pixels that an edge of depth may be wide, to one side: so many of 256.
int edge_reach(cv::Size size) { return std::max(1, std::min(size.width, size.height) / 128); }

/// @return 1 on even ground, less near edges of depth, where depths mix and edges do not meet
cv::Mat1f evenness(const cv::Mat1f& logarithm, const Mask& where) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  constexpr float kEdge = 0.2f;  // a range of logarithms
  cv::Mat1f high(logarithm.size(), -kHuge), low(logarithm.size(), kHuge);
  logarithm.copyTo(high, where);
  logarithm.copyTo(low, where);
  const int side = 2 * edge_reach(logarithm.size()) + 1;
  const cv::Mat1b window(side, side, 1);
  cv::dilate(high, high, window);
  cv::erode(low, low, window);
  for_pixels(logarithm.size(), [&](int y, int x) {
    const float edges = (high(y, x) - low(y, x)) / kEdge;
    high(y, x) = where(y, x) ? 1 / (1 + edges * edges) : 0;
  });
  return high;
}

/// The seam is where the fit has to be good, but what is far from it tells of the scale too.
cv::Mat1f weights_of_fit(const cv::Mat1f& even, const Mask& both, const Mask& missing,
                         double decay) {
  constexpr float kLeast = 0.25f;
  cv::Mat1f distance, weight(even.size(), 0.f);
  cv::distanceTransform(missing == 0, distance, cv::DIST_L2, cv::DIST_MASK_5);
  for_pixels(even.size(), [&](int y, int x) {
    if (!both(y, x)) return;
    const float near = std::exp(-distance(y, x) / static_cast<float>(decay));
    weight(y, x) = even(y, x) * (kLeast + near);
  });
  return weight;
}

/// How much a visible pixel's log ratio says of what is missing: nothing when the cloud is
/// much nearer than the fitted estimate, as a thing before a background is.
float word(float log_ratio, double spread) {
  constexpr double kNearSpreads = 5, kFarSpreads = 8, kLeastCut = 0.1;
  const double cut = std::max(kLeastCut, spread * (log_ratio < 0 ? kNearSpreads : kFarSpreads));
  const double r = log_ratio / cut;
  return std::fabs(r) < 1 ? static_cast<float>((1 - r * r) * (1 - r * r)) : 0;
}

/// What is to be added to the fitted logarithm.
cv::Mat1f correction(const Logs& logs, const cv::Mat1f& even, const DepthFit& fit, double decay) {
  // A few pixels of 256 are averaged.
  const double average = 0.75 * edge_reach(even.size());
  const auto firm = static_cast<float>(1 / (average * average));
  const auto loose = static_cast<float>(1 / (decay * decay));
  cv::Mat1f value(even.size(), 0.f), weight(even.size(), loose);
  for_pixels(even.size(), [&](int y, int x) {
    if (!logs.both(y, x)) return;
    value(y, x) = logs.cloud(y, x) - fit(logs.estimate(y, x));
    weight(y, x) = firm * even(y, x) * word(value(y, x), fit.spread);
  });
  return solve_membrane(value, weight);
}

double residual_of(const Logs& logs, const DepthFit& fit) {
  std::vector<float> sizes;
  for (int y = 0; y < logs.both.rows; ++y) {
    for (int x = 0; x < logs.both.cols; ++x) {
      if (logs.both(y, x)) {
        sizes.push_back(std::fabs(logs.cloud(y, x) - fit(logs.estimate(y, x))));
      }
    }
  }
  return median(sizes);
}

float depth_of(float logarithm) { return std::clamp(std::exp(logarithm), kLeastDepth, kMostDepth); }

/// Gives unknown pixels a depth, harmonic in 1/z; with no depth known, does nothing.
void fill(Depth* depth) {
  const bool whole = std::all_of(depth->begin(), depth->end(), known);
  if (whole) return;
  cv::Mat1f inverse(depth->size(), 0.f), weight(depth->size(), 0.f);
  for_pixels(depth->size(), [&](int y, int x) {
    if (!known((*depth)(y, x))) return;
    inverse(y, x) = 1 / (*depth)(y, x);
    weight(y, x) = kFirm;
  });
  inverse = solve_membrane(inverse, weight);
  for_pixels(depth->size(), [&](int y, int x) {
    if (!known((*depth)(y, x)) && inverse(y, x) > 0) (*depth)(y, x) = 1 / inverse(y, x);
  });
}

/// The median relative step from seen pixels to missing neighbours.
/// @param depth_at  of (a seen pixel, the step to the missing one): the depth beyond
template <class DepthAt>
double seam_step(const Depth& cloud_depth, const Mask& seen, const Mask& missing,
                 const DepthAt& depth_at) {
  constexpr int kAround[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const cv::Rect image({0, 0}, seen.size());
  std::vector<float> steps;
  for (int y = 0; y < seen.rows; ++y) {
    for (int x = 0; x < seen.cols; ++x) {
      if (!seen(y, x)) continue;
      for (const auto& [dy, dx] : kAround) {
        const cv::Point beyond(x + dx, y + dy);
        if (!image.contains(beyond) || !missing(beyond)) continue;
        const float depth = depth_at(cv::Point(x, y), cv::Point(dx, dy));
        if (known(depth)) steps.push_back(std::fabs(depth / cloud_depth(y, x) - 1));
      }
    }
  }
  return steps.empty() ? std::numeric_limits<double>::quiet_NaN() : median(steps);
}

void check(const DepthAlignmentOptions& o) {
  const bool sound = o.min_exponent > 0 && o.min_exponent <= 1 && o.max_exponent >= 1 &&
                     std::isfinite(o.max_exponent) && o.decay >= 0 && std::isfinite(o.decay) &&
                     o.max_residual > 0 && o.min_pixels > 0;
  if (sound) return;
  throw Error(
      "align_depth", "an option is out of range",
      "0 < min_exponent <= 1 <= max_exponent, decay >= 0, max_residual > 0 and min_pixels > 0");
}

void check_sizes(const Depth& estimate, const Depth& cloud_depth, const Mask& visible,
                 const Mask& missing) {
  const cv::Size size = estimate.size();
  if (size.empty() || cloud_depth.size() != size || visible.size() != size ||
      missing.size() != size) {
    throw Error("align_depth", "the two depths and masks differ in size or are empty", "one size");
  }
}

/// @return why the two do not agree; empty when they do
std::string objection(double residual, double exponent, const DepthAlignmentOptions& options) {
  const bool bound = exponent <= options.min_exponent || exponent >= options.max_exponent;
  if (residual <= (bound ? options.max_residual / 2 : options.max_residual)) return {};
  std::ostringstream why;
  why.precision(2);
  why << "the median log ratio after the fit is " << residual;
  if (bound) why << ", the exponent at its limit";
  return why.str();
}

/// Fits, and writes to `aligned` how well.
DepthFit fit_of(const Logs& logs, const cv::Mat1f& weights, const DepthAlignmentOptions& options,
                AlignedDepth* aligned) {
  const DepthFit fit = fit_log_depth(logs.estimate, logs.cloud, weights,
                                     {options.min_exponent, options.max_exponent});
  aligned->scale = std::exp(fit.log_scale);
  aligned->exponent = fit.exponent;
  aligned->residual = residual_of(logs, fit);
  aligned->why = objection(aligned->residual, aligned->exponent, options);
  aligned->agreed = aligned->why.empty();
  return fit;
}

/// Gives pixels that are not seen their estimate, fitted and corrected.
void add_estimate(const Logs& logs, const DepthFit& fit, const cv::Mat1f& correction,
                  Depth* depth) {
  for_pixels(depth->size(), [&](int y, int x) {
    if (logs.seen(y, x) || !logs.estimated(y, x)) return;
    (*depth)(y, x) = depth_of(fit(logs.estimate(y, x)) + correction(y, x));
  });
}

}  // namespace

AlignedDepth align_depth(const Depth& estimate, const Depth& cloud_depth, const Mask& visible,
                         const Mask& missing, const DepthAlignmentOptions& options) {
  check(options);
  check_sizes(estimate, cloud_depth, visible, missing);
  const Logs logs = logs_of(estimate, cloud_depth, visible, missing);
  const int both = cv::countNonZero(logs.both);
  AlignedDepth aligned;
  DepthFit fit;
  aligned.depth = Depth::zeros(estimate.size());
  cloud_depth.copyTo(aligned.depth, logs.seen);
  if (cv::countNonZero(logs.seen) == 0) {
    aligned.why = "nothing is visible";
    estimate.copyTo(aligned.depth, logs.estimated);
  } else if (both < options.min_pixels) {
    aligned.why = "only " + std::to_string(both) + " visible pixels have both depths";
  } else {
    const double decay =
        options.decay > 0 ? options.decay : std::min(estimate.rows, estimate.cols) / 3.0;
    const cv::Mat1f even =
        evenness(logs.cloud, logs.seen).mul(evenness(logs.estimate, logs.estimated));
    fit = fit_of(logs, weights_of_fit(even, logs.both, missing, decay), options, &aligned);
    if (aligned.agreed) {
      add_estimate(logs, fit, correction(logs, even, fit, decay), &aligned.depth);
    }
  }
  fill(&aligned.depth);
  if (!known(aligned.depth(0, 0)) && cv::countNonZero(missing) > 0) {
    throw Error("align_depth", "no depth is known at all", "one of estimate or visible cloud");
  }
  const auto median_step = [&](const auto& depth_at) {
    return seam_step(cloud_depth, logs.seen, missing, depth_at);
  };
  aligned.seam_step_before = median_step([&](cv::Point p, cv::Point step) {
    return logs.estimated(p + step) ? depth_of(fit(logs.estimate(p + step))) : 0;
  });
  aligned.seam_step =
      median_step([&](cv::Point p, cv::Point step) { return aligned.depth(p + step); });
  const cv::Rect image({0, 0}, logs.seen.size());
  aligned.seam_step_seen = median_step([&](cv::Point p, cv::Point step) {
    return image.contains(p - step) && logs.seen(p - step) ? cloud_depth(p - step) : 0;
  });
  return aligned;
}

}  // namespace ps
