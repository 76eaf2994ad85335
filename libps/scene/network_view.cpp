// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/network_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "libps/models/autoencoder.h"

namespace ps {
namespace {

constexpr int kShortSide = 256;

/// The next multiple of a cell's side; a hundredth of a pixel is rounding, and no reason for one.
int whole_cells(double length) {
  constexpr int kCell = models::Autoencoder::kCell;
  return kCell * std::max(1, static_cast<int>(std::ceil((length - 0.01) / kCell)));
}

}  // namespace

Intrinsics network_lens(const Intrinsics& lens) {
  check(lens, "camera");
  const double scale = static_cast<double>(kShortSide) / std::min(lens.width, lens.height);
  const double width = lens.width * scale, height = lens.height * scale;
  Intrinsics seen;
  seen.width = whole_cells(width);
  seen.height = whole_cells(height);
  seen.fx = lens.fx * scale;
  seen.fy = lens.fy * scale;
  seen.cx = (lens.cx + 0.5) * scale - 0.5 + (seen.width - width) / 2;
  seen.cy = (lens.cy + 0.5) * scale - 0.5 + (seen.height - height) / 2;
  return seen;
}

Image resampled(const Image& picture, const Intrinsics& seen, const Intrinsics& lens) {
  const double sx = seen.fx / lens.fx, sy = seen.fy / lens.fy;
  const cv::Matx23d seen_from_lens(sx, 0, seen.cx - lens.cx * sx,  //
                                   0, sy, seen.cy - lens.cy * sy);
  Image out;
  cv::warpAffine(picture, out, seen_from_lens, {lens.width, lens.height},
                 cv::INTER_CUBIC | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return cv::min(cv::max(out, cv::Scalar::all(0)), cv::Scalar::all(1));
}

View enlarged(const View& view) {
  const Intrinsics wanted = network_lens(view.intrinsics);
  const double scale = wanted.fx / view.intrinsics.fx;
  if (scale <= 1) return view;
  View large = view;
  const cv::Size size(static_cast<int>(std::lround(view.color.cols * scale)),
                      static_cast<int>(std::lround(view.color.rows * scale)));
  large.intrinsics = resized(view.intrinsics, size.width, size.height);
  cv::resize(view.color, large.color, size, 0, 0, cv::INTER_LINEAR);
  cv::resize(view.depth, large.depth, size, 0, 0, cv::INTER_NEAREST_EXACT);
  return large;
}

nn::Tensor to_network(const Image& image) {
  nn::Tensor tensor({1, image.rows, image.cols, 3});
  cv::Mat pixels(image.rows, image.cols, CV_32FC3, tensor.data());
  image.convertTo(pixels, CV_32F, 2, -1);
  return tensor;
}

Image from_network(const nn::TensorView& image) {
  Image out(image.shape.height, image.shape.width);
  auto* to = out.ptr<cv::Vec3f>();
  for (std::size_t i = 0; i < image.shape.pixels(); ++i, ++to) {
    for (int c = 0; c < 3; ++c) (*to)[c] = std::clamp((image.pixel(i)[c] + 1) / 2, 0.f, 1.f);
  }
  return out;
}

}  // namespace ps
