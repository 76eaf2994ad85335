// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/pose_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ps {
namespace {

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

constexpr double kFits = 3;        ///< standard deviations within which a sighting is an inlier
constexpr double kNearest = 1e-3;  ///< of the median depth; nothing is nearer to the second camera
/// So wide that the place along the line says nothing, of the baseline's length least of all.
constexpr double kUnknownDepthError = 10;
constexpr double kLeastDepthError = 0.01, kMostDepthError = 0.4;
constexpr double kWidths[] = {4, 2, 1};  ///< of all spreads; a rough start needs wide ones
constexpr int kSteps = 30;               ///< for each width, at most
constexpr int kAttempts = 8;             ///< for each step, ever shorter

/// What is fitted. A step is a turn and a shift, both in the second camera's frame, and a change of
/// the depth error's logarithm.
struct Parameters {
  Pose pose = Pose::Identity();
  double depth_error = 0;

  Parameters moved(const Vector7& step) const {
    const double angle = step.head<3>().norm();
    Pose motion = Pose::Identity();
    if (angle > 0) motion.linear() = Eigen::AngleAxisd(angle, step.head<3>() / angle).matrix();
    motion.translation() = step.segment<3>(3);
    const double factor = std::exp(std::clamp(step[6], -0.5, 0.5));
    return {motion * pose, std::clamp(depth_error * factor, kLeastDepthError, kMostDepthError)};
  }
};

/// One sighting against the parameters.
struct Residual {
  double odds = 0;        ///< that it is a true match, not one that lies anywhere in the photo
  double m2 = HUGE_VAL;   ///< squared Mahalanobis distance
  double from_depth = 0;  ///< share of the depth's error in the variance along the line
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 2, 6> by_pose = Eigen::Matrix<double, 2, 6>::Zero();
};

class Fitter {
 public:
  /// Points are in units of `unit` metres.
  Fitter(const std::vector<Sighting>& sightings, const Intrinsics& lens, double unit)
      : sightings_(sightings), lens_(lens), unit_(unit) {}

  PoseFit run(const Pose& start, double pixel_sigma, double depth_error) {
    at_ = {start, std::clamp(depth_error, kLeastDepthError, kMostDepthError)};
    at_.pose.translation() /= unit_;
    for (const double width : kWidths) {
      width_ = width;
      pixel_sigma_ = width * pixel_sigma;
      climb();
    }
    return result();
  }

 private:
  Residual residual(const Sighting& s, const Parameters& at) const {
    Residual r;
    const Eigen::Vector3d turned = at.pose.linear() * s.point_in_first / unit_;
    const Eigen::Vector3d p = turned + at.pose.translation();
    if (!(p.z() > kNearest)) return r;
    Eigen::Matrix<double, 2, 3> by_point;
    by_point << lens_.fx / p.z(), 0, -lens_.fx * p.x() / (p.z() * p.z()),  //
        0, lens_.fy / p.z(), -lens_.fy * p.y() / (p.z() * p.z());
    Eigen::Matrix3d by_turn;
    by_turn << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
    r.by_pose << by_point * by_turn, by_point;
    const Eigen::Vector2d error = lens_.project(p) - s.pixel_in_second, g = by_point * turned;
    const double depth_error = width_ * (s.depth_known ? at.depth_error : kUnknownDepthError);
    const double across = pixel_sigma_ * pixel_sigma_, depth = depth_error * depth_error;
    const double along = across + depth * g.squaredNorm();
    r.information = (Eigen::Matrix2d::Identity() - g * g.transpose() * (depth / along)) / across;
    r.from_depth = s.depth_known ? 1 - across / along : 0;
    r.m2 = error.dot(r.information * error);
    // Without a depth, the place along the line is as free as the photo is wide, whatever the pose.
    const double length =
        s.depth_known ? std::sqrt(along) : std::max(lens_.width, lens_.height) / 4.;
    const double area = static_cast<double>(lens_.width) * lens_.height;
    r.odds = area / (2 * M_PI * pixel_sigma_ * length) * std::exp(-r.m2 / 2);
    return r;
  }

  double log_likelihood(const Parameters& at) const {
    double sum = 0;
    for (const Sighting& s : sightings_) sum += std::log1p(residual(s, at).odds);
    return sum;
  }

  /// By central differences: the covariances, too, depend on the pose.
  Vector7 gradient() const {
    constexpr double kStep = 1e-6;
    Vector7 slope;
    for (int i = 0; i < 7; ++i) {
      const Vector7 step = kStep * Vector7::Unit(i);
      slope[i] = (log_likelihood(at_.moved(step)) - log_likelihood(at_.moved(-step))) / (2 * kStep);
    }
    return slope;
  }

  /// Fisher's, with each sighting's probability of being a true match.
  Matrix7 information() const {
    Matrix7 sum = Matrix7::Zero();
    for (const Sighting& s : sightings_) {
      const Residual r = residual(s, at_);
      const double probability = r.odds / (1 + r.odds);
      sum.topLeftCorner<6, 6>() += probability * r.by_pose.transpose() * r.information * r.by_pose;
      sum(6, 6) += probability * 2 * r.from_depth * r.from_depth;
    }
    sum.diagonal().array() += 1e-9;
    sum(6, 6) += 0.1;
    return sum;
  }

  /// Levenberg-Marquardt.
  void climb() {
    double damping = 1e-4, now = log_likelihood(at_);
    for (int step = 0; step < kSteps; ++step) {
      const Matrix7 curvature = information();
      const Vector7 slope = gradient();
      const double before = now;
      for (int attempt = 0; attempt < kAttempts && !(now > before); ++attempt, damping *= 10) {
        Matrix7 damped = curvature;
        damped.diagonal() *= 1 + damping;
        const Parameters next = at_.moved(damped.ldlt().solve(slope));
        const double then = log_likelihood(next);
        if (!(then > now)) continue;
        at_ = next;
        now = then;
        damping /= 1000;
      }
      if (now - before < 1e-4) return;
    }
  }

  PoseFit result() const {
    PoseFit fit;
    fit.second_from_first = at_.pose;
    fit.second_from_first.translation() *= unit_;
    fit.depth_error = at_.depth_error;
    fit.log_likelihood = log_likelihood(at_);
    for (const Sighting& s : sightings_) {
      fit.inlier.push_back(residual(s, at_).m2 < kFits * kFits ? 1 : 0);
      fit.inliers += fit.inlier.back();
    }
    const Matrix7 covariance = information().ldlt().solve(Matrix7::Identity());
    fit.rotation_sigma = std::sqrt(covariance.diagonal().head<3>().sum());
    fit.translation_sigma = unit_ * std::sqrt(covariance.diagonal().segment<3>(3).sum());
    return fit;
  }

  const std::vector<Sighting>& sightings_;
  const Intrinsics& lens_;
  const double unit_;
  Parameters at_;
  double width_ = 1;
  double pixel_sigma_ = 1;
};

/// The median depth: steps and bounds are in its units, so that a scene's scale does not matter.
double unit_of(const std::vector<Sighting>& sightings) {
  std::vector<double> depths;
  for (const Sighting& s : sightings) depths.push_back(s.point_in_first.z());
  if (depths.empty()) return 1;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

}  // namespace

PoseFit fit_pose(const std::vector<Sighting>& sightings, const Intrinsics& second_lens,
                 const Pose& start, double pixel_sigma, double depth_error) {
  return Fitter(sightings, second_lens, unit_of(sightings)).run(start, pixel_sigma, depth_error);
}

}  // namespace ps
