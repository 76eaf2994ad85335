// SPDX-License-Identifier: BSD-3-Clause
#include "libps/rooms/plane_smoother.h"

#include "libps/rooms/isa.h"

namespace ps::rooms {

using plane_kernel::Stretch;

PlaneSmoother::PlaneSmoother(const PicturePlane& plane, const std::vector<Vec>& image)
    : width_(plane.width), height_(plane.height), stride_(plane.width + 2 * kMargin) {
  // Past its last pixel a row is read and written up to a step on.
  const std::size_t size = static_cast<std::size_t>(stride_) * height_ + plane_kernel::kStep;
  for (auto& p : from_) p.resize(size);
  for (auto& p : to_) p.resize(size);
  along_rows_.resize(size, -1);
  along_columns_.resize(size, -1);
  nowhere_.resize(stride_ + plane_kernel::kStep, -1);
  for (int y = 0; y < height_; ++y) {
    const std::size_t i = plane.index(0, y), j = index(0, y);
    for (int x = 0; x < width_; ++x) {
      from_[0][j + x] = image[i + x].x;
      from_[1][j + x] = image[i + x].y;
      from_[2][j + x] = image[i + x].z;
      along_rows_[j + x] = plane.row_ends[i + x];
      along_columns_[j + x] = plane.column_ends[i + x];
    }
  }
}

Stretch PlaneSmoother::row_of(int x, int y, const std::vector<std::int32_t>& surfaces) const {
  const std::size_t i = index(x, y);
  return {{&from_[0][i], &from_[1][i], &from_[2][i]}, &surfaces[i]};
}

template <typename Kernel>
void PlaneSmoother::pass(Kernel kernel, int taps, int apart) {
  Stretch stretches[5];
  for (const bool along_x : {true, false}) {
    for (int y = 0; y < height_; ++y) {
      for (int t = 0; t < taps; ++t) {
        const int away = (t - taps / 2) * apart;
        if (along_x) {
          stretches[t] = row_of(away, y, along_rows_);
        } else if (y + away >= 0 && y + away < height_) {
          stretches[t] = row_of(0, y + away, along_columns_);
        } else {
          stretches[t] = row_of(0, y, along_columns_);
          stretches[t].surface = nowhere_.data();
        }
      }
      const std::size_t i = index(0, y);
      float* const out[3] = {&to_[0][i], &to_[1][i], &to_[2][i]};
      kernel(stretches, out, width_);
    }
    std::swap(from_, to_);
  }
}

void PlaneSmoother::share(int apart) { pass(PS_FITTING(plane_kernel::share), 5, apart); }

void PlaneSmoother::share_alike(int apart) {
  pass(PS_FITTING(plane_kernel::share_alike), 3, apart);
}

Vec PlaneSmoother::at(int x, int y) const {
  const std::size_t i = index(x, y);
  return {from_[0][i], from_[1][i], from_[2][i]};
}

}  // namespace ps::rooms
