// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/second_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "libps/geometry/overlap.h"

namespace ps {
namespace {

constexpr int kCells = 32;            ///< along the long side
constexpr float kSameSurface = 0.4f;  ///< log ratio; farther off, one view sees another surface
constexpr std::size_t kEnough = 20;   ///< ratios at which a cell counts in full
constexpr double kWide = 5, kNarrow = 1.5;  ///< of the blurs, cells
constexpr float kFaint = 0.03f;             ///< weight of no change at all

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Log ratios of one surface, those of hidden places left out.
std::vector<DepthRatio> same_surface(const View& first, const View& second) {
  std::vector<DepthRatio> ratios = depth_ratios(first, second);
  ratios.erase(
      std::remove_if(ratios.begin(), ratios.end(),
                     [](const DepthRatio& r) { return !(std::abs(r.log_ratio) < kSameSurface); }),
      ratios.end());
  return ratios;
}

double median_size(const std::vector<DepthRatio>& ratios) {
  if (ratios.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<float> sizes;
  for (const DepthRatio& r : ratios) sizes.push_back(std::abs(r.log_ratio));
  return median(std::move(sizes));
}

/// The weighted mean around each cell, 0 where nothing is near.
cv::Mat1f blurred(const cv::Mat1f& values, const cv::Mat1f& weights, double sigma) {
  cv::Mat1f sum, weight;
  cv::GaussianBlur(values.mul(weights), sum, {}, sigma, sigma, cv::BORDER_CONSTANT);
  cv::GaussianBlur(weights, weight, {}, sigma, sigma, cv::BORDER_CONSTANT);
  return sum / (weight + kFaint);
}

/// The field over the second's pixels that the log ratios ask for.
cv::Mat1f field(const std::vector<DepthRatio>& ratios, cv::Size size) {
  const double cell = static_cast<double>(std::max(size.width, size.height)) / kCells;
  const cv::Size cells(std::max(1, cvRound(size.width / cell)),
                       std::max(1, cvRound(size.height / cell)));
  std::vector<std::vector<float>> in_cell(cells.area());
  for (const DepthRatio& r : ratios) {
    const int x =
        std::clamp(static_cast<int>((r.u + 0.5) * cells.width / size.width), 0, cells.width - 1);
    const int y =
        std::clamp(static_cast<int>((r.v + 0.5) * cells.height / size.height), 0, cells.height - 1);
    in_cell[static_cast<std::size_t>(y) * cells.width + x].push_back(r.log_ratio);
  }
  cv::Mat1f middle(cells, 0.f), weight(cells, 0.f);
  for (int i = 0; i < cells.area(); ++i) {
    if (in_cell[i].empty()) continue;
    middle(i / cells.width, i % cells.width) = median(in_cell[i]);
    weight(i / cells.width, i % cells.width) =
        std::min(1.f, static_cast<float>(in_cell[i].size()) / kEnough);
  }
  cv::Mat1f smooth = blurred(middle, weight, kWide);
  smooth += blurred(middle - smooth, weight, kNarrow);
  cv::Mat1f fine;
  cv::resize(smooth, fine, size, 0, 0, cv::INTER_CUBIC);
  return fine;
}

}  // namespace

SecondView second_view(const View& first, const View& second) {
  check(first, "first view");
  check(second, "second view");
  const std::vector<DepthRatio> ratios = same_surface(first, second);
  SecondView result{second, median_size(ratios), 0};
  cv::Mat1f factor;
  cv::exp(field(ratios, second.depth.size()), factor);
  result.view.depth = Depth();  // else the product would be written over the caller's depth
  cv::multiply(second.depth, factor, result.view.depth);
  result.residual = median_size(same_surface(first, result.view));
  return result;
}

}  // namespace ps
