// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr double kNear = 1e-3;                ///< metres; SplatOptions::near
constexpr std::size_t kRun = 1 << 16;         ///< points that are sorted at once
constexpr double kSorted = 0.1, kSeen = 0.3;  ///< shares of a thinning that are done then
constexpr std::size_t kTogether = 512;  ///< points that are held against the views' frusta at once

struct Place {
  std::uint64_t code;
  std::uint32_t point;
};

/// Puts two zeros before each of the lowest 21 bits.
std::uint64_t spaced_out(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Sorts on all threads, in steps between which the meter can stop it.
void sort(std::vector<Place>* places, Meter* meter) {
  const auto less = [](const Place& a, const Place& b) {
    return a.code != b.code ? a.code < b.code : a.point < b.point;
  };
  const std::size_t count = places->size();
  const auto at = [&](std::size_t i) {
    return places->begin() + static_cast<std::ptrdiff_t>(std::min(i, count));
  };
  std::size_t passes = 1;
  for (std::size_t run = kRun; run < count; run *= 2) ++passes;
  if (meter) meter->stage(kSorted, passes * count);
  parallel_chunks(count, kRun, [&](std::size_t begin, std::size_t end) {
    std::sort(at(begin), at(end), less);
    if (meter) meter->add(end - begin);
  });
  for (std::size_t run = kRun; run < count; run *= 2) {
    parallel_chunks(count, 2 * run, [&](std::size_t begin, std::size_t end) {
      std::inplace_merge(at(begin), at(begin + run), at(end), less);
      if (meter) meter->add(end - begin);
    });
  }
}

/// Finite points along Morton's curve, which keeps neighbours together.
std::vector<Place> places_of(const Cloud& cloud, Meter* meter) {
  Eigen::AlignedBox3d box;
  std::vector<Place> places;
  places.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud[i].getVector3fMap().allFinite()) continue;
    box.extend(cloud[i].getVector3fMap().cast<double>());
    places.push_back({0, static_cast<std::uint32_t>(i)});
  }
  const double steps = 0x1fffff / std::max(box.sizes().maxCoeff(), 1e-30);
  parallel_chunks(places.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d step =
          (cloud[places[i].point].getVector3fMap().cast<double>() - box.min()) * steps;
      places[i].code = spaced_out(static_cast<std::uint64_t>(step.x())) |
                       spaced_out(static_cast<std::uint64_t>(step.y())) << 1 |
                       spaced_out(static_cast<std::uint64_t>(step.z())) << 2;
    }
  });
  sort(&places, meter);
  return places;
}

/// A planned view as inequalities: x, y, z in its frame are seen when z > near and the four sides
/// a . (x, y, z) are at least 0.
class Frustum {
 public:
  Frustum(const PlannedView& view, double margin)
      : cam_from_world_(view.world_from_cam.inverse()),
        pixel_per_metre_(1 / std::max(view.intrinsics.fx, view.intrinsics.fy)) {
    const Intrinsics& k = view.intrinsics;
    sides_ << k.fx, 0, k.cx + margin, -k.fx, 0, k.width - 1 + margin - k.cx, 0, k.fy, k.cy + margin,
        0, -k.fy, k.height - 1 + margin - k.cy;
  }

  /// @return metres that a pixel covers at the point, or infinity where it is not seen
  float pixel(const Eigen::Vector3f& point) const {
    const Eigen::Vector3d p = cam_from_world_ * point.cast<double>();
    if (!(p.z() > kNear) || !((sides_ * p).minCoeff() >= 0)) return kNever;
    return std::max(static_cast<float>(p.z() * pixel_per_metre_),
                    std::numeric_limits<float>::min());
  }

  /// @return what pixel() is at least, anywhere in the box
  float least_pixel(const Eigen::AlignedBox3f& box) const {
    Eigen::Matrix<double, 3, 8> corners;
    for (int i = 0; i < 8; ++i) {
      const auto corner = static_cast<Eigen::AlignedBox3f::CornerType>(i);
      corners.col(i) = cam_from_world_ * box.corner(corner).cast<double>();
    }
    const bool outside = corners.row(2).maxCoeff() <= kNear ||
                         ((sides_ * corners).rowwise().maxCoeff().array() < 0).any();
    // A little less, as the corners are rounded differently from the points between them.
    const double nearest = std::max(corners.row(2).minCoeff() - 1e-6, 0.0);
    return outside ? kNever : static_cast<float>(0.999 * nearest * pixel_per_metre_);
  }

 private:
  Pose cam_from_world_;
  double pixel_per_metre_;
  Eigen::Matrix<double, 4, 3> sides_;
};

struct Candidate {
  float least;
  const Frustum* frustum;
};

/// Sets `pixel` of samples that lie near each other.
void find_pixels(const std::vector<Frustum>& frusta, Sample* begin, Sample* end) {
  Eigen::AlignedBox3f box;
  for (const Sample* s = begin; s != end; ++s) box.extend(s->position);
  std::vector<Candidate> candidates;
  for (const Frustum& frustum : frusta) {
    const float least = frustum.least_pixel(box);
    if (least < kNever) candidates.push_back({least, &frustum});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.least < b.least; });
  for (Sample* s = begin; s != end; ++s) {
    for (const Candidate& c : candidates) {
      if (c.least >= s->pixel) break;
      s->pixel = std::min(s->pixel, c.frustum->pixel(s->position));
    }
  }
}

Sample sample_of(const Point& p, std::uint32_t number) {
  const float footprint = std::isfinite(p.footprint) ? p.footprint : 0;
  Sample sample;
  sample.position = p.getVector3fMap();
  sample.color = Eigen::Vector3f(p.r, p.g, p.b);
  sample.pixel = kNever;
  sample.area = footprint * footprint;
  sample.footprint = footprint;
  sample.point = number;
  sample.origin = p.origin;
  return sample;
}

}  // namespace

std::vector<Sample> seen_samples(const Cloud& cloud, const std::vector<PlannedView>& views,
                                 double margin, std::vector<std::uint32_t>* unseen, Meter* meter) {
  std::vector<Frustum> frusta;
  frusta.reserve(views.size());
  for (const PlannedView& view : views) frusta.emplace_back(view, margin);
  const std::vector<Place> places = places_of(cloud, meter);
  if (meter) meter->stage(kSeen, places.size());
  std::vector<Sample> samples(places.size());
  parallel_chunks(places.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      samples[i] = sample_of(cloud[places[i].point], places[i].point);
    }
    find_pixels(frusta, samples.data() + begin, samples.data() + end);
    if (meter) meter->add(end - begin);
  });
  unseen->clear();
  for (const Sample& s : samples) {
    if (s.pixel == kNever) unseen->push_back(s.point);
  }
  std::sort(unseen->begin(), unseen->end());
  samples.erase(std::remove_if(samples.begin(), samples.end(),
                               [](const Sample& s) { return s.pixel == kNever; }),
                samples.end());
  return samples;
}

}  // namespace ps
