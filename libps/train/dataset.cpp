// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/dataset.h"

#include <algorithm>

#include "libps/core/error.h"
#include "libps/train/shard.h"

namespace fs = std::filesystem;

namespace ps::train {
namespace {

constexpr std::int64_t kCell = 8;

struct Field {
  const char* name;
  const char* dtype;
  torch::ScalarType type;
};

Tensor field(TensorMap& tensors, const Field& wanted, const std::string& where) {
  const auto found = tensors.find(wanted.name);
  if (found == tensors.end())
    throw Error(where, std::string("there is no ") + wanted.name, "a shard of examples");
  FileTensor& tensor = found->second;
  if (tensor.dtype != wanted.dtype) {
    throw Error(where, std::string(wanted.name) + " is " + tensor.dtype, wanted.dtype);
  }
  const std::vector<std::int64_t> shape(tensor.shape.begin(), tensor.shape.end());
  return torch::from_blob(tensor.bytes.data(), shape, torch::TensorOptions().dtype(wanted.type));
}

void check_shape(const Tensor& tensor, const std::vector<std::int64_t>& shape, const char* name,
                 const std::string& where) {
  if (tensor.sizes() != torch::IntArrayRef(shape)) {
    throw Error(where, std::string(name) + " is of the wrong shape", "that of color");
  }
}

std::string group_of(const fs::path& path) {
  const std::string stem = path.stem().string();
  return stem.substr(0, stem.rfind('-'));
}

Tensor uniform(std::int64_t n, double low, double high, torch::Generator& generator) {
  return torch::rand({n}, generator) * (high - low) + low;
}

/// Rows of several shards, one after another.
class Gathered {
 public:
  void add(const Tensor& of, std::int64_t row) { rows_.push_back(of[row]); }
  Tensor stacked() const { return torch::stack(rows_); }

 private:
  std::vector<Tensor> rows_;
};

Tensor as_picture(const Tensor& bytes, torch::Device device) {
  // Channels stay last in memory; only the axes are renamed.
  return bytes.to(device).to(torch::kFloat32).div_(127.5).sub_(1).permute({0, 3, 1, 2});
}

void jitter(Tensor& color, torch::Generator& generator) {
  const std::int64_t n = color.size(0);
  const auto each = [&](double low, double high) {
    return uniform(n, low, high, generator).view({n, 1, 1, 1}).to(color.device());
  };
  Tensor x = ((color + 1) / 2).clamp(1e-4, 1);
  x = x.pow(torch::exp(each(-.35, .35))) * torch::exp(each(-.3, .3));
  const Tensor tint =
      torch::exp(torch::randn({n, 3, 1, 1}, generator).mul_(.06)).to(color.device());
  x = x * tint;
  const Tensor grey = x.mean(1, true);
  x = grey + (x - grey) * each(.5, 1.4);
  const Tensor mean = x.mean({1, 2, 3}, true);
  x = mean + (x - mean) * each(.75, 1.25);
  color = x.clamp_(0, 1).mul_(2).sub_(1).contiguous(torch::MemoryFormat::ChannelsLast);
}

void crop_and_mirror(Batch& batch, const Augmentation& how, torch::Generator& generator) {
  const std::int64_t n = batch.color.size(0);
  const Tensor share = how.crop ? uniform(n, .6, 1, generator) : torch::ones({n});
  const Tensor flip = how.mirror ? (torch::rand({n}, generator) < .5).to(torch::kFloat32) * -2 + 1
                                 : torch::ones({n});
  const Tensor theta = torch::zeros({n, 2, 3});
  theta.select(1, 0).select(1, 0).copy_(share * flip);
  theta.select(1, 1).select(1, 1).copy_(share);
  theta.select(1, 0).select(1, 2).copy_((1 - share) * uniform(n, -1, 1, generator));
  theta.select(1, 1).select(1, 2).copy_((1 - share) * uniform(n, -1, 1, generator));
  const Tensor grid = torch::nn::functional::affine_grid(theta.to(batch.color.device()),
                                                         batch.color.sizes(), false);
  batch.color = torch::grid_sampler(batch.color, grid, 0, 2, false)
                    .contiguous(torch::MemoryFormat::ChannelsLast);
  if (batch.depth.defined()) {
    // The crop's focal length is longer by 1 / share, so canonical depth is shorter.
    batch.depth = torch::grid_sampler(batch.depth, grid, 1, 2, false) *
                  share.view({n, 1, 1, 1}).to(batch.color.device());
  }
}

}  // namespace

Dataset::Shard Dataset::read(const fs::path& path) {
  const std::string where = path.string();
  Shard shard;
  shard.tensors = read_safetensors(path);
  shard.color = field(shard.tensors, {"color", "U8", torch::kUInt8}, where);
  if (shard.color.dim() != 4 || shard.color.size(1) != shard.color.size(2)) {
    throw Error(where, "color is of the wrong shape", "[n, s, s, 3]");
  }
  const auto n = shard.color.size(0), s = shard.color.size(1), cells = (s / kCell) * (s / kCell);
  shard.depth = field(shard.tensors, {"depth", "F16", torch::kFloat16}, where);
  shard.focal = field(shard.tensors, {"focal", "F32", torch::kFloat32}, where);
  shard.kind = field(shard.tensors, {"kind", "U8", torch::kUInt8}, where);
  shard.splat = field(shard.tensors, {"splat", "U8", torch::kUInt8}, where);
  shard.flags = field(shard.tensors, {"flags", "U8", torch::kUInt8}, where);
  shard.order = field(shard.tensors, {"order", "I32", torch::kInt32}, where);
  check_shape(shard.color, {n, s, s, 3}, "color", where);
  check_shape(shard.depth, {n, s, s}, "depth", where);
  check_shape(shard.focal, {n}, "focal", where);
  check_shape(shard.kind, {n}, "kind", where);
  check_shape(shard.splat, {n / 2, s, s, 3}, "splat", where);
  check_shape(shard.flags, {n / 2, s, s}, "flags", where);
  check_shape(shard.order, {n / 2, cells}, "order", where);
  return shard;
}

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
    shards_.push_back(read(file));
    const auto side = shards_.back().color.size(1);
    if (side_ != 0 && side != side_)
      throw Error(file.string(), "views of another size", "one size in a folder");
    side_ = side;
    for (std::int64_t row = 0; row < shards_.back().color.size(0); ++row) {
      members_.back().places.push_back(static_cast<std::int64_t>(places_.size()));
      places_.push_back({shards_.size() - 1, groups_.size() - 1, row});
    }
  }
}

std::vector<std::int64_t> Dataset::draw(std::int64_t count, const std::vector<double>& shares,
                                        bool targets, torch::Generator generator) const {
  const Tensor weights = torch::tensor(shares, torch::kFloat64);
  const Tensor groups = torch::multinomial(weights, count, true, generator);
  const Tensor at = torch::rand({count}, generator, torch::TensorOptions().dtype(torch::kFloat64));
  std::vector<std::int64_t> drawn;
  for (std::int64_t i = 0; i < count; ++i) {
    const Members& members = members_[static_cast<std::size_t>(groups[i].item<std::int64_t>())];
    auto k = static_cast<std::int64_t>(at[i].item<double>() * static_cast<double>(members.size()));
    if (targets) k |= 1;
    drawn.push_back(members.places[static_cast<std::size_t>(std::min(k, members.size() - 1))]);
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

Batch Dataset::batch(const std::vector<std::int64_t>& indices, bool pairs,
                     torch::Device device) const {
  Gathered color, depth, kind, splat, flags, order;
  std::vector<std::int64_t> group;
  for (const std::int64_t index : indices) {
    const Place& place = places_[static_cast<std::size_t>(index)];
    const Shard& shard = shards_[place.shard];
    color.add(shard.color, place.row);
    depth.add(shard.depth, place.row);
    kind.add(shard.kind, place.row);
    group.push_back(static_cast<std::int64_t>(place.group));
    if (!pairs) continue;
    splat.add(shard.splat, place.row / 2);
    flags.add(shard.flags, place.row / 2);
    order.add(shard.order, place.row / 2);
  }
  Batch batch;
  batch.color = as_picture(color.stacked(), device);
  batch.depth = depth.stacked().to(device).to(torch::kFloat32).unsqueeze(1);
  batch.kind = kind.stacked().to(device).to(torch::kInt64);
  batch.kind.masked_fill_(batch.kind == kUnknownKind, -1);
  batch.group = torch::tensor(group).to(device);
  if (!pairs) return batch;
  const Tensor bits = flags.stacked().to(device).unsqueeze(1);
  batch.splat = as_picture(splat.stacked(), device);
  batch.hit = bits.bitwise_and(kHit).to(torch::kFloat32);
  batch.missing = bits.bitwise_and(kMissing).to(torch::kFloat32) / kMissing;
  batch.order = order.stacked().to(device).to(torch::kInt64);
  // A cell is sampled when all of it is missing (SPEC.md 6).
  batch.unseen = (torch::avg_pool2d(batch.missing, kCell) == 1).to(torch::kFloat32).flatten(1);
  return batch;
}

void augment(Batch& batch, const Augmentation& how, torch::Generator generator) {
  const torch::NoGradGuard guard;
  if (how.crop || how.mirror) crop_and_mirror(batch, how, generator);
  if (how.jitter) jitter(batch.color, generator);
}

}  // namespace ps::train
