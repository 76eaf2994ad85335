// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/frechet.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

#include "libps/core/error.h"

namespace ps {
namespace {

/// Ledoit and Wolf, section 3.3. @param centred  samples without their mean
double shrinkage_of(const Eigen::MatrixXd& centred) {
  const auto n = static_cast<double>(centred.rows());
  const Eigen::MatrixXd s = centred.transpose() * centred / n;
  const double mean = s.trace() / static_cast<double>(s.rows());
  const double spread = s.squaredNorm() - mean * mean * static_cast<double>(s.rows());
  if (!(spread > 0)) return 0;
  // The mean over the samples of |x x^T - S|^2, over n.
  const double chance =
      (centred.rowwise().squaredNorm().array().square().sum() / n - s.squaredNorm()) / n;
  return std::clamp(chance / spread, 0.0, 1.0);
}

/// Of a symmetric matrix without negative eigenvalues, but for rounding.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

Gaussian fit_gaussian(const Eigen::MatrixXd& samples) {
  if (samples.rows() < 2 || samples.cols() < 1) {
    throw Error("fit_gaussian",
                std::to_string(samples.rows()) + " samples of " + std::to_string(samples.cols()) +
                    " values",
                "at least two samples");
  }
  if (!samples.allFinite()) throw Error("fit_gaussian", "a value is not finite", "numbers");
  Gaussian fit;
  fit.mean = samples.colwise().mean();
  const Eigen::MatrixXd centred = samples.rowwise() - fit.mean.transpose();
  fit.shrinkage = shrinkage_of(centred);
  fit.covariance = centred.transpose() * centred / static_cast<double>(samples.rows() - 1);
  const double scale = fit.covariance.trace() / static_cast<double>(samples.cols());
  fit.covariance *= 1 - fit.shrinkage;
  fit.covariance.diagonal().array() += fit.shrinkage * scale;
  return fit;
}

double frechet_distance(const Gaussian& a, const Gaussian& b) {
  if (a.mean.size() != b.mean.size()) {
    throw Error(
        "frechet_distance",
        std::to_string(a.mean.size()) + " and " + std::to_string(b.mean.size()) + " dimensions",
        "as many of both");
  }
  const Eigen::MatrixXd root = square_root(a.covariance);
  const Eigen::MatrixXd product = root * b.covariance * root;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(product, Eigen::EigenvaluesOnly);
  const double shared = solver.eigenvalues().cwiseMax(0).cwiseSqrt().sum();
  return std::max(0.0, (a.mean - b.mean).squaredNorm() + a.covariance.trace() +
                           b.covariance.trace() - 2 * shared);
}

std::string frechet_name(const FeatureNetwork& network) {
  return "Frechet distance on " + network.name + " features";
}

Eigen::MatrixXd features_of(const FeatureNetwork& network, std::size_t count,
                            const std::function<Image(std::size_t)>& image) {
  Eigen::MatrixXd all;
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<float> features = network.features(image(i));
    const auto size = static_cast<Eigen::Index>(features.size());
    if (i == 0) all.resize(static_cast<Eigen::Index>(count), size);
    if (size != all.cols()) {
      throw Error(network.name, "gives " + std::to_string(size) + " features of an image",
                  std::to_string(all.cols()) + ", as of the first");
    }
    for (Eigen::Index k = 0; k < size; ++k) {
      all(static_cast<Eigen::Index>(i), k) = features[static_cast<std::size_t>(k)];
    }
  }
  return all;
}

}  // namespace ps
