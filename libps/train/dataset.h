// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/safetensors.h"

namespace ps::train {

using torch::Tensor;

/// @brief What of an example a stage wants; each tensor's first axis is the batch.
struct Batch {
  Tensor color;    ///< [n, 3, s, s] RGB in [-1,1]
  Tensor depth;    ///< [n, 1, s, s] canonical metres (examples.h); 0 = unknown
  Tensor kind;     ///< [n] int64, of room; -1 = unknown
  Tensor splat;    ///< [n, 3, s, s] RGB in [-1,1]: the partner, lifted and splatted into this view
  Tensor hit;      ///< [n, 1, s, s] 1 where a point of the partner falls
  Tensor missing;  ///< [n, 1, s, s] 1 where outpainting is wanted (dilated)
  Tensor order;    ///< [n, cells] int64: cells from first to last
  Tensor unseen;   ///< [n, cells] 1 = a cell to be sampled
  Tensor group;    ///< [n] int64: index into Dataset::groups()
};

/// @brief How a picture is changed before a network sees it.
struct Augmentation {
  bool crop = false;    ///< a random square of it, 60 to 100 % of its side, resized to the whole
  bool mirror = false;  ///< left for right, half of them
  bool jitter = false;  ///< brightness, contrast, saturation, hue and gamma
};

/// @brief Examples of a folder of shards (examples.h): GROUP-NUMBER.safetensors. All are held in
/// memory.
class Dataset {
 public:
  /// Throws ps::Error when there is no shard, or one is not sound.
  explicit Dataset(const std::filesystem::path& folder);

  const std::vector<std::string>& groups() const { return groups_; }
  std::int64_t size(std::size_t group) const { return members_[group].size(); }
  std::int64_t side() const { return side_; }

  /// @brief Draws examples: the group by its share, then any of the group alike.
  /// @param shares    by group, any scale
  /// @param targets   only second views, which have a splat and an order
  std::vector<std::int64_t> draw(std::int64_t count, const std::vector<double>& shares,
                                 bool targets, torch::Generator generator) const;
  /// @return the first `count` of a group, evenly spread over it
  std::vector<std::int64_t> spread(std::size_t group, std::int64_t count, bool targets) const;

  /// @param pairs  also splat, hit, missing, order and unseen; then every index is a second view
  Batch batch(const std::vector<std::int64_t>& indices, bool pairs, torch::Device device) const;

 private:
  struct Shard {
    TensorMap tensors;
    Tensor color, depth, focal, kind, splat, flags, order;
  };
  struct Place {
    std::size_t shard, group;
    std::int64_t row;
  };
  static Shard read(const std::filesystem::path& path);

  std::vector<Shard> shards_;
  std::vector<std::string> groups_;
  std::vector<Place> places_;
  struct Members {
    std::vector<std::int64_t> places;
    std::int64_t size() const { return static_cast<std::int64_t>(places.size()); }
  };
  std::vector<Members> members_;
  std::int64_t side_ = 0;
};

/// @brief Changes color and depth (and nothing else) of a batch, each example by itself.
void augment(Batch& batch, const Augmentation& how, torch::Generator generator);

}  // namespace ps::train
