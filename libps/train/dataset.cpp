// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/dataset.h"

#include <algorithm>
#include <cmath>

#include "libps/core/error.h"
#include "libps/train/shard.h"

namespace fs = std::filesystem;

namespace ps::train {
namespace {

constexpr std::int64_t kCell = 8;

std::string group_of(const fs::path& path) {
  const std::string stem = path.stem().string();
  return stem.substr(0, stem.rfind('-'));
}

/// Rows of several shards, one after another.
class Gathered {
 public:
  void add(const Tensor& of, std::int64_t row) { rows_.push_back(of[row]); }
  void add(const Tensor& row) { rows_.push_back(row); }
  Tensor stacked() const { return torch::stack(rows_); }

 private:
  std::vector<Tensor> rows_;
};

/// Of a rigid [3, 4].
Tensor inverted(const Tensor& pose) {
  const Tensor back = pose.narrow(1, 0, 3).t();
  return torch::cat({back, -(back * pose.select(1, 3)).sum(1, true)}, 1);
}

/// Radians by which a [12] pose turns.
double turn_of(const Tensor& pose) {
  const float* const p = pose.data_ptr<float>();
  return std::acos(std::clamp((p[0] + p[5] + p[10] - 1) / 2., -1., 1.));
}

Tensor as_picture(const Tensor& bytes, torch::Device device) {
  // Channels stay last in memory; only the axes are renamed.
  return bytes.to(device).to(torch::kFloat32).div_(127.5).sub_(1).permute({0, 3, 1, 2});
}

}  // namespace

Dataset::Dataset(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".safetensors") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    throw Error(folder.string(), "there are no examples",
                "GROUP-NUMBER.safetensors, which `train data` writes");
  }
  for (const fs::path& file : files) {
    const std::string group = group_of(file);
    if (groups_.empty() || groups_.back() != group) {
      groups_.push_back(group);
      members_.emplace_back();
    }
    shards_.push_back(read_shard(file));
    const auto side = shards_.back().color.size(1);
    if (side_ != 0 && side != side_)
      throw Error(file.string(), "views of another size", "one size in a folder");
    side_ = side;
    for (std::int64_t row = 0; row < shards_.back().color.size(0); ++row) {
      const auto place = static_cast<std::int64_t>(places_.size());
      members_.back().places.push_back(place);
      if (row % 2 == 1) {
        members_.back().by_turn.push_back({turn_of(shards_.back().pose[row / 2]), place});
      }
      places_.push_back({shards_.size() - 1, groups_.size() - 1, row});
    }
  }
  for (Members& members : members_) {
    std::stable_sort(members.by_turn.begin(), members.by_turn.end(),
                     [](const Turned& a, const Turned& b) { return a.turn < b.turn; });
  }
}

double Dataset::most_turn() const {
  double most = 0;
  for (const Members& members : members_) {
    if (!members.by_turn.empty()) most = std::max(most, members.by_turn.back().turn);
  }
  return most;
}

/// @param unit  in [0, 1)
std::int64_t Dataset::Members::pick(double unit, bool targets, double most_turn) const {
  const auto of = [&](std::int64_t count) {
    return std::min(static_cast<std::int64_t>(unit * static_cast<double>(count)), count - 1);
  };
  if (most_turn == kAnyTurn) {
    const std::int64_t k = of(size());
    return places[static_cast<std::size_t>(targets ? k | 1 : k)];
  }
  const auto end = std::upper_bound(by_turn.begin(), by_turn.end(), most_turn,
                                    [](double turn, const Turned& t) { return turn < t.turn; });
  const std::int64_t pairs = std::max<std::int64_t>(end - by_turn.begin(), 1);
  if (targets) return by_turn[static_cast<std::size_t>(of(pairs))].second;
  const std::int64_t k = of(2 * pairs);
  return by_turn[static_cast<std::size_t>(k / 2)].second - 1 + k % 2;
}

std::vector<std::int64_t> Dataset::draw(std::int64_t count, const std::vector<double>& shares,
                                        bool targets, torch::Generator generator,
                                        double most_turn) const {
  const Tensor weights = torch::tensor(shares, torch::kFloat64);
  const Tensor groups = torch::multinomial(weights, count, true, generator);
  const Tensor at = torch::rand({count}, generator, torch::TensorOptions().dtype(torch::kFloat64));
  std::vector<std::int64_t> drawn;
  for (std::int64_t i = 0; i < count; ++i) {
    const Members& members = members_[static_cast<std::size_t>(groups[i].item<std::int64_t>())];
    drawn.push_back(members.pick(at[i].item<double>(), targets, most_turn));
  }
  return drawn;
}

std::vector<std::int64_t> Dataset::spread(std::size_t group, std::int64_t count,
                                          bool targets) const {
  const Members& members = members_[group];
  count = std::min(count, members.size() / (targets ? 2 : 1));
  std::vector<std::int64_t> chosen;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t k = i * members.size() / count;
    chosen.push_back(members.places[static_cast<std::size_t>(targets ? k | 1 : k)]);
  }
  return chosen;
}

bool Dataset::posed() const {
  return std::any_of(shards_.begin(), shards_.end(), [](const auto& s) { return s.posed; });
}

Batch Dataset::batch(const std::vector<std::int64_t>& indices, const Wanted& wanted,
                     torch::Device device) const {
  Gathered color, depth, kind;
  std::vector<std::int64_t> group;
  for (const std::int64_t index : indices) {
    const Place& place = places_[static_cast<std::size_t>(index)];
    const ShardTensors& shard = shards_[place.shard];
    color.add(shard.color, place.row);
    depth.add(shard.depth, place.row);
    kind.add(shard.kind, place.row);
    group.push_back(static_cast<std::int64_t>(place.group));
  }
  Batch batch;
  batch.color = as_picture(color.stacked(), device);
  batch.depth = depth.stacked().to(device).to(torch::kFloat32).unsqueeze(1);
  batch.kind = kind.stacked().to(device).to(torch::kInt64);
  batch.kind.masked_fill_(batch.kind == kUnknownKind, -1);
  batch.group = torch::tensor(group).to(device);
  if (wanted.splats) add_splats(batch, indices, device);
  if (wanted.partners) add_partners(batch, indices, device);
  return batch;
}

void Dataset::add_splats(Batch& batch, const std::vector<std::int64_t>& indices,
                         torch::Device device) const {
  Gathered splat, flags, order;
  for (const std::int64_t index : indices) {
    const Place& place = places_[static_cast<std::size_t>(index)];
    const ShardTensors& shard = shards_[place.shard];
    splat.add(shard.splat, place.row / 2);
    flags.add(shard.flags, place.row / 2);
    order.add(shard.order, place.row / 2);
  }
  const Tensor bits = flags.stacked().to(device).unsqueeze(1);
  batch.splat = as_picture(splat.stacked(), device);
  batch.hit = bits.bitwise_and(kHit).to(torch::kFloat32);
  batch.missing = bits.bitwise_and(kMissing).to(torch::kFloat32) / kMissing;
  batch.order = order.stacked().to(device).to(torch::kInt64);
  // A cell is sampled when all of it is missing (SPEC.md 6).
  batch.unseen = (torch::avg_pool2d(batch.missing, kCell) == 1).to(torch::kFloat32).flatten(1);
}

void Dataset::add_partners(Batch& batch, const std::vector<std::int64_t>& indices,
                           torch::Device device) const {
  Gathered color, lens, partner_lens, pose;
  std::vector<float> posed;
  for (const std::int64_t index : indices) {
    const Place& place = places_[static_cast<std::size_t>(index)];
    const ShardTensors& shard = shards_[place.shard];
    const std::int64_t other = place.row ^ 1;
    color.add(shard.color, other);
    lens.add(shard.lens, place.row);
    partner_lens.add(shard.lens, other);
    const Tensor first_from_second = shard.pose[place.row / 2].view({3, 4});
    pose.add(place.row < other ? inverted(first_from_second) : first_from_second);
    posed.push_back(shard.posed ? 1.f : 0.f);
  }
  batch.plain = batch.color;
  batch.partner = as_picture(color.stacked(), device);
  batch.lens = lens.stacked().to(device);
  batch.partner_lens = partner_lens.stacked().to(device);
  batch.partner_from_view = pose.stacked().to(device);
  batch.posed = torch::tensor(posed).to(device);
}

}  // namespace ps::train
