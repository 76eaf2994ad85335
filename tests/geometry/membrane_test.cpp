// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/membrane.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <vector>

#include "libps/core/random.h"

namespace ps {
namespace {

float random_at(std::uint32_t a, std::uint32_t b, std::uint32_t what) {
  return static_cast<float>(random_unit(1, {a, b, what, 0}));
}

/// The same, as a system of linear equations.
cv::Mat1f solved_directly(const cv::Mat1f& value, const cv::Mat1f& weight) {
  const int count = static_cast<int>(value.total());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd pull(count);
  const auto link = [&](int i, int j) {
    entries.insert(entries.end(), {{i, i, 1}, {j, j, 1}, {i, j, -1}, {j, i, -1}});
  };
  for (int i = 0; i < count; ++i) {
    const int x = i % value.cols, y = i / value.cols;
    entries.emplace_back(i, i, weight(y, x));
    pull[i] = static_cast<double>(weight(y, x)) * value(y, x);
    if (x + 1 < value.cols) link(i, i + 1);
    if (y + 1 < value.rows) link(i, i + value.cols);
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd u = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(pull);
  cv::Mat1f result(value.size());
  for (int i = 0; i < count; ++i) result(i / value.cols, i % value.cols) = static_cast<float>(u[i]);
  return result;
}

/// Values are known on one side of a slanted, ragged seam, with `firm` springs, and beyond it
/// `loose` ones pull to 0.
void expect_as_solved_directly(cv::Size size, float firm, float loose) {
  cv::Mat1f value(size, 0.f), weight(size, loose);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float seam = 0.5f * size.width + 0.3f * y + 4 * random_at(y, 0, 0);
      if (static_cast<float>(x) > seam) continue;
      value(y, x) = std::sin(0.05f * x) * std::cos(0.03f * y);
      weight(y, x) = firm * random_at(x, y, 1);
    }
  }
  const double error =
      cv::norm(solve_membrane(value, weight), solved_directly(value, weight), cv::NORM_INF);
  EXPECT_LT(error, 5e-3) << size << " " << firm << " " << loose;
}

TEST(Membrane, is_that_of_a_direct_solver) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 1), cv::Size(1, 37), cv::Size(64, 1),
                              cv::Size(33, 31), cv::Size(101, 70)}) {
    for (const float firm : {100.f, 1.f, 0.1f}) {
      for (const float loose : {0.f, 1e-3f}) expect_as_solved_directly(size, firm, loose);
    }
  }
}

TEST(Membrane, keeps_a_constant) {
  cv::Mat1f value(61, 83, 0.3f), weight(61, 83, 0.f);
  weight(30, 5) = 1;
  EXPECT_LT(cv::norm(solve_membrane(value, weight), value, cv::NORM_INF), 1e-6);
}

TEST(Membrane, decays_over_its_length) {
  constexpr double kLength = 20;
  cv::Mat1f value(3, 400, 0.f), weight(3, 400, static_cast<float>(1 / (kLength * kLength)));
  value.col(0) = 1;
  weight.col(0) = 10;
  const cv::Mat1f u = solve_membrane(value, weight);
  for (int x = 0; x < 100; ++x) EXPECT_NEAR(u(1, x), std::exp(-x / kLength), 0.01) << x;
}

TEST(Membrane, without_weights_is_flat) {
  const cv::Mat1f u = solve_membrane(cv::Mat1f(9, 7, 5.f), cv::Mat1f(9, 7, 0.f));
  EXPECT_EQ(cv::countNonZero(u), 0);
}

}  // namespace
}  // namespace ps
