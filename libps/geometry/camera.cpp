// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/camera.h"

#include <Eigen/SVD>
#include <cmath>

#include "libps/core/error.h"

namespace ps {

void check(const Intrinsics& k, const std::string& where) {
  if (k.width <= 0 || k.height <= 0) {
    throw Error(where, "image size " + std::to_string(k.width) + "x" + std::to_string(k.height),
                "a positive width and height");
  }
  for (const double value : {k.fx, k.fy, k.cx, k.cy}) {
    if (!std::isfinite(value)) throw Error(where, "an intrinsic is not finite", "finite numbers");
  }
  if (k.fx <= 0 || k.fy <= 0) {
    throw Error(where, "focal length " + std::to_string(k.fx) + ", " + std::to_string(k.fy),
                "positive focal lengths in pixels");
  }
}

Pose checked_pose(const Eigen::Matrix4d& world_from_cam, const std::string& where) {
  if (!world_from_cam.allFinite()) throw Error(where, "a pose is not finite", "finite numbers");
  if ((world_from_cam.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-6) {
    throw Error(where, "a pose's last row is not 0 0 0 1", "a rigid camera-to-world transform");
  }
  const Eigen::Matrix3d linear = world_from_cam.topLeftCorner<3, 3>();
  const double error =
      (linear * linear.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 1e-3 || linear.determinant() < 0) {
    throw Error(where, "a pose's 3x3 part is not a rotation",
                "orthonormal rows and determinant +1 (no scale, no mirror)");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Pose pose = Pose::Identity();
  pose.linear() = svd.matrixU() * svd.matrixV().transpose();
  pose.translation() = world_from_cam.topRightCorner<3, 1>();
  return pose;
}

Intrinsics resized(const Intrinsics& k, int width, int height) {
  const double sx = static_cast<double>(width) / k.width;
  const double sy = static_cast<double>(height) / k.height;
  return {width, height, k.fx * sx, k.fy * sy, (k.cx + 0.5) * sx - 0.5, (k.cy + 0.5) * sy - 0.5};
}

Intrinsics intrinsics_from_fov(int width, int height, double horizontal_fov_deg) {
  if (!(horizontal_fov_deg > 0 && horizontal_fov_deg < 180)) {
    throw Error("field of view", std::to_string(horizontal_fov_deg) + " degrees",
                "more than 0 and less than 180");
  }
  const double half = horizontal_fov_deg * M_PI / 360;
  const double f = width / (2 * std::tan(half));
  const Intrinsics k{width, height, f, f, (width - 1) / 2.0, (height - 1) / 2.0};
  check(k, "field of view");
  return k;
}

Intrinsics intrinsics_from_focal_35mm(int width, int height, double focal_mm_35) {
  const double f = focal_mm_35 * std::hypot(width, height) / std::hypot(36.0, 24.0);
  const Intrinsics k{width, height, f, f, (width - 1) / 2.0, (height - 1) / 2.0};
  check(k, "35 mm focal length");
  return k;
}

}  // namespace ps
