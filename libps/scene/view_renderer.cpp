// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/view_renderer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/random.h"
#include "libps/geometry/point.h"
#include "libps/scene/muted_colors.h"
#include "libps/scene/network_view.h"

namespace ps {
namespace {

/// Of what nothing is projected to, for the networks: the middle of [-1,1].
const cv::Vec3f kGrey = {.5f, .5f, .5f};

std::vector<float> noise_of(const models::Refiner& refiner, std::uint64_t seed) {
  std::vector<float> noise(refiner.noise_count());
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const auto place = static_cast<std::uint32_t>(i);
    noise[i] = static_cast<float>(random_normal(seed, {place, 0x76696577u, 0, 0})[0]);
  }
  return noise;
}

cv::Mat blurred(const cv::Mat& image, double sigma) {
  cv::Mat out;
  cv::GaussianBlur(image, out, {}, sigma, sigma, cv::BORDER_REFLECT);
  return out;
}

/// The cloud where it is shown; elsewhere `base`, which near the seam is moved towards the colours
/// there.
Image completed(const Splat& shown, const Image& base, double sigma) {
  cv::Mat1f seen;
  shown.hit.convertTo(seen, CV_32F);
  Image difference = shown.color - base;
  difference.setTo(cv::Scalar::all(0), shown.hit == 0);
  const cv::Mat1f share = blurred(seen, sigma);
  const Image moved = blurred(difference, sigma);
  Image out = shown.color.clone();
  for (int y = 0; y < out.rows; ++y) {
    for (int x = 0; x < out.cols; ++x) {
      if (shown.hit(y, x)) continue;
      // At the seam the share is one half: all of the mean difference there.
      const float weight = std::min(1.f, 2 * share(y, x)) / std::max(share(y, x), 1e-4f);
      for (int c = 0; c < 3; ++c) {
        out(y, x)[c] = std::clamp(base(y, x)[c] + weight * moved(y, x)[c], 0.f, 1.f);
      }
    }
  }
  return out;
}

}  // namespace

ViewRenderer::ViewRenderer(const models::Refiner* refiner, const ViewRendererOptions& options)
    : refiner_(refiner), options_(options) {
  if (refiner_ == nullptr) return;
  noise_ = noise_of(*refiner_, options_.seed);
  options_.splat.background = kGrey;
}

Image ViewRenderer::refined(const Splat& seen) {
  const nn::Workspace::Scope scope(workspace_);
  const nn::TensorView input = workspace_.take({1, seen.color.rows, seen.color.cols, 4});
  const nn::TensorView output = workspace_.take({1, seen.color.rows, seen.color.cols, 3});
  for (std::size_t i = 0; i < input.shape.pixels(); ++i) {
    const cv::Vec3f& color = seen.color.ptr<cv::Vec3f>()[i];
    for (int c = 0; c < 3; ++c) input.pixel(i)[c] = color[c] * 2 - 1;
    input.pixel(i)[3] = seen.missing.data[i] != 0 ? 0.f : 1.f;
  }
  refiner_->forward(input, noise_.data(), output, workspace_);
  const Image image = from_network(output);
  if (!cv::checkRange(image)) {
    throw Error("refiner", "gives what is no finite number", "sound weights");
  }
  return image;
}

RenderedView cloud_picture(const pcl::PointCloud<Point>& cloud, const Intrinsics& lens,
                           const Pose& world_from_cam, const ViewRendererOptions& options) {
  SplatOptions whole = options.splat;
  whole.renormalise = true;
  RenderedView view;
  view.splat = closed_splat(cloud, lens, world_from_cam, whole, options.finest);
  view.color = view.splat.color;
  view.missing_share = cv::mean(view.splat.hit == 0)[0] / 255;
  return view;
}

RenderedView ViewRenderer::render(const pcl::PointCloud<Point>& cloud, const Intrinsics& lens,
                                  const Pose& world_from_cam) {
  RenderedView view = cloud_picture(cloud, lens, world_from_cam, options_);
  if (refiner_ == nullptr || (view.missing_share == 0 && !options_.as_published)) return view;
  const Intrinsics seen = network_lens(lens);
  const Splat coarse = splat(cloud, seen, world_from_cam, options_.splat);
  Image base = resampled(refined(coarse), seen, lens);
  if (!options_.as_published) base = muted(base, color_limit(cloud));
  constexpr double kSeam = 4;  // of the networks' pixels
  view.color =
      options_.as_published ? base : completed(view.splat, base, kSeam * lens.fx / seen.fx);
  return view;
}

}  // namespace ps
