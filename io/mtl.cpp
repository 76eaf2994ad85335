// SPDX-License-Identifier: BSD-3-Clause
#include "io/mtl.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/bytes.h"
#include "io/image_bytes.h"
#include "io/text.h"

namespace ps {
namespace {

float take_share(std::string_view& line, const LineReader& lines, const char* what) {
  return static_cast<float>(std::clamp(take_finite(line, lines, what), 0.0, 1.0));
}

/// The file of a map_ line. Options, which start with '-', stand before it, and only a name
/// without options may hold blanks.
std::string file_of(std::string_view line) {
  if (line.substr(0, 1) == "-") line.remove_prefix(std::min(line.rfind(' '), line.size()));
  std::string file(trimmed(line));
  std::replace(file.begin(), file.end(), '\\', '/');
  return file;
}

/// @return 8-bit BGRA, shrunk
cv::Mat4b shrunk(const cv::Mat& stored, int most_side) {
  cv::Mat image = stored;
  const double scale = static_cast<double>(most_side) / std::max(image.cols, image.rows);
  if (scale < 1) {
    const cv::Size size(std::max(1, cvRound(image.cols * scale)),
                        std::max(1, cvRound(image.rows * scale)));
    cv::resize(image, image, size, 0, 0, cv::INTER_AREA);
  }
  if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 255.0 / 65535);
  if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGRA);
  if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2BGRA);
  return image;
}

}  // namespace

void parse_mtl(std::string_view text, const std::string& name,
               std::map<std::string, MtlMaterial>& materials) {
  LineReader lines(text, name);
  MtlMaterial* material = nullptr;
  for (std::string_view line; lines.next_content(line);) {
    const std::string_view key = next_token(line);
    if (key == "newmtl") material = &(materials[std::string(trimmed(line))] = MtlMaterial());
    if (material == nullptr) continue;
    if (key == "Kd") {
      for (float& channel : material->color) channel = take_share(line, lines, "a colour");
    } else if (key == "d") {
      material->opacity = take_share(line, lines, "an opacity");
    } else if (key == "Tr") {
      material->opacity = 1 - take_share(line, lines, "a transparency");
    } else if (key == "map_Kd") {
      material->texture = file_of(trimmed(line));
    }
  }
}

CutTexture parse_texture(std::string_view bytes, const std::string& name, int most_side) {
  return guarded(name, [&] {
    check_image_bytes(bytes, name);
    const cv::Mat stored = decode_image(bytes, cv::IMREAD_UNCHANGED, name);
    if (stored.depth() != CV_8U && stored.depth() != CV_16U) {
      throw Error(name, "its pixels are not integers", "8 or 16 bits for each channel");
    }
    const cv::Mat4b image = shrunk(stored, most_side);
    CutTexture out;
    out.texture.width = image.cols;
    out.texture.height = image.rows;
    out.texture.rgb.reserve(image.total() * 3);
    Mask opaque(image.size());
    std::transform(image.begin(), image.end(), opaque.begin(), [&](const cv::Vec4b& pixel) {
      out.texture.rgb.insert(out.texture.rgb.end(), {pixel[2], pixel[1], pixel[0]});
      return static_cast<std::uint8_t>(pixel[3] >= 128);
    });
    if (cv::countNonZero(opaque) < static_cast<int>(opaque.total())) out.opaque = opaque;
    return out;
  });
}

}  // namespace ps
