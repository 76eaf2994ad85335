// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/cloud_store.h"

#include <array>

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

void CloudStore::add(const Point& point, const Evidence& evidence) {
  if (points_.size() % kChunk == 0) boxes_.emplace_back();
  points_.push_back(point);
  evidence_.push_back(evidence);
  boxes_.back().extend(point.getVector3fMap());
}

void CloudStore::moved(std::size_t i) { boxes_[i / kChunk].extend(points_[i].getVector3fMap()); }

void CloudStore::compact() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!alive(i)) continue;
    points_[kept] = points_[i];
    evidence_[kept++] = evidence_[i];
  }
  points_.resize(kept);
  evidence_.resize(kept);
  boxes_.assign((kept + kChunk - 1) / kChunk, Box());
  for (std::size_t i = 0; i < kept; ++i) moved(i);
}

std::vector<std::uint32_t> CloudStore::chunks_in_view(const Intrinsics& k,
                                                      const Pose& world_from_cam, double margin,
                                                      double farthest) const {
  const auto normals = inward_normals(k, world_from_cam, margin);
  const Eigen::Vector3f centre = world_from_cam.translation().cast<float>();
  std::vector<std::uint32_t> chunks;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Eigen::Vector3f nearest =
        (normals.back().array() > 0).select(boxes_[i].min(), boxes_[i].max());
    bool in_view = normals.back().dot(nearest - centre) <= farthest;
    for (const Eigen::Vector3f& normal : normals) {
      const Eigen::Vector3f innermost =
          (normal.array() > 0).select(boxes_[i].max(), boxes_[i].min());
      in_view = in_view && normal.dot(innermost - centre) >= 0;
    }
    if (in_view) chunks.push_back(static_cast<std::uint32_t>(i));
  }
  return chunks;
}

}  // namespace ps
