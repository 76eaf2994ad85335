// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>

#include "libps/eval/perceptual.h"

namespace ps {

/// What is known of a set of samples once it is taken to be normally distributed.
struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double shrinkage = 0;  ///< share of the covariance that is a multiple of the identity
};

/// @brief Fits mean and covariance. The covariance of few samples in many dimensions is mostly
/// chance, so it is shrunk towards the multiple of the identity of the same trace, by the share
/// that Ledoit and Wolf derive from the samples ("A well-conditioned estimator for
/// large-dimensional covariance matrices", J. Multivariate Analysis 88, 2004). It falls to 0 as
/// samples get many.
/// @param samples  one in each row
/// Throws ps::Error for fewer than two samples and for values that are not finite.
Gaussian fit_gaussian(const Eigen::MatrixXd& samples);

/// @brief Squared Frechet (2-Wasserstein) distance of two normal distributions,
/// |m1 - m2|^2 + tr(C1 + C2 - 2 (C1^1/2 C2 C1^1/2)^1/2) (Dowson and Landau, 1982), which is what
/// FID takes. Never below 0.
/// Throws ps::Error when the dimensions differ.
double frechet_distance(const Gaussian& a, const Gaussian& b);

/// @return "Frechet distance on SqueezeNet 1.1 fire-9 features": to be printed with every such
/// distance, as it is FID on Inception's features alone
std::string frechet_name(const FeatureNetwork& network);

/// @return the features of images 0 to count - 1, one image in each row. Throws ps::Error when the
/// network gives more or fewer features of one image than of another.
Eigen::MatrixXd features_of(const FeatureNetwork& network, std::size_t count,
                            const std::function<Image(std::size_t)>& image);

}  // namespace ps
