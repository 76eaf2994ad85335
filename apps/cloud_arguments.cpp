// SPDX-License-Identifier: BSD-3-Clause
#include "apps/cloud_arguments.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "apps/output.h"
#include "apps/program.h"
#include "io/cloud_file.h"
#include "io/intrinsics_file.h"
#include "libps/core/error.h"
#include "libps/scene/camera_path.h"

namespace ps::apps {
namespace {

constexpr int kLargestSide = 16384;
constexpr double kDefaultFov = 60;

/// The file's own size, or, for a bare 3x3 matrix, which has none, `size`.
Intrinsics read_lens(const std::string& path, cv::Size size) {
  try {
    return read_intrinsics(path);
  } catch (const Error&) {
    return read_intrinsics(path, size.width, size.height);
  }
}

}  // namespace

void CloudArguments::add_to(CLI::App& verb) {
  verb.add_option("cloud", cloud, "Point cloud: .ply or .pcd")->required()->type_name("CLOUD");
  verb.add_option("--origin", origin, "Which points: observed, outpainted or all")
      ->check(CLI::IsMember({"observed", "outpainted", "all"}))
      ->type_name("WHICH");
  verb.add_option("--size", size, "Width and height in pixels (default: the lens's, else 640x480)")
      ->type_name("WxH");
  auto* file = verb.add_option("--intrinsics", intrinsics,
                               "Lens: Open3D JSON, COLMAP cameras.txt or 3x3 text (default: "
                               "intrinsics.json beside the cloud)")
                   ->type_name("FILE");
  verb.add_option("--fov", fov, "Lens: horizontal field of view in degrees")
      ->type_name("DEG")
      ->check(in_range(1, 179))
      ->excludes(file)
      ->default_str("");
  verb.add_option("--up", up, "The world's axis that points up, for a start from outside")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}))
      ->type_name("AXIS");
}

cv::Size parse_size(const std::string& text) {
  const auto cross = text.find('x');
  const auto side = [](const std::string& digits) {
    const bool sound = !digits.empty() && digits.size() < 6 &&
                       std::all_of(digits.begin(), digits.end(),
                                   [](unsigned char c) { return std::isdigit(c) != 0; });
    return sound ? std::atoi(digits.c_str()) : 0;
  };
  const int width = cross == std::string::npos ? 0 : side(text.substr(0, cross));
  const int height = cross == std::string::npos ? 0 : side(text.substr(cross + 1));
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide) {
    throw CLI::ValidationError("--size", "'" + text + "' is no size; expected WxH up to " +
                                             std::to_string(kLargestSide) + ", as 640x480");
  }
  return {width, height};
}

Cloud load_cloud(const CloudArguments& arguments, const Context& context) {
  std::size_t dropped = 0;
  Cloud cloud = read_cloud(arguments.cloud, &dropped);
  const std::string unfinite = std::to_string(dropped) + " points are not finite";
  if (cloud.empty()) {
    throw Error(arguments.cloud, dropped > 0 ? "all its " + unfinite : "holds no points",
                "at least one");
  }
  if (dropped > 0) context.warn(arguments.cloud + ": " + unfinite + " and are left out");
  if (arguments.origin == "all") return cloud;
  const Origin wanted = arguments.origin == "observed" ? Origin::observed : Origin::outpainted;
  const auto unwanted = [&](const Point& point) {
    return point.origin != static_cast<std::uint8_t>(wanted);
  };
  auto& points = cloud.points;
  points.erase(std::remove_if(points.begin(), points.end(), unwanted), points.end());
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.height = 1;
  if (cloud.empty()) {
    throw Error(arguments.cloud, "no point's origin is " + arguments.origin, "--origin all");
  }
  return cloud;
}

std::optional<std::filesystem::path> find_beside(const std::string& cloud,
                                                 const std::string& name) {
  const std::filesystem::path path(cloud);
  for (const auto& candidate : {beside(path, name), path.parent_path() / name}) {
    if (std::filesystem::is_regular_file(candidate)) return candidate;
  }
  return std::nullopt;
}

Intrinsics choose_lens(const CloudArguments& arguments, const Context& context, cv::Size otherwise,
                       const std::optional<Eigen::Vector4d>& shares) {
  const bool sized = !arguments.size.empty();
  const cv::Size size = sized ? parse_size(arguments.size) : otherwise;
  std::string file = arguments.intrinsics;
  if (file.empty() && arguments.fov == 0 && shares) {
    const double w = size.width, h = size.height;
    const Eigen::Vector4d& s = *shares;  // of the image from corner to corner
    return {size.width, size.height, s[0] * w, s[1] * h, s[2] * w - 0.5, s[3] * h - 0.5};
  }
  if (file.empty() && arguments.fov == 0) {
    if (const auto found = find_beside(arguments.cloud, "intrinsics.json")) {
      file = found->string();
      context.detail("lens: " + file);
    }
  }
  if (!file.empty()) {
    const Intrinsics lens = read_lens(file, size);
    return sized ? with_size(lens, size.width, size.height) : lens;
  }
  if (arguments.fov == 0) {
    context.say("lens: 60 degrees across; --intrinsics or --fov says otherwise");
  }
  return intrinsics_from_fov(size.width, size.height,
                             arguments.fov != 0 ? arguments.fov : kDefaultFov);
}

}  // namespace ps::apps
