// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/text.h"
#include "libps/core/error.h"

namespace ps {
namespace {

/// What can be told of a file before its poses are read.
TrajectoryFormat format_of(std::string_view bytes, const std::string& name) {
  const std::filesystem::path path(name);
  if (extension_of(path) == ".log") return TrajectoryFormat::open3d_log;
  if (path.filename() == "images.txt") return TrajectoryFormat::colmap_images;
  LineReader lines(bytes, name);
  std::string_view line;
  if (!lines.next_content(line)) throw Error(name, "holds no pose", "one at least");
  if (line.substr(0, 4) == "http") return TrajectoryFormat::realestate10k;
  switch (count_tokens(line)) {
    case 3:
      return TrajectoryFormat::open3d_log;
    case 8:
      return TrajectoryFormat::tum;
    case 10:
      return TrajectoryFormat::colmap_images;
    case 19:
      return TrajectoryFormat::realestate10k;
    default:
      throw Error(lines.where(), std::to_string(count_tokens(line)) + " columns",
                  "8 (TUM), 10 (COLMAP images.txt), 3 (Open3D .log) or 19 (RealEstate10K)");
  }
}

void expect_end(std::string_view line, const LineReader& lines, const char* columns) {
  if (!next_token(line).empty()) throw Error(lines.where(), "the line is too long", columns);
}

/// A rotation from a quaternion that may be rounded, not from any four numbers.
Eigen::Matrix3d rotation(double w, double x, double y, double z, const LineReader& lines) {
  const Eigen::Quaterniond q(w, x, y, z);
  if (!(std::abs(q.norm() - 1) < 0.1)) {
    throw Error(lines.where(), "a quaternion of length " + std::to_string(q.norm()), "length 1");
  }
  return q.normalized().toRotationMatrix();
}

Eigen::Vector3d take_vector(std::string_view& line, const LineReader& lines, const char* what) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = take_finite(line, lines, what);
  return v;
}

StampedPose parse_tum_line(std::string_view line, const LineReader& lines) {
  StampedPose pose;
  pose.timestamp = take_finite(line, lines, "a timestamp");
  pose.world_from_cam.translation() = take_vector(line, lines, "a position");
  std::array<double, 4> q{};
  for (double& value : q) value = take_finite(line, lines, "a quaternion");
  pose.world_from_cam.linear() = rotation(q[3], q[0], q[1], q[2], lines);
  expect_end(line, lines, "8 columns: stamp tx ty tz qx qy qz qw");
  return pose;
}

StampedPose parse_colmap_line(std::string_view line, const LineReader& lines) {
  StampedPose pose;
  pose.timestamp = take_finite(line, lines, "an image id");
  std::array<double, 4> q{};
  for (double& value : q) value = take_finite(line, lines, "a quaternion");
  Pose cam_from_world = Pose::Identity();
  cam_from_world.translation() = take_vector(line, lines, "a translation");
  cam_from_world.linear() = rotation(q[0], q[1], q[2], q[3], lines);
  pose.world_from_cam = cam_from_world.inverse();
  take_finite(line, lines, "a camera id");
  const std::size_t name = line.find_first_not_of(" \t");
  if (name == std::string_view::npos) throw Error(lines.where(), "no image name", "10 columns");
  pose.name = std::string(line.substr(name));
  while (pose.name.back() == ' ' || pose.name.back() == '\t') pose.name.pop_back();
  return pose;
}

/// Poses as they are read: each timestamp once.
class PoseList {
 public:
  /// @param where  the line that the pose begins in
  void add(const StampedPose& pose, const std::string& where) {
    if (!seen_.insert(pose.timestamp).second) {
      std::string stamp;
      append_number(stamp, pose.timestamp);
      throw Error(where, "timestamp " + stamp + " is there already", "each timestamp once");
    }
    poses_.push_back(pose);
  }
  std::vector<StampedPose> take(const std::string& name) {
    if (poses_.empty()) throw Error(name, "holds no pose", "one at least");
    return std::move(poses_);
  }

 private:
  std::vector<StampedPose> poses_;
  std::set<double> seen_;
};

/// COLMAP's second line of an image: `X Y POINT3D_ID` any number of times, also none.
bool is_points_line(std::string_view line) {
  std::size_t count = 0;
  for (std::string_view token = next_token(line); !token.empty(); token = next_token(line)) {
    if (!to_number<double>(token)) return false;
    ++count;
  }
  return count % 3 == 0;
}

void parse_colmap(LineReader& lines, PoseList& poses) {
  std::string_view line;
  bool have = lines.next_content(line);
  while (have) {
    poses.add(parse_colmap_line(line, lines), lines.where());
    have = lines.next(line);
    // Some tools leave the lines of points out; then this one is the next image's.
    const std::size_t words = have ? count_tokens(line) : 0;
    if (have && (words == 0 || line.front() == '#' || is_points_line(line))) {
      have = lines.next_content(line);
    }
  }
}

/// @return rows of a 4x4 matrix, or of its upper three
Eigen::Matrix4d take_rows(std::string_view& line, LineReader& lines, int rows, bool line_each) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  for (int r = 0; r < rows; ++r) {
    if (line_each && !lines.next_content(line)) {
      throw Error(lines.where(), "the last pose is incomplete", "4 rows of 4 numbers");
    }
    for (int c = 0; c < 4; ++c) m(r, c) = take_finite(line, lines, "a 4x4 matrix");
    if (line_each) expect_end(line, lines, "4 numbers in a row");
  }
  return m;
}

StampedPose parse_log_pose(std::string_view line, LineReader& lines) {
  StampedPose pose;
  pose.timestamp = take_vector(line, lines, "three frame numbers")[0];
  expect_end(line, lines, "three frame numbers");
  const Eigen::Matrix4d m = take_rows(line, lines, 4, true);
  pose.world_from_cam = checked_pose(m, lines.where());
  return pose;
}

StampedPose parse_realestate_line(std::string_view line, LineReader& lines) {
  StampedPose pose;
  pose.timestamp = take_finite(line, lines, "a timestamp");
  Eigen::Vector4d k;
  for (double& value : k) value = take_finite(line, lines, "normalised intrinsics");
  if (k[0] <= 0 || k[1] <= 0) throw Error(lines.where(), "focal lengths not positive", "positive");
  pose.normalised_intrinsics = k;
  take_finite(line, lines, "distortion");
  take_finite(line, lines, "distortion");
  const Eigen::Matrix4d m = take_rows(line, lines, 3, false);
  expect_end(line, lines, "19 columns");
  pose.world_from_cam = checked_pose(m, lines.where()).inverse();
  return pose;
}

void parse_poses(TrajectoryFormat format, LineReader& lines, PoseList& poses) {
  if (format == TrajectoryFormat::colmap_images) return parse_colmap(lines, poses);
  std::string_view line;
  while (lines.next_content(line)) {
    const std::string where = lines.where();  // a pose of Open3D's goes on for four lines
    if (format == TrajectoryFormat::tum) poses.add(parse_tum_line(line, lines), where);
    if (format == TrajectoryFormat::open3d_log) poses.add(parse_log_pose(line, lines), where);
    if (format == TrajectoryFormat::realestate10k && line.substr(0, 4) != "http") {
      poses.add(parse_realestate_line(line, lines), where);
    }
  }
}

// --- writing ------------------------------------------------------------------------------------

template <class Numbers>
void append_all(std::string& text, const Numbers& numbers) {
  for (const double number : numbers) {
    if (!text.empty() && text.back() != '\n') text += ' ';
    append_number(text, number);
  }
}

void append_tum(std::string& text, const StampedPose& pose) {
  const Eigen::Quaterniond q(pose.world_from_cam.linear());
  const Eigen::Vector3d t = pose.world_from_cam.translation();
  append_all(text, std::array{pose.timestamp, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

void append_colmap(std::string& text, const StampedPose& pose, double id) {
  const Pose cam_from_world = pose.world_from_cam.inverse();
  const Eigen::Quaterniond q(cam_from_world.linear());
  const Eigen::Vector3d t = cam_from_world.translation();
  append_all(text, std::array{id, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), 1.0});
  char name[32];
  std::snprintf(name, sizeof name, "%05.0f.png", id);
  text += " " + (pose.name.empty() ? std::string(name) : one_line(pose.name)) + "\n";
}

void append_log(std::string& text, const StampedPose& pose, double frame, std::size_t index) {
  append_all(text, std::array{frame, frame, static_cast<double>(index + 1)});
  for (int r = 0; r < 4; ++r) {
    text += '\n';
    append_all(text, Eigen::RowVector4d(pose.world_from_cam.matrix().row(r)));
  }
}

void append_realestate(std::string& text, const StampedPose& pose, const std::string& where) {
  if (!pose.normalised_intrinsics) {
    throw Error(where, "RealEstate10K needs intrinsics with each pose", "normalised intrinsics");
  }
  const Eigen::Vector4d& k = *pose.normalised_intrinsics;
  append_all(text, std::array{pose.timestamp, k[0], k[1], k[2], k[3], 0.0, 0.0});
  const Pose cam_from_world = pose.world_from_cam.inverse();
  for (int r = 0; r < 3; ++r) append_all(text, Eigen::RowVector4d(cam_from_world.matrix().row(r)));
}

bool differ(const std::vector<StampedPose>& poses) {
  std::set<double> seen;
  return std::all_of(poses.begin(), poses.end(),
                     [&](const StampedPose& pose) { return seen.insert(pose.timestamp).second; });
}

/// Whether timestamps can be frame numbers: whole, not below `least`, each once.
bool are_numbers(const std::vector<StampedPose>& poses, double least) {
  return differ(poses) && std::all_of(poses.begin(), poses.end(), [&](const StampedPose& pose) {
           const double number = pose.timestamp;
           return number >= least && number < 1e9 && number == std::floor(number);
         });
}

/// Throws ps::Error unless reading the file would give these poses back.
void check_writable(const std::vector<StampedPose>& poses, TrajectoryFormat format,
                    const std::string& where) {
  for (const StampedPose& pose : poses) {
    if (!std::isfinite(pose.timestamp)) throw Error(where, "a timestamp is not finite", "a number");
    checked_pose(pose.world_from_cam.matrix(), where);
  }
  const bool stamped = format == TrajectoryFormat::tum || format == TrajectoryFormat::realestate10k;
  if (stamped && !differ(poses)) {
    throw Error(where, "two poses have one timestamp", "each timestamp once");
  }
}

std::string to_text(const std::vector<StampedPose>& poses, TrajectoryFormat format,
                    const std::string& where) {
  check_writable(poses, format, where);
  std::string text;
  if (format == TrajectoryFormat::tum) text = "# timestamp tx ty tz qx qy qz qw, camera-to-world\n";
  if (format == TrajectoryFormat::realestate10k) text = "https://pixelsynth.invalid/trajectory\n";
  if (format == TrajectoryFormat::colmap_images) {
    text = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, world-to-camera; then POINTS2D[]\n";
  }
  const int least = format == TrajectoryFormat::colmap_images ? 1 : 0;
  const bool numbered = are_numbers(poses, least);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const StampedPose& pose = poses[i];
    if (format == TrajectoryFormat::tum) append_tum(text, pose);
    const double number = numbered ? pose.timestamp : static_cast<double>(i) + least;
    if (format == TrajectoryFormat::colmap_images) append_colmap(text, pose, number);
    if (format == TrajectoryFormat::open3d_log) append_log(text, pose, number, i);
    if (format == TrajectoryFormat::realestate10k) append_realestate(text, pose, where);
    text += '\n';
  }
  return text;
}

}  // namespace

std::vector<StampedPose> parse_trajectory(std::string_view bytes, const std::string& name) {
  return guarded(name, [&] {
    LineReader lines(bytes, name);
    PoseList poses;
    parse_poses(format_of(bytes, name), lines, poses);
    return poses.take(name);
  });
}

std::vector<StampedPose> read_trajectory(const std::filesystem::path& path) {
  return guarded(path.string(),
                 [&] { return parse_trajectory(FileBytes(path).view(), path.string()); });
}

void write_trajectory(const std::filesystem::path& path, const std::vector<StampedPose>& poses,
                      TrajectoryFormat format) {
  guarded(path.string(), [&] {
    const std::string text = to_text(poses, format, path.string());
    AtomicFile file(path);
    file.write(text);
    file.commit();
  });
}

}  // namespace ps
