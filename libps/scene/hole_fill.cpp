// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/hole_fill.h"

#include <opencv2/photo.hpp>

#include "libps/core/error.h"
#include "libps/outpaint/nearest_seen.h"

namespace ps {
namespace {

/// @param holes  255 where there is one, else 0; here and below
Image nearest_colours(const Image& picture, const Mask& holes) {
  const cv::Mat1i nearest = outpaint::nearest_seen(holes);
  Image out(picture.size());
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const int from = nearest(y, x);
      out(y, x) = picture(from / picture.cols, from % picture.cols);
    }
  }
  return out;
}

Image inpainted(const Image& picture, const Mask& holes, int method) {
  constexpr double kRadius = 3;
  cv::Mat3b bytes, filled;
  picture.convertTo(bytes, CV_8U, 255);
  cv::inpaint(bytes, holes, filled, kRadius, method);
  Image out;
  filled.convertTo(out, CV_32F, 1.0 / 255);
  return out;
}

Image base_of(const Image& picture, const Mask& seen, HoleFill fill) {
  if (cv::countNonZero(seen) == 0) return Image(picture.size(), cv::Vec3f(.5f, .5f, .5f));
  const Mask holes = seen == 0;
  switch (fill) {
    case HoleFill::nearest:
      return nearest_colours(picture, holes);
    case HoleFill::telea:
      return inpainted(picture, holes, cv::INPAINT_TELEA);
    case HoleFill::navier_stokes:
      return inpainted(picture, holes, cv::INPAINT_NS);
    case HoleFill::mean_colour:
      break;
  }
  const cv::Scalar mean = cv::mean(picture, seen);
  return Image(picture.size(), cv::Vec3f(static_cast<float>(mean[0]), static_cast<float>(mean[1]),
                                         static_cast<float>(mean[2])));
}

}  // namespace

Image filled(const Image& picture, const Mask& seen, HoleFill fill) {
  if (picture.size() != seen.size()) {
    throw Error("fill", "a picture and a mask of two sizes", "one size");
  }
  Image out = base_of(picture, seen, fill);
  picture.copyTo(out, seen);
  return out;
}

}  // namespace ps
