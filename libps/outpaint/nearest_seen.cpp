// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/nearest_seen.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace ps::outpaint {

cv::Mat1i nearest_seen(const cv::Mat1b& missing) {
  const cv::Mat1b holes = missing != 0;
  if (cv::countNonZero(holes) == missing.size().area()) return {};
  cv::Mat1f distance;
  cv::Mat1i labels;
  cv::distanceTransform(holes, distance, labels, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<int> seen(missing.total() + 1);  // by label: each pixel that is not missing has one
  for (int y = 0; y < missing.rows; ++y) {
    for (int x = 0; x < missing.cols; ++x) {
      if (!holes(y, x)) seen[static_cast<std::size_t>(labels(y, x))] = y * missing.cols + x;
    }
  }
  for (int& label : labels) label = seen[static_cast<std::size_t>(label)];
  return labels;
}

nn::Tensor with_nearest_colors(const nn::TensorView& image, const cv::Mat1b& missing) {
  nn::Tensor whole(image.shape);
  const cv::Mat1i nearest = nearest_seen(missing);
  for (std::size_t i = 0; i < image.shape.pixels(); ++i) {
    const auto from = nearest.empty() ? i : static_cast<std::size_t>(nearest.ptr<int>()[i]);
    std::copy_n(image.pixel(from), 3, whole.view().pixel(i));
  }
  return whole;
}

}  // namespace ps::outpaint
