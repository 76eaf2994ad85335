// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/surroundings.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr std::size_t kCellsAtATime = 8;
constexpr float kNoDirection = 0.3f;  ///< pixels; what is nearer tells nothing of directions
/// A surface ends where so many of eight directions in a row have no sample: a straight outline
/// leaves three or four, and a hole narrower than a splat none.
constexpr int kEmptyAtEnd = 3;

/// What splats show where a sample is.
struct Shown {
  Eigen::Vector3f color;
  Eigen::Vector3f position;  ///< the sample, moved onto the plane of those around it
  Eigen::Vector3f normal;
  bool apart;  ///< the surface ends here, or is none
};

struct Neighbour {
  float distance;  ///< metres
  std::uint32_t sample;
};

/// The samples in and around a cell, next to each other in memory.
class Around {
 public:
  Around(const std::vector<Sample>& samples, const SampleGrid& grid)
      : samples_(samples), grid_(grid) {}

  void gather(std::size_t cell) {
    grid_.list_around(cell, &numbers_);
    positions_.clear();
    for (const std::uint32_t i : numbers_) positions_.push_back(samples_[i].position);
    near_.resize(numbers_.size());
  }

  /// @return those up to `reach` metres away, and how many
  const Neighbour* near(const Sample& sample, float reach, std::size_t* count) {
    std::size_t found = 0;
    for (std::size_t k = 0; k < positions_.size(); ++k) {
      const float d2 = (positions_[k] - sample.position).squaredNorm();
      near_[found] = {d2, numbers_[k]};
      found += d2 <= reach * reach ? 1 : 0;  // without a branch: which are near is hard to foretell
    }
    for (std::size_t k = 0; k < found; ++k) near_[k].distance = std::sqrt(near_[k].distance);
    *count = found;
    return near_.data();
  }

 private:
  const std::vector<Sample>& samples_;
  const SampleGrid& grid_;
  std::vector<std::uint32_t> numbers_;
  std::vector<Eigen::Vector3f> positions_;
  std::vector<Neighbour> near_;
};

/// @return which eighth of the plane (x, y) lies in, in order around it
int eighth(float x, float y) {
  const int half = y > 0 ? 0 : 4;
  if (half) x = -x, y = -y;
  return half + (x > 0 ? (x > y ? 0 : 1) : (-x < y ? 2 : 3));
}

/// @return the longest run of zeros among eight bits in a ring
int longest_gap(unsigned bits) {
  int run = 0, longest = 0;
  for (int i = 0; i < 16; ++i) {
    run = bits >> (i % 8) & 1 ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
}

class Looker {
 public:
  Looker(const std::vector<Sample>& samples, const SampleGrid& grid, const LookOptions& options,
         Meter* meter)
      : samples_(samples), grid_(grid), options_(options), meter_(meter), shown_(samples.size()) {}

  std::vector<Surroundings> look() {
    for_each_sample([&](std::uint32_t i, Around& around) { shown_[i] = shown(i, around); });
    std::vector<Surroundings> result(samples_.size());
    for_each_sample([&](std::uint32_t i, Around& around) { result[i] = differences(i, around); });
    return result;
  }

 private:
  template <typename Body>
  void for_each_sample(const Body& body) const {
    parallel_chunks(grid_.cells(), kCellsAtATime, [&](std::size_t begin, std::size_t end) {
      Around around(samples_, grid_);
      for (std::size_t cell = begin; cell < end; ++cell) {
        if (meter_) meter_->add(grid_.own(cell).size());
        around.gather(cell);
        for (const std::uint32_t i : grid_.own(cell)) body(i, around);
      }
    });
  }

  /// Means, weighted as a splat weighs: the plane is the one of least squares.
  Shown shown(std::uint32_t i, Around& around) const {
    const Sample& s = samples_[i];
    std::size_t count = 0;
    const Neighbour* near = around.near(s, options_.radius * s.pixel, &count);
    const float per_metre = 1 / s.pixel, per_radius = per_metre / options_.radius;
    const float per_finest = per_metre / options_.finest;
    float sum = 0, color_sum = 0;
    Eigen::Vector3f color = Eigen::Vector3f::Zero(), mean = Eigen::Vector3f::Zero();
    Eigen::Matrix3f square = Eigen::Matrix3f::Zero();
    for (const Neighbour* n = near; n != near + count; ++n) {
      const Sample& other = samples_[n->sample];
      const float weight = 1 - n->distance * per_radius;
      const float color_weight = std::max(0.f, 1 - n->distance * per_finest);
      const Eigen::Vector3f offset = (other.position - s.position) * per_metre;
      const Eigen::Vector3f weighted = weight * offset;
      sum += weight;
      color_sum += color_weight;
      color += color_weight * other.color;
      mean += weighted;
      square.noalias() += weighted * offset.transpose();
    }
    mean /= sum;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes;
    axes.computeDirect(square / sum - mean * mean.transpose());
    const Eigen::Vector3f normal = axes.eigenvectors().col(0);
    const float rough = std::sqrt(std::max(0.f, axes.eigenvalues()[0]));
    return {color / color_sum, s.position + normal.dot(mean) * s.pixel * normal, normal,
            rough > 1.5f * options_.flat || ends(s, near, count, axes.eigenvectors())};
  }

  bool ends(const Sample& s, const Neighbour* near, std::size_t count,
            const Eigen::Matrix3f& axes) const {
    unsigned directions = 0;
    const float least = kNoDirection * s.pixel;
    for (const Neighbour* n = near; n != near + count; ++n) {
      const Eigen::Vector3f offset = samples_[n->sample].position - s.position;
      const float x = axes.col(1).dot(offset), y = axes.col(2).dot(offset);
      if (x * x + y * y >= least * least) directions |= 1u << eighth(x, y);
    }
    return longest_gap(directions) >= kEmptyAtEnd;
  }

  Surroundings differences(std::uint32_t i, Around& around) const {
    const Sample& s = samples_[i];
    const Shown& here = shown_[i];
    Surroundings result;
    auto& difference = result.difference;
    if (here.apart) {
      difference.fill(Surroundings::kApart);
      result.clear = 0;
      return result;
    }
    const float reach = options_.reach * s.pixel, flat = options_.flat * s.pixel;
    std::size_t count = 0;
    const Neighbour* near = around.near(s, reach, &count);
    for (const Neighbour* n = near; n != near + count; ++n) {
      const Shown& there = shown_[n->sample];
      const bool bent = std::fabs(here.normal.dot(there.position - here.position)) > flat;
      if (there.apart || bent) result.clear = std::min(result.clear, n->distance);
      if (there.apart) continue;  // it speaks for itself, whatever is around it
      const float most = (there.color - here.color).cwiseAbs().maxCoeff();
      const std::uint8_t one =
          bent ? Surroundings::kApart : static_cast<std::uint8_t>(std::ceil(std::min(254.f, most)));
      const int step = static_cast<int>(n->distance * Surroundings::kSteps / reach);
      auto& worst = difference[std::min(step, Surroundings::kSteps - 1)];
      worst = std::max(worst, one);
    }
    for (int k = 1; k < Surroundings::kSteps; ++k) {
      difference[k] = std::max(difference[k], difference[k - 1]);
    }
    return result;
  }

  const std::vector<Sample>& samples_;
  const SampleGrid& grid_;
  const LookOptions options_;
  Meter* const meter_;
  std::vector<Shown> shown_;
};

}  // namespace

std::vector<Surroundings> look_around(const std::vector<Sample>& samples, const SampleGrid& grid,
                                      const LookOptions& options, Meter* meter) {
  return Looker(samples, grid, options, meter).look();
}

}  // namespace ps
