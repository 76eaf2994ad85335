// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/pose_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace ps {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix26 = Eigen::Matrix<double, 2, 6>;

constexpr double kFits = 3;        ///< standard deviations within which a sighting is an inlier
constexpr double kNearest = 1e-2;  ///< of the second camera's depth, metres: nothing is nearer
constexpr double kUnknownDepthError = 1;  ///< of a depth that is that of others
/// Factors of pixel_sigma by round: wide at first, so that a rough start finds its inliers.
constexpr std::array<double, 3> kWidths = {4, 2, 1};
constexpr int kSteps = 20;  ///< of a round, at most

/// One sighting against a pose.
struct Residual {
  bool before = false;       ///< the point is before the second camera; else the rest is nothing
  Eigen::Vector2d error;     ///< pixels
  Eigen::Vector2d by_depth;  ///< g: derivative of the projection by the log of the point's depth
  Matrix26 by_pose;          ///< by a turn, then a shift, both in the second camera's frame
};

Residual residual_of(const Sighting& s, const Intrinsics& k, const Pose& pose) {
  Residual r;
  const Eigen::Vector3d turned = pose.linear() * s.point_in_first, p = turned + pose.translation();
  r.before = p.z() > kNearest;
  if (!r.before) return r;
  r.error = k.project(p) - s.pixel_in_second;
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << k.fx / p.z(), 0, -k.fx * p.x() / (p.z() * p.z()),  //
      0, k.fy / p.z(), -k.fy * p.y() / (p.z() * p.z());
  r.by_depth = by_point * turned;
  Eigen::Matrix3d cross;
  cross << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
  r.by_pose << by_point * cross, by_point;
  return r;
}

/// How a sighting's residual is spread.
struct Spread {
  double m2 = HUGE_VAL;        ///< squared Mahalanobis distance
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  double odds = 0;  ///< of a match that fits, to one that lies anywhere in the photo
};

Spread spread_of(const Sighting& s, const Residual& r, double pixel_sigma, double depth_error,
                 double area) {
  Spread spread;
  if (!r.before) return spread;
  if (!s.depth_known) depth_error = kUnknownDepthError;
  const Eigen::Vector2d& g = r.by_depth;
  const double a = pixel_sigma * pixel_sigma, b = depth_error * depth_error;
  const double along = a + b * g.squaredNorm();
  spread.information = (Eigen::Matrix2d::Identity() - g * g.transpose() * (b / along)) / a;
  spread.m2 = r.error.dot(spread.information * r.error);
  spread.odds = area / (2 * M_PI * std::sqrt(a * along)) * std::exp(-0.5 * spread.m2);
  return spread;
}

Pose moved(const Pose& pose, const Vector6& step) {
  const double angle = step.head<3>().norm();
  Pose turn = Pose::Identity();
  if (angle > 0) turn.linear() = Eigen::AngleAxisd(angle, step.head<3>() / angle).matrix();
  turn.translation() = step.tail<3>();
  return turn * pose;
}

class Fitter {
 public:
  Fitter(const std::vector<Sighting>& sightings, const Intrinsics& lens, const Pose& start)
      : sightings_(sightings), lens_(lens), pose_(start) {}

  PoseFit run(double pixel_sigma, double depth_error) {
    for (const double width : kWidths) {
      pixel_sigma_ = width * pixel_sigma;
      depth_error_ = (getenv("WD") ? std::min(width, atof(getenv("WD"))) : width) * depth_error;
      descend();
    }
    return result();
  }

 private:
  Spread spread(std::size_t i, const Residual& r) const {
    return spread_of(sightings_[i], r, pixel_sigma_, depth_error_,
                     static_cast<double>(lens_.width) * lens_.height);
  }

  double cost(const Pose& pose) const {
    double sum = 0;
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      sum -= std::log1p(spread(i, residual_of(sightings_[i], lens_, pose)).odds);
    }
    return sum;
  }

  void normal_equations(Matrix6* h, Vector6* b) const {
    h->setZero();
    b->setZero();
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const Residual r = residual_of(sightings_[i], lens_, pose_);
      if (!r.before) continue;
      const Spread s = spread(i, r);
      const Matrix26 weighted = s.odds / (1 + s.odds) * s.information * r.by_pose;
      *h += weighted.transpose() * r.by_pose;
      *b += weighted.transpose() * r.error;
    }
  }

  Vector6 slope() const {
    Vector6 b;
    for (int i = 0; i < 6; ++i) {
      const double scale = i < 3 ? 1e-6 : 1e-6;
      const Vector6 step = scale * Vector6::Unit(i);
      b[i] = (cost(moved(pose_, step)) - cost(moved(pose_, -step))) / (2 * scale);
    }
    return b;
  }

  void descend() {
    double damping = 1e-4, now = cost(pose_);
    for (int step = 0; step < kSteps; ++step) {
      Matrix6 h;
      Vector6 b;
      normal_equations(&h, &b);
      if (!getenv("NONUM")) b = slope();
      for (int attempt = 0; attempt < 8; ++attempt, damping *= 10) {
        Matrix6 damped = h;
        damped.diagonal() *= 1 + damping;
        damped.diagonal().array() += 1e-12;
        const Pose next = moved(pose_, -damped.ldlt().solve(b));
        const double then = cost(next);
        if (!(then < now)) continue;
        const bool done = now - then < 1e-6;
        pose_ = next;
        now = then;
        damping /= 100;
        if (done) return;
        break;
      }
      if (damping > 1e3) return;
    }
  }

  PoseFit result() const {
    PoseFit fit;
    fit.second_from_first = pose_;
    fit.cost = cost(pose_);
    fit.depth_error = depth_error_;
    Matrix6 h = Matrix6::Zero();
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const Residual r = residual_of(sightings_[i], lens_, pose_);
      const Spread s = spread(i, r);
      const bool fits = s.m2 < kFits * kFits;
      fit.inlier.push_back(fits);
      fit.inliers += fits;
      if (fits) h += r.by_pose.transpose() * s.information * r.by_pose;
    }
    h.diagonal().array() += 1e-12;
    const Matrix6 covariance = h.ldlt().solve(Matrix6::Identity());
    fit.rotation_sigma = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
    fit.translation_sigma = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
    return fit;
  }

  const std::vector<Sighting>& sightings_;
  const Intrinsics& lens_;
  Pose pose_;
  double pixel_sigma_ = 1, depth_error_ = 1;
};

}  // namespace

PoseFit fit_pose(const std::vector<Sighting>& sightings, const Intrinsics& second_lens,
                 const Pose& start, double pixel_sigma, double depth_error) {
  return Fitter(sightings, second_lens, start).run(pixel_sigma, depth_error);
}

}  // namespace ps
