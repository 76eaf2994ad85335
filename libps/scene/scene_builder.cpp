// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/scene_builder.h"

#include <algorithm>
#include <vector>

#include "libps/core/clock.h"
#include "libps/core/error.h"
#include "libps/geometry/point.h"
#include "libps/scene/network_view.h"

namespace ps {
namespace {

/// A pixel is covered when a point is nearer than this to its centre: pixels that only a wide splat
/// reaches are still to be filled.
constexpr float kCoverRadius = 1.5f;

}  // namespace

struct SceneBuilder::Impl {
  SceneNetworks networks;
  SceneOptions options;
  Intrinsics lens;
  SceneCloud cloud;
  std::vector<View> observed;  ///< without their colours
  Cloud points;
  bool changed = true;
  outpaint::Outpainter outpainter;

  Impl(const SceneNetworks& n, const Intrinsics& l, const SceneOptions& o)
      : networks(n), options(o), lens(network_lens(l)), cloud(o.cloud), outpainter(n.outpaint) {
    if (networks.depth == nullptr) throw Error("scene", "the depth network is missing");
    options.splat.background = {.5f, .5f, .5f};
  }

  bool fill(SupportView& support, const Splat& seen);
  void align(SupportView& support, const Splat& seen, const Depth& cloud_depth);
};

SceneBuilder::SceneBuilder(const SceneNetworks& networks, const Intrinsics& lens,
                           const SceneOptions& options)
    : impl_(std::make_unique<Impl>(networks, lens, options)) {}
SceneBuilder::~SceneBuilder() = default;
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;

const Intrinsics& SceneBuilder::lens() const { return impl_->lens; }

const Cloud& SceneBuilder::cloud() {
  if (impl_->changed) impl_->points = impl_->cloud.cloud();
  impl_->changed = false;
  return impl_->points;
}

AddReport SceneBuilder::observe(const View& view, std::uint16_t number) {
  check(view, "view " + std::to_string(number));
  const View large = enlarged(view);
  const AddReport report = impl_->cloud.add(large, number, Origin::observed);
  impl_->changed = true;
  impl_->observed.push_back({{}, large.depth.clone(), large.intrinsics, large.world_from_cam});
  return report;
}

/// Outpaints what is missing. Returns false when it was stopped.
bool SceneBuilder::Impl::fill(SupportView& support, const Splat& seen) {
  const auto start = now();
  const outpaint::Outpainted filled =
      outpainter.run(to_network(seen.color), seen.missing, options.outpaint);
  if (filled.image.shape().pixels() == 0) return false;
  support.view.color =
      continue_colors(seen.color, from_network(filled.image), seen.missing, options.colors);
  support.report.outpaint = filled.report;
  support.report.best = filled.best;
  support.report.outpaint_seconds = seconds_since(start);
  return true;
}

/// Depth of the picture, made to continue what is seen of the cloud.
void SceneBuilder::Impl::align(SupportView& support, const Splat& seen, const Depth& cloud_depth) {
  SupportReport& report = support.report;
  auto start = now();
  const Depth guess = photo_depth(*networks.depth, support.view.color, lens, networks.depth_scale);
  report.depth_seconds = seconds_since(start);
  start = now();
  const Mask visible = seen.hit & (seen.missing == 0);
  const AlignedDepth aligned =
      align_depth(guess, cloud_depth, visible, seen.missing, options.alignment);
  support.view.depth = aligned.depth;
  report.agreed = aligned.agreed;
  report.why = aligned.why;
  report.scale = aligned.scale;
  report.exponent = aligned.exponent;
  report.residual = aligned.residual;
  report.seam_step = aligned.seam_step;
  report.seam_step_before = aligned.seam_step_before;
  report.seam_step_seen = aligned.seam_step_seen;
  report.align_seconds = seconds_since(start);
}

SupportView SceneBuilder::outpaint(const Pose& world_from_cam, std::uint16_t number) {
  Impl& impl = *impl_;
  impl.options.outpaint.view = number;
  const auto start = now();
  const Splat seen = splat(cloud(), impl.lens, world_from_cam, impl.options.splat);
  SplatOptions narrow = impl.options.splat;
  narrow.radius = kCoverRadius;
  SupportView support;
  support.view.intrinsics = impl.lens;
  support.view.world_from_cam = world_from_cam;
  SupportReport& report = support.report;
  report.missing_share = cv::mean(seen.missing)[0];
  support.pixels = Mask::zeros(seen.missing.size());
  if (report.missing_share == 0) {
    support.view.color = seen.color;
    support.view.depth = seen.expected_depth;
    return support;
  }
  const Splat near = splat(cloud(), impl.lens, world_from_cam, narrow);
  report.splat_seconds = seconds_since(start);
  if (!impl.fill(support, seen)) return {};
  // Wide splats show slanted surfaces too near.
  Depth cloud_depth = seen.expected_depth.clone();
  near.expected_depth.copyTo(cloud_depth, near.hit);
  impl.align(support, seen, cloud_depth);
  support.pixels = seen.missing & (near.hit == 0);
  support.pixels.setTo(1, support.pixels);
  report.pixels = static_cast<std::size_t>(cv::countNonZero(support.pixels));
  const Mask before =
      in_free_space(support.view, support.pixels, impl.observed, impl.options.free_space);
  support.pixels.setTo(0, before);
  report.refused = static_cast<std::size_t>(cv::countNonZero(before));
  return support;
}

AddReport SceneBuilder::add(const SupportView& support, std::uint16_t number) {
  if (cv::countNonZero(support.pixels) == 0) return {};
  impl_->changed = true;
  return impl_->cloud.add(support.view, number, Origin::outpainted, support.pixels);
}

}  // namespace ps
