// SPDX-License-Identifier: BSD-3-Clause
#include "apps/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ps::apps {

Image contact_sheet(const std::vector<SheetTile>& tiles, int tile_width) {
  if (tiles.empty()) return Image();
  constexpr int kCaption = 22, kGap = 8;
  const cv::Size first = tiles.front().image.size();
  const int tile_height = std::max(1, static_cast<int>(std::lround(static_cast<double>(tile_width) *
                                                                   first.height / first.width)));
  int rows = 0, columns = 0;
  for (const SheetTile& tile : tiles) {
    rows = std::max(rows, tile.row + 1);
    columns = std::max(columns, tile.column + 1);
  }
  const cv::Vec3f paper(0.93f, 0.93f, 0.93f);
  Image sheet(rows * (tile_height + kCaption) + kGap, columns * (tile_width + kGap) + kGap, paper);
  for (const SheetTile& tile : tiles) {
    const cv::Point corner(kGap + tile.column * (tile_width + kGap),
                           kCaption + tile.row * (tile_height + kCaption));
    Image place = sheet(cv::Rect(corner, cv::Size(tile_width, tile_height)));
    cv::resize(tile.image, place, place.size(), 0, 0, cv::INTER_AREA);
    cv::putText(sheet, tile.name, corner + cv::Point(2, -6), cv::FONT_HERSHEY_SIMPLEX, 0.5,
                cv::Scalar(0.1, 0.1, 0.1), 1, cv::LINE_AA);
  }
  return sheet;
}

}  // namespace ps::apps
