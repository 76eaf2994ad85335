// SPDX-License-Identifier: BSD-3-Clause
#include "libps/nn/indirect_product.h"

#include <algorithm>
#include <vector>

#include "libps/core/error.h"
#include "libps/core/parallel.h"

namespace ps::nn {
namespace {

constexpr std::size_t kRows = PackedMatrix::kRows;
constexpr std::size_t kGroup = IndirectRows::kSlots;
constexpr std::size_t kSmallMatrix = 128 * 1024;  ///< bytes
constexpr std::size_t kTasks = 8;   ///< aimed at: so few rows are split by panels, too
constexpr double kSmallWork = 2e5;  ///< multiplications that are not worth waking a thread

/// Some rows with some panels.
struct Part {
  std::size_t begin, end;
  int first, last;
};

/// What a thread prepares of a group of rows, for all panels.
struct Group {
  std::vector<const float*> pointers;  ///< as IndirectRows has them, then without the taps left out
  std::vector<int> tap_index;
  float* targets[kGroup];
  const float* residuals[kGroup];
  PackedMatrix::Tile tiles[kGroup / kRows];
};

/// Leaves out the taps that are null in all rows of a tile; what is null in some becomes zeros.
int keep_taps(const float** pointers, int taps, std::size_t rows, const float* zeros,
              int* tap_index) {
  int kept = 0;
  for (int tap = 0; tap < taps; ++tap) {
    const float** from = pointers + static_cast<std::size_t>(tap) * kRows;
    const float** to = pointers + static_cast<std::size_t>(kept) * kRows;
    bool any = false;
    for (std::size_t i = 0; i < rows; ++i) any = any || from[i];
    if (!any) continue;
    for (std::size_t i = 0; i < rows; ++i) to[i] = from[i] ? from[i] : zeros;
    tap_index[kept++] = tap;
  }
  return kept;
}

void prepare(const PackedMatrix& matrix, const IndirectRows& rows, const TensorView& out,
             const Epilogue& epilogue, const Part& part, Group& group) {
  const auto taps = static_cast<std::size_t>(rows.taps);
  group.pointers.resize(std::max(group.pointers.size(), kGroup * taps));
  group.tap_index.resize(std::max(group.tap_index.size(), kGroup / kRows * taps));
  rows.sources(part.begin, part.end, group.pointers.data());
  for (std::size_t row = part.begin; row < part.end; ++row) {
    const std::size_t pixel = rows.target ? rows.target(row) : row;
    group.targets[row - part.begin] = out.pixel(pixel);
    if (epilogue.residual) group.residuals[row - part.begin] = epilogue.residual->pixel(pixel);
  }
  for (std::size_t slot = 0; slot < part.end - part.begin; slot += kRows) {
    const std::size_t tile = slot / kRows, count = std::min(kRows, part.end - part.begin - slot);
    const float** pointers = group.pointers.data() + tile * taps * kRows;
    int* tap_index = group.tap_index.data() + tile * taps;
    const int kept = keep_taps(pointers, rows.taps, count, matrix.zeros(), tap_index);
    group.tiles[tile] = {pointers,
                         tap_index,
                         kept,
                         static_cast<int>(count),
                         group.targets + slot,
                         epilogue.residual ? group.residuals + slot : nullptr};
  }
}

void multiply_part(const PackedMatrix& matrix, const IndirectRows& rows, const TensorView& out,
                   const Epilogue& epilogue, const Part& part) {
  thread_local Group group;
  prepare(matrix, rows, out, epilogue, part, group);
  // What a panel needs stays in the cache: panels in turn, or, where all are small, all at once.
  const int step = matrix.bytes() <= kSmallMatrix ? part.last - part.first : 1;
  const std::size_t tiles = (part.end - part.begin + kRows - 1) / kRows;
  for (int panel = part.first; panel < part.last; panel += step) {
    for (std::size_t tile = 0; tile < tiles; ++tile) {
      matrix.multiply(group.tiles[tile], rows.taps, epilogue, panel, panel + step);
    }
  }
}

std::string text(const Shape& s) {
  return std::to_string(s.images) + "x" + std::to_string(s.height) + "x" + std::to_string(s.width) +
         "x" + std::to_string(s.channels);
}

}  // namespace

void indirect_product(const PackedMatrix& matrix, const IndirectRows& rows, const TensorView& out,
                      const Epilogue& epilogue) {
  if (rows.count == 0 || matrix.columns() == 0) return;
  const auto panels = static_cast<std::size_t>(matrix.panels());
  const std::size_t most_groups = (rows.count + kGroup - 1) / kGroup;
  const std::size_t tiles = (rows.count + kRows - 1) / kRows;
  const std::size_t group = (tiles + most_groups - 1) / most_groups * kRows;  // all alike
  const std::size_t row_groups = (rows.count + group - 1) / group;
  const std::size_t panel_groups = std::min(panels, (kTasks + row_groups - 1) / row_groups);
  const auto task = [&](std::size_t i) {
    const std::size_t begin = i / panel_groups * group, part = i % panel_groups;
    multiply_part(
        matrix, rows, out, epilogue,
        {begin, std::min(rows.count, begin + group), static_cast<int>(panels * part / panel_groups),
         static_cast<int>(panels * (part + 1) / panel_groups)});
  };
  const std::size_t tasks = row_groups * panel_groups;
  const double work = static_cast<double>(rows.count) * matrix.taps() * matrix.depth() *
                      static_cast<double>(matrix.columns());
  if (work < kSmallWork) {
    for (std::size_t i = 0; i < tasks; ++i) task(i);
  } else {
    parallel_for(tasks, task);
  }
}

void check_same(const Shape& got, const Shape& wanted, const char* what) {
  if (got != wanted) throw Error(what, "a tensor of " + text(got), text(wanted));
}

Epilogue with_bias(const Epilogue& given, const std::vector<float>& bias, const Shape& out,
                   const char* what) {
  if (given.bias) throw Error(what, "an epilogue with a bias", "the operator's own bias alone");
  if (!given.scale != !given.shift) {
    throw Error(what, "an epilogue with a scale or a shift alone", "both or neither");
  }
  if (given.residual) check_same(given.residual->shape, out, what);
  Epilogue epilogue = given;
  epilogue.bias = bias.empty() ? nullptr : bias.data();
  return epilogue;
}

void check_bias(const std::vector<float>& bias, std::size_t channels, const char* what) {
  if (!bias.empty() && bias.size() != channels) {
    throw Error(what, "a bias of " + std::to_string(bias.size()) + " values",
                std::to_string(channels) + ", one for each channel, or none");
  }
}

}  // namespace ps::nn
