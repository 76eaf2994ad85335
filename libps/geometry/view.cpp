// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/view.h"

#include <algorithm>
#include <cmath>

#include "libps/core/error.h"

namespace ps {
namespace {

std::string size_of(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

void check(const View& view, const std::string& where) {
  check(view.intrinsics, where);
  const cv::Size size(view.intrinsics.width, view.intrinsics.height);
  if (view.color.size() != size || view.depth.size() != size) {
    throw Error(where,
                "photo " + size_of(view.color.size()) + ", depth " + size_of(view.depth.size()) +
                    ", intrinsics " + size_of(size),
                "one size");
  }
  checked_pose(view.world_from_cam.matrix(), where);
  const bool any = std::any_of(view.depth.begin(), view.depth.end(),
                               [](float d) { return d > 0 && std::isfinite(d); });
  if (!any) throw Error(where, "no pixel has a depth", "at least one positive, finite depth");
}

}  // namespace ps
