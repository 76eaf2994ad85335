// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/photo_depth.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "libps/core/error.h"
#include "libps/geometry/depth_alignment.h"

namespace ps {
namespace {

constexpr int kSide = models::DepthNet::kMultiple;
constexpr int kMostApart = 160;  ///< from one square to the next, pixels
constexpr int kMostAspect = 100;

/// Averages where it shrinks.
template <class Pixels>
Pixels resized_to(const Pixels& image, cv::Size size) {
  if (image.size() == size) return image;
  Pixels out;
  const bool shrinks = size.area() < image.size().area();
  cv::resize(image, out, size, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
  return out;
}

/// @return where squares begin along a side of `length` pixels: evenly, from end to end
std::vector<int> square_starts(int length) {
  const int steps = (length - kSide + kMostApart - 1) / kMostApart;
  std::vector<int> starts = {0};
  for (int i = 1; i <= steps; ++i) {
    starts.push_back(static_cast<int>(std::int64_t{length - kSide} * i / steps));
  }
  return starts;
}

cv::Mat1f log_depth_of(const models::DepthNet& net, const Image& square, const DepthScale& scale,
                       nn::Workspace& workspace) {
  const nn::Workspace::Scope scope(workspace);
  const nn::TensorView image = workspace.take({1, kSide, kSide, 3});
  const nn::TensorView depth = workspace.take({1, kSide, kSide, 1});
  cv::Mat input(kSide, kSide, CV_32FC3, image.data);
  square.convertTo(input, CV_32F, 2, -1);
  net.forward(image, depth, workspace);
  const cv::Mat1f said(kSide, kSide, depth.data);
  if (!cv::checkRange(said)) {
    throw Error("depth network", "gives what is no finite number", "sound weights");
  }
  models::depth_of_raw(depth, scale.min_z, scale.max_z, depth);
  cv::Mat1f logarithm;
  cv::log(said, logarithm);
  return logarithm;
}

/// The mean of what the network says of a square and of its mirror image.
cv::Mat1f mirrored_log_depth_of(const models::DepthNet& net, const Image& square,
                                const DepthScale& scale, nn::Workspace& workspace) {
  Image mirrored;
  cv::flip(square, mirrored, 1);
  cv::Mat1f other;
  cv::flip(log_depth_of(net, mirrored, scale, workspace), other, 1);
  return (log_depth_of(net, square, scale, workspace) + other) / 2;
}

/// The median of `later` - `earlier` where they overlap, `apart` columns after the earlier began.
float median_step(const cv::Mat1f& earlier, const cv::Mat1f& later, int apart) {
  const cv::Mat1f difference = later.colRange(0, kSide - apart) - earlier.colRange(apart, kSide);
  std::vector<float> values(difference.begin(), difference.end());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Adds a constant to each square, so that it goes on from the one before; the mean of all
/// constants is 0, as no square knows the scale better than another.
void align(std::vector<cv::Mat1f>& squares, const std::vector<int>& starts) {
  std::vector<double> shifts = {0};
  for (std::size_t i = 1; i < squares.size(); ++i) {
    const int apart = starts[i] - starts[i - 1];
    shifts.push_back(shifts.back() - median_step(squares[i - 1], squares[i], apart));
  }
  const double mean =
      std::accumulate(shifts.begin(), shifts.end(), 0.0) / static_cast<double>(shifts.size());
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += shifts[i] - mean;
}

/// Their weighted mean; a column's weight falls to 0 towards the square's ends, so that none begins
/// or ends with a step.
cv::Mat1f blended(const std::vector<cv::Mat1f>& squares, const std::vector<int>& starts) {
  cv::Mat1f out = cv::Mat1f::zeros(kSide, starts.back() + kSide);
  cv::Mat1f weights = cv::Mat1f::zeros(1, out.cols);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    for (int x = 0; x < kSide; ++x) {
      const double root = std::sin(CV_PI * (x + 0.5) / kSide);
      const auto weight = static_cast<float>(root * root);
      weights(starts[i] + x) += weight;
      out.col(starts[i] + x) += weight * squares[i].col(x);
    }
  }
  for (int x = 0; x < out.cols; ++x) out.col(x) /= weights(x);
  return out;
}

}  // namespace

void check_photo(const Image& photo, const std::string& where) {
  if (photo.empty()) throw Error(where, "has no pixels", "at least one");
  const auto [shorter, longer] = std::minmax(photo.cols, photo.rows);
  if (longer / shorter > kMostAspect) {
    throw Error(where, "is " + std::to_string(photo.cols) + "x" + std::to_string(photo.rows),
                "a long side of at most " + std::to_string(kMostAspect) + " short ones");
  }
}

void check(const DepthScale& scale, const std::string& where) {
  const bool sound = scale.min_z > 0 && scale.max_z > scale.min_z && std::isfinite(scale.max_z) &&
                     scale.canonical_focal > 0 && std::isfinite(scale.canonical_focal);
  if (sound) return;
  throw Error(where, "its depth scale is unsound", "0 < min_z < max_z, canonical_focal > 0");
}

Depth photo_depth(const models::DepthNet& net, const Image& photo, const Intrinsics& lens,
                  const DepthScale& scale) {
  check_photo(photo, "photo");
  check(scale, "photo_depth");
  check(lens, "photo_depth");
  // Squares stand side by side: an upright photo's depth is made on its side.
  const bool upright = photo.rows > photo.cols;
  const int shorter = std::min(photo.cols, photo.rows), longer = std::max(photo.cols, photo.rows);
  const double shrink = static_cast<double>(kSide) / shorter;
  const int length = std::max(kSide, static_cast<int>(std::lround(longer * shrink)));
  const Image small =
      resized_to(photo, upright ? cv::Size(kSide, length) : cv::Size(length, kSide));
  const std::vector<int> starts = square_starts(length);
  std::vector<cv::Mat1f> squares;
  nn::Workspace workspace;
  for (const int start : starts) {
    const cv::Point at = upright ? cv::Point(0, start) : cv::Point(start, 0);
    squares.push_back(
        mirrored_log_depth_of(net, small(cv::Rect(at, cv::Size(kSide, kSide))), scale, workspace));
    if (upright) squares.back() = squares.back().t();
  }
  align(squares, starts);
  cv::Mat1f logarithm = blended(squares, starts);
  if (upright) logarithm = logarithm.t();
  Depth depth;
  cv::exp(resized_to(logarithm, photo.size()), depth);
  const double focal = std::sqrt(lens.fx * lens.fy) * shrink;  // pixels of a square
  return depth * (focal / (scale.canonical_focal * kSide));
}

FilledHoles fill_holes(View& view, const models::DepthNet& net, const DepthScale& scale) {
  const Mask known = view.depth > 0, unknown = ~known;
  FilledHoles filled;
  filled.pixels = cv::countNonZero(unknown);
  if (filled.pixels == 0) return filled;
  const Depth guess = photo_depth(net, view.color, view.intrinsics, scale);
  const AlignedDepth aligned = align_depth(guess, view.depth, known & 1, unknown & 1);
  view.depth = view.depth.clone();  // other views may share it
  aligned.depth.copyTo(view.depth, unknown);
  filled.agreed = aligned.agreed;
  filled.why = aligned.why;
  filled.residual = aligned.residual;
  return filled;
}

}  // namespace ps
