// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/stress.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <opencv2/core.hpp>
#include <sstream>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/statistics.h"
#include "libps/geometry/point.h"

namespace ps::stress {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// How much worse `to` is than `from`.
double loss(const Axis& axis, double from, double to) {
  return axis.higher_is_better ? from - to : to - from;
}

bool same_picture(const Image& a, const Image& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.rows; ++y) {
    if (std::memcmp(a[y], b[y], sizeof(cv::Vec3f) * static_cast<std::size_t>(a.cols)) != 0) {
      return false;
    }
  }
  return true;
}

/// FNV-1a over words of 32 bits.
class Digest {
 public:
  void add(std::uint32_t word) { hash_ = (hash_ ^ word) * 1099511628211u; }
  void add(float x) {
    std::uint32_t word = 0;
    std::memcpy(&word, &x, sizeof word);
    add(word);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 1469598103934665603u;
};

/// What one run of a method gave, or why it gave nothing.
struct Attempt {
  Outcome outcome;
  double score = kNaN;
  std::string refused, crashed;
};

/// Does a part of an attempt, which may be refused or crash.
void attempt_to(const std::function<void()>& act, Attempt* attempt) {
  try {
    act();
  } catch (const Error& error) {
    attempt->refused = error.what();
  } catch (const std::exception& error) {
    attempt->crashed = error.what();
  }
}

Attempt attempt(const Axis& axis, const std::string& method, double value, int threads) {
  set_threads(threads);
  Attempt result;
  attempt_to([&] { result.outcome = axis.run(method, value); }, &result);
  return result;
}

/// What is wrong with two threads that is not with one; "" = nothing.
std::string unlike(const Attempt& one, const Attempt& two) {
  if (!one.crashed.empty()) return "";
  if (!two.crashed.empty())
    return "on two threads, an exception that is no ps::Error: " + two.crashed;
  const bool same = one.refused == two.refused && one.outcome.digest == two.outcome.digest &&
                    same_picture(one.outcome.picture, two.outcome.picture);
  return same ? "" : "other bytes on two threads than on one";
}

/// Runs a method at a value, and adds what is wrong with it to `violations`.
Step run_step(const Axis& axis, const std::string& method, double value, int threads,
              std::vector<Violation>* violations) {
  const auto report = [&](const std::string& what) {
    if (!what.empty()) violations->push_back({axis.name, method, value, what});
  };
  const bool compared = threads != 1;
  const Attempt two = compared ? attempt(axis, method, value, 2) : Attempt();
  Attempt one = attempt(axis, method, value, 1);
  if (compared) report(unlike(one, two));
  set_threads(threads);
  const Outcome& outcome = one.outcome;
  if (outcome.score) attempt_to([&] { one.score = outcome.score(); }, &one);
  if (!one.crashed.empty()) report("an exception that is no ps::Error: " + one.crashed);
  const bool finite =
      outcome.finite && (outcome.picture.empty() || cv::checkRange(outcome.picture));
  if (!finite) report("not finite");
  report(outcome.overwritten);
  return {value, one.score, outcome.picture, one.refused};
}

}  // namespace

std::string criterion_of(const Axis& axis) {
  std::ostringstream text;
  text << axis.score << " is " << (axis.higher_is_better ? "under " : "over ") << axis.limit
       << (axis.score_unit.empty() || axis.score_unit == "%" ? "" : " ") << axis.score_unit;
  return text.str();
}

bool broken(const Axis& axis, double score) {
  return std::isnan(score) || loss(axis, axis.limit, score) > 0;
}

double breaking_point(const Axis& axis, const std::vector<double>& scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (!broken(axis, scores[i])) continue;
    if (i == 0 || !std::isfinite(scores[i]) || !std::isfinite(scores[i - 1])) return axis.values[i];
    const double share =
        loss(axis, scores[i - 1], axis.limit) / loss(axis, scores[i - 1], scores[i]);
    return axis.values[i - 1] + share * (axis.values[i] - axis.values[i - 1]);
  }
  return std::numeric_limits<double>::infinity();
}

std::vector<std::size_t> jumps(const Axis& axis, const std::vector<double>& scores,
                               const std::vector<std::vector<double>>& others) {
  std::vector<double> changes;
  double least = scores.front(), most = scores.front();
  for (std::size_t i = 1; i < scores.size(); ++i) {
    const double change = scores[i] - scores[i - 1];
    if (!std::isfinite(change)) continue;
    changes.push_back(std::abs(change));
    least = std::fmin(least, std::fmin(scores[i], scores[i - 1]));
    most = std::fmax(most, std::fmax(scores[i], scores[i - 1]));
  }
  std::vector<std::size_t> found;
  for (std::size_t i = 1; i < scores.size(); ++i) {
    const double fall = loss(axis, scores[i - 1], scores[i]);
    const bool steep = std::isfinite(fall) && fall > 4 * median(changes) && 3 * fall > most - least;
    const bool shared = std::any_of(others.begin(), others.end(), [&](const auto& other) {
      return loss(axis, other[i - 1], other[i]) > fall / 2;
    });
    if (steep && !shared) found.push_back(i);
  }
  return found;
}

std::vector<double> Curve::scores() const {
  std::vector<double> result;
  for (const Step& step : steps) result.push_back(step.score);
  return result;
}

std::size_t Curve::first_broken(const Axis& axis) const {
  const auto at = std::find_if(steps.begin(), steps.end(),
                               [&](const Step& step) { return broken(axis, step.score); });
  return static_cast<std::size_t>(at - steps.begin());
}

AxisResult run_axis(const Axis& axis, int threads, const std::function<void()>& progress) {
  if (axis.values.size() < 2 || axis.methods.empty()) {
    throw Error(axis.name, "is no axis", "two values and one method at least");
  }
  AxisResult result;
  for (const std::string& method : axis.methods) {
    Curve curve;
    curve.method = method;
    for (const double value : axis.values) {
      curve.steps.push_back(run_step(axis, method, value, threads, &result.violations));
      if (progress) progress();
    }
    curve.breaks = breaking_point(axis, curve.scores());
    result.curves.push_back(std::move(curve));
  }
  std::vector<std::vector<double>> others;
  for (std::size_t m = 1; m < result.curves.size(); ++m) {
    if (axis.methods[m].rfind(axis.methods[0], 0) != 0) others.push_back(result.curves[m].scores());
  }
  Curve& ours = result.curves.front();
  ours.jumps = jumps(axis, ours.scores(), others);
  return result;
}

std::uint64_t digest_of(const Cloud& cloud) {
  Digest digest;
  for (const Point& p : cloud) {
    for (const float x : {p.x, p.y, p.z, p.footprint}) digest.add(x);
    digest.add(p.rgba);
    digest.add(static_cast<std::uint32_t>(p.view) << 8 | p.origin);
  }
  return digest.value();
}

std::uint64_t digest_of(const Image& image) {
  Digest digest;
  for (const cv::Vec3f& c : image) {
    for (int k = 0; k < 3; ++k) digest.add(c[k]);
  }
  return digest.value();
}

bool finite(const Cloud& cloud) {
  return std::all_of(cloud.begin(), cloud.end(), [](const Point& p) {
    return p.getVector3fMap().allFinite() && std::isfinite(p.footprint);
  });
}

}  // namespace ps::stress
