// SPDX-License-Identifier: BSD-3-Clause
#include "libps/geometry/membrane.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr int kCycles = 2;  ///< at each level
constexpr int kSweeps = 2;  ///< on the way down and on the way up
constexpr int kPixelsAtATime = 1 << 14;

template <class Body>
void for_rows(cv::Size size, const Body& body) {
  const int rows = std::max(1, kPixelsAtATime / size.width);
  parallel_chunks(size.height, rows, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) body(y);
  });
}

struct Level {
  cv::Mat1f weight;
  cv::Mat1f pull;              ///< weight * value
  cv::Mat1f softness;          ///< 1 / (weight + links)
  float across = 1, down = 1;  ///< strength of links to left and right, up and down

  cv::Size size() const { return weight.size(); }
};

void set_softness(Level* level) {
  const int right = level->weight.cols - 1, bottom = level->weight.rows - 1;
  level->softness.create(level->size());
  for_rows(level->size(), [&](int y) {
    const float links = level->down * static_cast<float>((y > 0) + (y < bottom));
    for (int x = 0; x <= right; ++x) {
      const float stiffness =
          level->weight(y, x) + links + level->across * static_cast<float>((x > 0) + (x < right));
      level->softness(y, x) = stiffness > 0 ? 1 / stiffness : 0;
    }
  });
}

/// Sums 2x2 pixels.
cv::Mat1f halved(const cv::Mat1f& fine) {
  cv::Mat1f coarse((fine.rows + 1) / 2, (fine.cols + 1) / 2, 0.f);
  for_rows(coarse.size(), [&](int y) {
    for (int row = 2 * y; row < std::min(2 * y + 2, fine.rows); ++row) {
      for (int x = 0; x < fine.cols; ++x) coarse(y, x / 2) += fine(row, x);
    }
  });
  return coarse;
}

/// Twice as many links over twice the distance are as strong; in a single row there are not more.
Level coarser(const Level& fine) {
  Level level{halved(fine.weight), halved(fine.pull), {}, fine.across, fine.down};
  if (fine.weight.rows == 1) level.across /= 2;
  if (fine.weight.cols == 1) level.down /= 2;
  set_softness(&level);
  return level;
}

/// What a level's images look like to those who look at neighbours: with a rim of zeros.
cv::Mat1f rimmed(cv::Size size) { return cv::Mat1f::zeros(size.height + 2, size.width + 2); }

cv::Mat1f inside(const cv::Mat1f& rimmed) {
  return rimmed(cv::Rect(1, 1, rimmed.cols - 2, rimmed.rows - 2));
}

/// Gauss and Seidel's, on one colour of the chessboard: those pixels do not look at each other.
void relax(const Level& level, const cv::Mat1f& pull, int color, cv::Mat1f* u) {
  const float across = level.across, down = level.down;
  for_rows(level.size(), [&](int y) {
    const float *force = pull[y], *softness = level.softness[y];
    const float *above = (*u)[y] + 1, *below = (*u)[y + 2] + 1;
    float* here = (*u)[y + 1] + 1;
    for (int x = (y + color) % 2; x < level.weight.cols; x += 2) {
      here[x] = softness[x] *
                (force[x] + across * (here[x - 1] + here[x + 1]) + down * (above[x] + below[x]));
    }
  });
}

void relax(const Level& level, const cv::Mat1f& pull, cv::Mat1f* u) {
  for (int i = 0; i < 2 * kSweeps; ++i) relax(level, pull, i % 2, u);
}

/// @return what pulls at `u` yet
cv::Mat1f left_over(const Level& level, const cv::Mat1f& pull, const cv::Mat1f& u) {
  cv::Mat1f left(level.size());
  for_rows(level.size(), [&](int y) {
    const float *above = u[y] + 1, *here = u[y + 1] + 1, *below = u[y + 2] + 1;
    for (int x = 0; x < left.cols; ++x) {
      const float softness = level.softness(y, x);
      left(y, x) = pull(y, x) + level.across * (here[x - 1] + here[x + 1]) +
                   level.down * (above[x] + below[x]) - (softness > 0 ? here[x] / softness : 0);
    }
  });
  return left;
}

/// Adds the coarser level's image, doubled bilinearly.
void add_doubled(const cv::Mat1f& coarse, cv::Mat1f* u) {
  cv::Mat1f doubled, fine = inside(*u);
  cv::resize(coarse, doubled, cv::Size(2 * coarse.cols, 2 * coarse.rows));
  fine += doubled(cv::Rect({0, 0}, fine.size()));
}

/// A V cycle, from this level down.
void cycle(const Level* level, const Level* coarsest, const cv::Mat1f& pull, cv::Mat1f* u) {
  relax(*level, pull, u);
  if (level == coarsest) return;
  const Level* next = level + 1;
  cv::Mat1f correction = rimmed(next->size());
  cycle(next, coarsest, halved(left_over(*level, pull, *u)), &correction);
  add_doubled(inside(correction), u);
  relax(*level, pull, u);
}

}  // namespace

cv::Mat1f solve_membrane(const cv::Mat1f& value, const cv::Mat1f& weight) {
  std::vector<Level> levels = {{weight, weight.mul(value), {}}};
  set_softness(&levels.back());
  while (levels.back().weight.total() > 1) levels.push_back(coarser(levels.back()));
  cv::Mat1f u;
  for (int l = static_cast<int>(levels.size()) - 1; l >= 0; --l) {
    const cv::Mat1f start = u;
    u = rimmed(levels[l].size());
    if (!start.empty()) add_doubled(inside(start), &u);
    for (int i = 0; i < kCycles; ++i) cycle(&levels[l], &levels.back(), levels[l].pull, &u);
  }
  return inside(u).clone();
}

}  // namespace ps
