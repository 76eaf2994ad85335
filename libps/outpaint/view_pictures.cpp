// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/view_pictures.h"

#include <algorithm>

#include "libps/core/random.h"

namespace ps::outpaint {
namespace {

constexpr int kCell = models::Autoencoder::kCell;
constexpr int kDecoderReach = 4 * kCell;  ///< pixels of the image that a code can reach
constexpr int kRefinerReach =
    48;  ///< and that a pixel of the refiner's input can (41), in whole cells
constexpr std::uint32_t kNoise = 1;  ///< purpose of a random number, in its counter

cv::Rect grown(const cv::Rect& rect, int by, const cv::Size& size) {
  const cv::Rect all(0, 0, size.width, size.height);
  return cv::Rect(rect.x - by, rect.y - by, rect.width + 2 * by, rect.height + 2 * by) & all;
}

/// The smallest rectangle of whole cells around the background; empty without any.
cv::Rect cells_around(const cv::Mat1b& background) {
  cv::Rect rect;
  for (int y = 0; y < background.rows; y += kCell) {
    for (int x = 0; x < background.cols; x += kCell) {
      const cv::Rect cell(x, y, kCell, kCell);
      if (cv::countNonZero(background(cell)) > 0) rect = rect.empty() ? cell : rect | cell;
    }
  }
  return rect;
}

/// Copies channels of a rectangle from one place to another of the same kind.
void copy(const nn::TensorView& from, cv::Point from_at, const nn::TensorView& to, cv::Point to_at,
          cv::Size size, int channels) {
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      std::copy_n(from.pixel(0, from_at.y + y, from_at.x + x), channels,
                  to.pixel(0, to_at.y + y, to_at.x + x));
    }
  }
}

std::vector<float> normal_noise(const ViewPictures::Noise& noise, std::size_t count) {
  std::vector<float> values;
  for (std::uint32_t i = 0; values.size() < count; ++i) {
    const auto pair = random_normal(noise.seed, {noise.view, 0, i, kNoise});
    values.push_back(static_cast<float>(pair[0]));
    if (values.size() < count) values.push_back(static_cast<float>(pair[1]));
  }
  return values;
}

}  // namespace

ViewPictures::ViewPictures(const models::Autoencoder& autoencoder, const models::Refiner& refiner,
                           const nn::TensorView& projection, const cv::Mat1b& background,
                           Noise noise, bool region)
    : autoencoder_(autoencoder),
      refiner_(refiner),
      background_(background),
      noise_(normal_noise(noise, refiner.noise_count())),
      missing_(cells_around(background)),
      combined_({1, background.rows, background.cols, 4}),
      image_({1, background.rows, background.cols, 3}) {
  const cv::Size size = background.size();
  const cv::Rect all(cv::Point(), size);
  decoded_ = region ? grown(missing_, kDecoderReach, size) : all;
  changed_ = region ? grown(missing_, kRefinerReach, size) : all;
  copy(projection, {}, combined_, {}, size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      combined_.view().pixel(0, y, x)[3] = background(y, x) ? 0.0f : 1.0f;
    }
  }
}

void ViewPictures::decode(const std::vector<std::int32_t>& codes, nn::Workspace& workspace) {
  const nn::Workspace::Scope scope(workspace);
  const int columns = background_.cols / kCell;
  std::vector<std::int32_t> part;
  for (int y = decoded_.y / kCell; y < decoded_.br().y / kCell; ++y) {
    for (int x = decoded_.x / kCell; x < decoded_.br().x / kCell; ++x) {
      part.push_back(codes[static_cast<std::size_t>(y * columns + x)]);
    }
  }
  const nn::TensorView decoded = workspace.take({1, decoded_.height, decoded_.width, 3});
  autoencoder_.decode(part.data(), decoded, workspace);
  for (int y = missing_.y; y < missing_.br().y; ++y) {
    for (int x = missing_.x; x < missing_.br().x; ++x) {
      if (!background_(y, x)) continue;
      std::copy_n(decoded.pixel(0, y - decoded_.y, x - decoded_.x), 3,
                  combined_.view().pixel(0, y, x));
    }
  }
}

void ViewPictures::copy_unrefined(const nn::TensorView& to) const {
  copy(combined_, {}, to, {}, background_.size(), 3);
}

void ViewPictures::refine_rest(nn::Workspace& workspace) {
  if (has_rest()) refine(cv::Rect(cv::Point(), background_.size()), workspace);
}

void ViewPictures::refine(nn::Workspace& workspace) { refine(changed_, workspace); }

void ViewPictures::refine(const cv::Rect& part, nn::Workspace& workspace) {
  const nn::Workspace::Scope scope(workspace);
  const cv::Rect in = grown(part, kRefinerReach, background_.size());
  const nn::TensorView input = workspace.take({1, in.height, in.width, 4});
  const nn::TensorView output = workspace.take({1, in.height, in.width, 3});
  copy(combined_, in.tl(), input, {}, in.size(), 4);
  refiner_.forward(input, noise_.data(), output, workspace);
  copy(output, part.tl() - in.tl(), image_, part.tl(), part.size(), 3);
}

}  // namespace ps::outpaint
