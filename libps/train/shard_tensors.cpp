// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/shard_tensors.h"

#include <map>
#include <string>
#include <vector>

#include "libps/core/error.h"

namespace ps::train {
namespace {

constexpr std::int64_t kCell = 8;

using Shape = std::vector<std::int64_t>;

/// Takes fields out of a file.
class Reader {
 public:
  Reader(const MappedSafetensors& file, std::string where)
      : tensors_(file.tensors()), where_(std::move(where)) {}

  bool has(const char* name) const { return tensors_.count(name) > 0; }

  Tensor take(const char* name, const char* dtype, torch::ScalarType type) const {
    const auto found = tensors_.find(name);
    if (found == tensors_.end())
      throw Error(where_, std::string("there is no ") + name, "a shard of examples");
    const MappedSafetensors::Tensor& tensor = found->second;
    if (tensor.dtype != dtype)
      throw Error(where_, std::string(name) + " is " + tensor.dtype, dtype);
    const Shape shape(tensor.shape.begin(), tensor.shape.end());
    return torch::from_blob(const_cast<std::byte*>(tensor.data), shape, type);
  }

  Tensor take(const char* name, const char* dtype, torch::ScalarType type,
              const Shape& shape) const {
    Tensor tensor = take(name, dtype, type);
    if (tensor.sizes() != torch::IntArrayRef(shape)) {
      throw Error(where_, std::string(name) + " is of the wrong shape", "that of color");
    }
    return tensor;
  }

 private:
  const std::map<std::string, MappedSafetensors::Tensor>& tensors_;
  std::string where_;
};

/// What would make a training's losses NaN, or networks learn nonsense.
void check_geometry(const ShardTensors& shard, const std::string& where) {
  if (!(shard.lens.narrow(1, 0, 2) > 0).all().item<bool>() ||
      !torch::isfinite(shard.lens).all().item<bool>()) {
    throw Error(where, "a lens is unsound", "positive focal lengths, finite numbers");
  }
  const Tensor rotation = shard.pose.view({-1, 3, 4}).narrow(2, 0, 3);
  const Tensor product = torch::matmul(rotation, rotation.transpose(1, 2));
  const Tensor off = (product - torch::eye(3)).abs();
  // NaN is not less than anything.
  if (!(off < 1e-3).all().item<bool>() || !torch::isfinite(shard.pose).all().item<bool>()) {
    throw Error(where, "a pose is not rigid", "R | t with a rotation R");
  }
}

}  // namespace

ShardTensors read_shard(const std::filesystem::path& path) {
  const std::string where = path.string();
  ShardTensors shard(path);
  const Reader reader(shard.file, where);
  shard.color = reader.take("color", "U8", torch::kUInt8);
  if (shard.color.dim() != 4 || shard.color.size(1) != shard.color.size(2)) {
    throw Error(where, "color is of the wrong shape", "[n, s, s, 3]");
  }
  const auto n = shard.color.size(0), s = shard.color.size(1), cells = (s / kCell) * (s / kCell);
  if (shard.color.size(3) != 3 || n % 2 != 0) {
    throw Error(where, "color is of the wrong shape", "[n, s, s, 3], n even");
  }
  shard.depth = reader.take("depth", "F16", torch::kFloat16, {n, s, s});
  shard.focal = reader.take("focal", "F32", torch::kFloat32, {n});
  shard.kind = reader.take("kind", "U8", torch::kUInt8, {n});
  shard.splat = reader.take("splat", "U8", torch::kUInt8, {n / 2, s, s, 3});
  shard.flags = reader.take("flags", "U8", torch::kUInt8, {n / 2, s, s});
  shard.order = reader.take("order", "I32", torch::kInt32, {n / 2, cells});
  shard.posed = reader.has("lens") || reader.has("pose");
  if (!shard.posed) {
    shard.lens = torch::ones({n, 4});
    shard.pose = torch::eye(3, 4).view({1, 12}).repeat({n / 2, 1});
    return shard;
  }
  shard.lens = reader.take("lens", "F32", torch::kFloat32, {n, 4});
  shard.pose = reader.take("pose", "F32", torch::kFloat32, {n / 2, 12});
  check_geometry(shard, where);
  return shard;
}

}  // namespace ps::train
