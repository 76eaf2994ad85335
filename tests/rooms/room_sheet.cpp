// SPDX-License-Identifier: BSD-3-Clause
// room_sheet OUT.png [ROWS COLUMNS SIZE FIRST_SEED depth=1 effects=1]: rooms, one for each cell,
// with their depth below; prints how depth is spread.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/furniture.h"
#include "libps/rooms/camera_effects.h"
#include "libps/rooms/shot.h"

namespace rooms = ps::rooms;

namespace {

cv::Mat3b picture(const rooms::Shot& shot) {
  cv::Mat3b out(shot.height, shot.width);
  for (int i = 0; i < shot.width * shot.height; ++i) {
    for (int c = 0; c < 3; ++c) {
      out(i / shot.width, i % shot.width)[2 - c] =
          cv::saturate_cast<uchar>(shot.color[3 * i + c] * 255);
    }
  }
  return out;
}

cv::Mat3b depth_picture(const rooms::Shot& shot) {
  cv::Mat1b near(shot.height, shot.width);
  for (int i = 0; i < shot.width * shot.height; ++i) {
    const float z = shot.depth[i];
    near(i / shot.width, i % shot.width) =
        z > 0 ? cv::saturate_cast<uchar>(255 / (0.5f + 0.5f * z)) : 0;
  }
  cv::Mat3b out;
  cv::applyColorMap(near, out, cv::COLORMAP_TURBO);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  const int rows = number(2, 4), columns = number(3, 6), size = number(4, 256),
            first = number(5, 1);
  const bool depth = number(6, 1) != 0, effects = number(7, 1) != 0;
  std::vector<rooms::Model> models;
  if (argc > 8) {
    const std::string path = argv[8];
    models = ps::read_furniture(path == "-" ? ps::kDebianFurniture : path).models;
  }
  const rooms::Furniture furniture(models);
  rooms::RoomOptions room_options;
  if (!models.empty()) room_options.furniture = &furniture;
  const int tall = depth ? 2 * size : size;
  cv::Mat3b sheet(rows * tall, columns * size);
  std::vector<float> medians;
  double room_s = 0, shot_s = 0, far = 0, outside = 0, bright = 0;
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto seconds = [](auto a, auto b) { return std::chrono::duration<double>(b - a).count(); };
  for (int i = 0; i < rows * columns; ++i) {
    const auto t0 = now();
    const rooms::Room room(first + i, room_options);
    const auto t1 = now();
    rooms::CameraOptions options;
    options.width = options.height = size;
    rooms::Shot shot = rooms::shoot(room, rooms::random_camera(room, first + i, options));
    const auto t2 = now();
    room_s += seconds(t0, t1);
    shot_s += seconds(t1, t2);
    if (effects) rooms::degrade(shot, first + i);
    const cv::Rect cell(i % columns * size, i / columns * tall, size, size);
    picture(shot).copyTo(sheet(cell));
    if (depth) depth_picture(shot).copyTo(sheet(cell + cv::Point(0, size)));
    std::vector<float> z = shot.depth;
    std::nth_element(z.begin(), z.begin() + z.size() / 2, z.end());
    medians.push_back(z[z.size() / 2]);
    for (const float q : shot.depth) {
      far += q > 5 ? 1.0 / (size * size) : 0;
      outside += q == 0 ? 1.0 / (size * size) : 0;
    }
    for (const float q : shot.color) bright += q / (3.0 * size * size);
  }
  std::sort(medians.begin(), medians.end());
  const double n = rows * columns;
  std::printf(
      "room %.1f ms, shot %.1f ms; median depth %.2f %.2f %.2f (quartiles); beyond 5 m %.1f %%, "
      "outside %.1f %%, mean %.2f\n",
      1e3 * room_s / n, 1e3 * shot_s / n, medians[medians.size() / 4], medians[medians.size() / 2],
      medians[medians.size() * 3 / 4], 100 * far / n, 100 * outside / n, bright / n);
  cv::imwrite(argv[1], sheet);
  return 0;
}
