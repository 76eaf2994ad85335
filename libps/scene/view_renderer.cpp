// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/view_renderer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "libps/core/error.h"
#include "libps/core/random.h"
#include "libps/geometry/point.h"
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

/// The cloud's own picture where it is seen, its coarse part replaced by that of `base`; `base`
/// elsewhere, and a mixture where the cloud is seen in spots.
Image with_detail(const Image& base, const Splat& fine, double sigma) {
  cv::Mat1f seen;
  fine.hit.convertTo(seen, CV_32F);
  const cv::Mat1f share = blurred(seen, sigma);
  Image difference = base - fine.color;
  difference.setTo(cv::Scalar::all(0), fine.hit == 0);
  const Image coarse = blurred(difference, sigma);
  Image out = base.clone();
  for (int y = 0; y < out.rows; ++y) {
    for (int x = 0; x < out.cols; ++x) {
      if (!fine.hit(y, x)) continue;
      const float weight = std::clamp(2 * share(y, x) - 1, 0.f, 1.f);
      const cv::Vec3f detailed = fine.color(y, x) + coarse(y, x) / share(y, x);
      for (int c = 0; c < 3; ++c) {
        const float mixed = weight * detailed[c] + (1 - weight) * base(y, x)[c];
        out(y, x)[c] = std::clamp(mixed, 0.f, 1.f);
      }
    }
  }
  return out;
}

}  // namespace

ViewRenderer::ViewRenderer(const models::Refiner* refiner, const ViewRendererOptions& options)
    : refiner_(refiner), options_(options) {
  if (refiner_ != nullptr) noise_ = noise_of(*refiner_, options_.seed);
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

RenderedView ViewRenderer::render(const pcl::PointCloud<Point>& cloud, const Intrinsics& lens,
                                  const Pose& world_from_cam) {
  SplatOptions fine = options_.splat;
  fine.renormalise = true;
  if (refiner_ == nullptr) {
    fine.background = {0, 0, 0};
    RenderedView view;
    view.splat = splat(cloud, lens, world_from_cam, fine);
    view.color = view.splat.color;
    view.missing_share = cv::mean(view.splat.hit == 0)[0] / 255;
    return view;
  }
  const Intrinsics seen = network_lens(lens);
  const Splat coarse = splat(cloud, seen, world_from_cam, options_.splat);
  const Image base = resampled(refined(coarse), seen, lens);
  RenderedView view;
  view.missing_share = cv::mean(coarse.missing)[0];
  fine.radius = options_.detail_radius;
  view.splat = splat(cloud, lens, world_from_cam, fine);
  const double sigma = options_.detail_from * lens.fx / seen.fx;
  view.color = sigma > 0 ? with_detail(base, view.splat, sigma) : base;
  return view;
}

}  // namespace ps
