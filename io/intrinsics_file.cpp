// SPDX-License-Identifier: BSD-3-Clause
#include "io/intrinsics_file.h"

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/image_bytes.h"
#include "io/json.h"
#include "io/text.h"

namespace ps {
namespace {

using Json = nlohmann::json;

/// A camera from [fx skew cx; 0 fy cy; 0 0 1], row by row.
Intrinsics from_matrix(const std::array<double, 9>& m, const std::string& where) {
  if (m[1] != 0 || m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1) {
    throw Error(where, "the 3x3 matrix is no pinhole camera's",
                "fx 0 cx, 0 fy cy, 0 0 1 (in Open3D's JSON column by column)");
  }
  return {0, 0, m[0], m[4], m[2], m[5]};
}

/// A size in pixels; up to 2^24, beyond which no image is.
int to_size(double value, const std::string& where) {
  if (value >= 1 && value <= 1 << 24 && value == static_cast<int>(value)) {
    return static_cast<int>(value);
  }
  throw Error(where, "an image's side is " + std::to_string(value), "a positive whole number");
}

Intrinsics parse_json(std::string_view bytes, const std::string& name) {
  Json json = parse_json_text(bytes, name);
  if (json.is_object() && json.contains("intrinsic")) json = Json(json["intrinsic"]);
  const bool sound = json.is_object() && json.contains("intrinsic_matrix") &&
                     json["intrinsic_matrix"].is_array() && json["intrinsic_matrix"].size() == 9;
  if (!sound) throw Error(name, "has no intrinsic_matrix of 9 numbers", "Open3D's pinhole JSON");
  const auto number = [&](const Json& value) {
    if (!value.is_number()) throw Error(name, in_quotes(value.dump()), "a number");
    return value.get<double>();
  };
  std::array<double, 9> rows{};
  for (std::size_t i = 0; i < 9; ++i) rows[i % 3 * 3 + i / 3] = number(json["intrinsic_matrix"][i]);
  Intrinsics camera = from_matrix(rows, name);
  if (json.contains("width")) camera.width = to_size(number(json["width"]), name);
  if (json.contains("height")) camera.height = to_size(number(json["height"]), name);
  return camera;
}

/// COLMAP's models that are pinholes when the parameters after the first ones are 0.
struct ColmapModel {
  std::size_t focals;
  std::size_t parameters;
};
const std::map<std::string_view, ColmapModel> kColmapModels{
    {"SIMPLE_PINHOLE", {1, 3}}, {"PINHOLE", {2, 4}}, {"SIMPLE_RADIAL", {1, 4}},
    {"RADIAL", {1, 5}},         {"OPENCV", {2, 8}},  {"FULL_OPENCV", {2, 12}},
};

/// @param line  `CAMERA_ID MODEL WIDTH HEIGHT PARAMETERS...`
Intrinsics parse_colmap(std::string_view line, LineReader& lines) {
  next_token(line);
  const std::string_view name = next_token(line);
  const auto model = kColmapModels.find(name);
  if (model == kColmapModels.end()) {
    throw Error(lines.where(), "camera model " + in_quotes(name),
                "PINHOLE, SIMPLE_PINHOLE, or a radial model without distortion");
  }
  const int width = to_size(take_finite(line, lines, "width"), lines.where());
  const int height = to_size(take_finite(line, lines, "height"), lines.where());
  std::vector<double> p;
  for (std::size_t i = 0; i < model->second.parameters; ++i) {
    p.push_back(take_finite(line, lines, "a camera parameter"));
  }
  if (!next_token(line).empty()) {
    throw Error(lines.where(), "too many parameters",
                std::to_string(p.size()) + " for " + std::string(name));
  }
  const std::size_t f = model->second.focals;
  for (std::size_t i = f + 2; i < p.size(); ++i) {
    if (p[i] != 0)
      throw Error(lines.where(), "the lens distorts",
                  "undistorted photos (COLMAP's image_undistorter)");
  }
  std::string_view another;
  if (lines.next_content(another)) throw Error(lines.where(), "a second camera", "one camera");
  return {width, height, p[0], p[f - 1], p[f] - 0.5, p[f + 1] - 0.5};
}

Intrinsics parse_matrix(LineReader& lines, std::string_view line) {
  std::array<double, 9> m{};
  for (double& value : m) {
    while (count_tokens(line) == 0) {
      if (!lines.next_content(line)) {
        throw Error(lines.where(), "the text ends too early",
                    "9 numbers of a 3x3 matrix, Open3D's JSON or COLMAP's cameras.txt");
      }
    }
    value = take_finite(line, lines, "a 3x3 matrix (else Open3D's JSON or COLMAP's cameras.txt)");
  }
  if (count_tokens(line) > 0 || lines.next_content(line)) {
    throw Error(lines.where(), "more than 9 numbers", "a 3x3 matrix");
  }
  return from_matrix(m, lines.where());
}

/// Tells the two kinds of text apart: COLMAP's has a model's name in its second column.
Intrinsics parse_text(std::string_view bytes, const std::string& name) {
  LineReader lines(bytes, name);
  std::string_view line;
  if (!lines.next_content(line)) throw Error(name, "holds no camera", "a 3x3 matrix");
  std::string_view words = line;
  next_token(words);
  const std::string_view second = next_token(words);
  const bool model = !second.empty() && second.front() >= 'A' && second.front() <= 'Z';
  return model ? parse_colmap(line, lines) : parse_matrix(lines, line);
}

/// Makes the camera one of photos of width x height.
Intrinsics fitted(Intrinsics camera, int width, int height, const std::string& name) {
  if (camera.width == 0) camera.width = width;
  if (camera.height == 0) camera.height = height;
  if (camera.width == 0 || camera.height == 0) {
    throw Error(name, "does not say the image's width and height", "a file that does, or a photo");
  }
  check(camera, name);
  if (width == 0 || height == 0) return camera;
  if (!same_aspect({camera.width, camera.height}, {width, height})) {
    throw Error(name,
                "is for " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                    " pixels, the photo has " + std::to_string(width) + "x" +
                    std::to_string(height),
                "the same aspect");
  }
  camera = resized(camera, width, height);
  check(camera, name);
  return camera;
}

}  // namespace

Intrinsics parse_intrinsics(std::string_view bytes, const std::string& name, int width,
                            int height) {
  return guarded(name, [&] {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    const bool json = first != std::string_view::npos && bytes[first] == '{';
    const Intrinsics camera = json ? parse_json(bytes, name) : parse_text(bytes, name);
    return fitted(camera, width, height, name);
  });
}

Intrinsics read_intrinsics(const std::filesystem::path& path, int width, int height) {
  return guarded(path.string(), [&] {
    return parse_intrinsics(FileBytes(path).view(), path.string(), width, height);
  });
}

void write_intrinsics(const std::filesystem::path& path, const Intrinsics& k) {
  guarded(path.string(), [&] {
    check(k, path.string());
    const auto joined = [](std::initializer_list<double> numbers, const char* between) {
      std::string text;
      for (const double number : numbers) {
        if (!text.empty()) text += between;
        append_number(text, number);
      }
      return text;
    };
    std::string text;
    if (extension_of(path) == ".json") {
      text = "{\"width\": " + std::to_string(k.width) +
             ", \"height\": " + std::to_string(k.height) + ", \"intrinsic_matrix\": [" +
             joined({k.fx, 0, 0, 0, k.fy, 0, k.cx, k.cy, 1}, ", ") + "]}\n";
    } else if (path.filename() == "cameras.txt") {
      text = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n1 PINHOLE " + std::to_string(k.width) + " " +
             std::to_string(k.height) + " " + joined({k.fx, k.fy, k.cx + 0.5, k.cy + 0.5}, " ") +
             "\n";
    } else {
      text = joined({k.fx, 0, k.cx}, " ") + "\n" + joined({0, k.fy, k.cy}, " ") + "\n0 0 1\n";
    }
    AtomicFile file(path);
    file.write(text);
    file.commit();
  });
}

}  // namespace ps
