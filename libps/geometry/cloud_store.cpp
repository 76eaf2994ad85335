// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/cloud_store.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libps/core/error.h"

namespace ps {
namespace {

/// The five planes that bound what a camera sees, as inward normals in the world; all but the last
/// pass through the camera's centre.
std::array<Eigen::Vector3f, 5> inward_normals(const Intrinsics& k, const Pose& world_from_cam,
                                              double margin) {
  const double left = (-margin - k.cx) / k.fx, right = (k.width - 1 + margin - k.cx) / k.fx;
  const double top = (-margin - k.cy) / k.fy, bottom = (k.height - 1 + margin - k.cy) / k.fy;
  const std::array<Eigen::Vector3d, 5> in_cam = {
      Eigen::Vector3d(1, 0, -left), Eigen::Vector3d(-1, 0, right), Eigen::Vector3d(0, 1, -top),
      Eigen::Vector3d(0, -1, bottom), Eigen::Vector3d(0, 0, 1)};
  std::array<Eigen::Vector3f, 5> normals;
  for (int i = 0; i < 5; ++i) normals[i] = (world_from_cam.linear() * in_cam[i]).cast<float>();
  return normals;
}

}  // namespace

void CloudStore::add(const Point& point, Evidence evidence) {
  constexpr int kFootprintsAsPowerOfTwo = 5;
  int exponent;
  std::frexp(point.footprint, &exponent);
  exponent += kFootprintsAsPowerOfTwo;
  const float cells_per_metre = std::ldexp(1.0f, -exponent);
  Key key = {exponent, 0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const float place = std::floor(point.data[axis] * cells_per_metre);
    key[axis + 1] = static_cast<std::int32_t>(std::clamp(place, -2e9f, 2e9f));
  }
  if (last_cell_ == UINT32_MAX || key != last_key_) {
    const auto [place, is_new] = places_.emplace(key, static_cast<std::uint32_t>(cells_.size()));
    if (is_new) cells_.emplace_back();
    last_key_ = key;
    last_cell_ = place->second;
  }
  if (numbers_ == UINT32_MAX) throw Error("scene cloud", "more than 4294967295 points", "fewer");
  CloudCell& cell = cells_[last_cell_];
  evidence.number = numbers_++;
  cell.points.push_back(point);
  cell.evidence.push_back(evidence);
  cell.box.extend(point.getVector3fMap());
}

std::vector<std::uint32_t> CloudStore::cells_in_view(const Intrinsics& k,
                                                     const Pose& world_from_cam, double margin,
                                                     double farthest) const {
  const auto normals = inward_normals(k, world_from_cam, margin);
  const Eigen::Vector3f centre = world_from_cam.translation().cast<float>();
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Eigen::AlignedBox3f& box = cells_[i].box;
    const Eigen::Vector3f nearest = (normals.back().array() > 0).select(box.min(), box.max());
    bool in_view = normals.back().dot(nearest - centre) <= farthest;
    for (const Eigen::Vector3f& normal : normals) {
      const Eigen::Vector3f innermost = (normal.array() > 0).select(box.max(), box.min());
      in_view = in_view && normal.dot(innermost - centre) >= 0;
    }
    if (in_view) found.push_back(static_cast<std::uint32_t>(i));
  }
  return found;
}

}  // namespace ps
