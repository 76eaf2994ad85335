// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/frechet.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "libps/core/error.h"
#include "libps/models/lpips.h"
#include "tests/support/random_weights.h"

namespace ps {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_samples(int count, int size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  MatrixXd mix(size, size), samples(count, size);
  for (double& v : mix.reshaped()) v = normal(random);
  for (double& v : samples.reshaped()) v = normal(random);
  return samples * mix;
}

/// The formula as FID's authors compute it: the root of a product that is not symmetric.
double distance_by_definition(const Gaussian& a, const Gaussian& b) {
  const MatrixXd root = (a.covariance * b.covariance).sqrt();
  return (a.mean - b.mean).squaredNorm() + (a.covariance + b.covariance - 2 * root).trace();
}

TEST(Frechet, is_what_the_definition_gives) {
  for (const int size : {1, 2, 7, 20}) {
    const Gaussian a = fit_gaussian(random_samples(100, size, 1)),
                   b = fit_gaussian(random_samples(150, size, 2));
    const double expected = distance_by_definition(a, b);
    EXPECT_GT(expected, 0.01);
    EXPECT_NEAR(frechet_distance(a, b), expected, 1e-6 * expected) << size;
    EXPECT_NEAR(frechet_distance(b, a), expected, 1e-6 * expected) << size;
  }
}

TEST(Frechet, of_distributions_with_one_covariance_is_the_square_between_their_means) {
  const MatrixXd samples = random_samples(50, 6, 3);
  const VectorXd step = VectorXd::LinSpaced(6, -1, 2);
  const MatrixXd moved = samples.rowwise() + step.transpose();
  EXPECT_NEAR(frechet_distance(fit_gaussian(samples), fit_gaussian(moved)), step.squaredNorm(),
              1e-9);
}

TEST(Frechet, of_diagonal_covariances_is_that_of_their_deviations) {
  Gaussian a = {VectorXd::Zero(3), MatrixXd::Zero(3, 3), 0}, b = a;
  a.covariance.diagonal() << 1, 4, 0;
  b.covariance.diagonal() << 9, 4, 0.25;
  EXPECT_NEAR(frechet_distance(a, b), 2 * 2 + 0 + 0.5 * 0.5, 1e-12);
}

TEST(Frechet, of_fewer_samples_than_dimensions_is_finite_and_of_a_set_with_itself_nothing) {
  for (const int count : {2, 3, 30}) {
    const Gaussian few = fit_gaussian(random_samples(count, 64, 4));
    EXPECT_NEAR(frechet_distance(few, few), 0, 1e-9 * few.covariance.trace());
    const double other = frechet_distance(few, fit_gaussian(random_samples(count, 64, 5)));
    EXPECT_TRUE(std::isfinite(other));
    EXPECT_GT(other, 1);
  }
}

/// Ledoit and Wolf's share, sum by sum.
TEST(FitGaussian, shrinks_by_ledoit_and_wolf_s_share) {
  const int n = 12, d = 5;
  const MatrixXd samples = random_samples(n, d, 6);
  const VectorXd mean = samples.colwise().mean();
  MatrixXd s = MatrixXd::Zero(d, d);
  for (int k = 0; k < n; ++k) {
    const VectorXd x = samples.row(k).transpose() - mean;
    s += x * x.transpose() / n;
  }
  double chance = 0;
  for (int k = 0; k < n; ++k) {
    const VectorXd x = samples.row(k).transpose() - mean;
    chance += (x * x.transpose() - s).squaredNorm() / n / n;
  }
  const MatrixXd target = MatrixXd::Identity(d, d) * s.trace() / d;
  const double share = std::min(1.0, chance / (s - target).squaredNorm());
  const Gaussian fit = fit_gaussian(samples);
  EXPECT_GT(share, 0.01);
  EXPECT_NEAR(fit.shrinkage, share, 1e-12);
  const MatrixXd expected = ((1 - share) * s + share * target) * n / (n - 1);
  EXPECT_LT((fit.covariance - expected).norm(), 1e-10 * expected.norm());
}

TEST(FitGaussian, hardly_shrinks_many_samples_and_brings_few_nearer_to_the_truth) {
  EXPECT_LT(fit_gaussian(random_samples(20000, 4, 7)).shrinkage, 0.001);
  // 30 samples of 64 independent numbers: the covariance is the identity.
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  MatrixXd samples(30, 64);
  for (double& v : samples.reshaped()) v = normal(random);
  const Gaussian fit = fit_gaussian(samples);
  EXPECT_GT(fit.shrinkage, 0.8);
  const MatrixXd centred = samples.rowwise() - samples.colwise().mean();
  const MatrixXd plain = centred.transpose() * centred / 29, truth = MatrixXd::Identity(64, 64);
  EXPECT_LT((fit.covariance - truth).norm(), 0.3 * (plain - truth).norm());
}

TEST(FitGaussian, takes_equal_samples_and_refuses_too_few_and_nan) {
  const Gaussian equal = fit_gaussian(MatrixXd::Constant(5, 3, 2.0));
  EXPECT_EQ(equal.covariance.norm(), 0);
  EXPECT_EQ(frechet_distance(equal, equal), 0);
  EXPECT_THROW(fit_gaussian(MatrixXd::Zero(1, 3)), Error);
  EXPECT_THROW(fit_gaussian(MatrixXd::Zero(3, 0)), Error);
  EXPECT_THROW(fit_gaussian(MatrixXd::Constant(3, 3, std::nan(""))), Error);
  EXPECT_THROW(frechet_distance(equal, fit_gaussian(MatrixXd::Zero(4, 2))), Error);
}

Image waves(int size, float frequency) {
  Image image(size, size + 3);
  for (int i = 0; i < static_cast<int>(image.total()); ++i) {
    const float x = frequency * static_cast<float>(i % image.cols),
                y = frequency * static_cast<float>(i / image.cols);
    image(i / image.cols, i % image.cols) = {0.5f + 0.5f * std::sin(x), 0.5f + 0.5f * std::cos(y),
                                             0.5f};
  }
  return image;
}

TEST(Frechet, on_features_of_images_tells_one_kind_from_another_and_says_of_which_network) {
  const models::Lpips net(models::random_lpips(8));
  const FeatureNetwork network = lpips_features(net);
  EXPECT_EQ(frechet_name(network), "Frechet distance on SqueezeNet 1.1 fire-9 features");
  const auto fit = [&](float from, float to) {
    return fit_gaussian(features_of(network, 8, [&](std::size_t i) {
      return waves(33, from + (to - from) * static_cast<float>(i) / 8);
    }));
  };
  const Gaussian slow = fit(0.1f, 0.2f), slow_too = fit(0.105f, 0.205f), fast = fit(1, 2);
  EXPECT_EQ(slow.mean.size(), net.feature_count());
  EXPECT_LT(frechet_distance(slow, slow_too), 0.1 * frechet_distance(slow, fast));
}

TEST(FeaturesOf, refuses_a_network_whose_features_come_and_go) {
  int calls = 0;
  const FeatureNetwork odd = {
      "odd", [&](const Image&) { return std::vector<float>(static_cast<std::size_t>(++calls)); }};
  EXPECT_THROW(features_of(odd, 2, [](std::size_t) { return Image(1, 1); }), Error);
  EXPECT_EQ(features_of(odd, 0, [](std::size_t) { return Image(1, 1); }).size(), 0);
}

}  // namespace
}  // namespace ps
