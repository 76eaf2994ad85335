// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "libps/train/shard_tensors.h"

namespace ps::train {

/// @brief Examples; each tensor's first axis is the batch.
struct Batch {
  Tensor color;    ///< [n, 3, s, s] RGB in [-1,1]
  Tensor depth;    ///< [n, 1, s, s] canonical metres (shard.h); 0 = unknown
  Tensor kind;     ///< [n] int64, of room; -1 = unknown
  Tensor splat;    ///< [n, 3, s, s] RGB in [-1,1]: the partner, lifted and splatted into this view
  Tensor hit;      ///< [n, 1, s, s] 1 where a point of the partner falls
  Tensor missing;  ///< [n, 1, s, s] 1 where outpainting is wanted (dilated)
  Tensor order;    ///< [n, cells] int64: cells from first to last
  Tensor unseen;   ///< [n, cells] 1 = a cell to be sampled
  Tensor group;    ///< [n] int64: index into Dataset::groups()

  Tensor plain;              ///< [n, 3, s, s] color as the camera saw it
  Tensor partner;            ///< [n, 3, s, s] RGB in [-1,1]: the other view of the pair
  Tensor lens;               ///< [n, 4] fx (below 0 = mirrored), fy, cx, cy in pixels
  Tensor partner_lens;       ///< [n, 4]
  Tensor partner_from_view;  ///< [n, 3, 4] R | t, metres
  Tensor posed;              ///< [n] 1 = lenses and poses are known
};

/// What a stage wants of examples beside color, depth, kind and group.
struct Wanted {
  bool splats = false;    ///< examples are second views; with splat, hit, missing, order and unseen
  bool partners = false;  ///< with plain, partner, lenses and poses
  bool depth = false;     ///< of no use where depth is unknown
};

/// @brief Examples of a folder of shards (shard.h): GROUP-NUMBER.safetensors. They are
/// mapped: nobody may make them shorter meanwhile.
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
  /// @param most_turn radians: only pairs whose views are turned by no more, or the least turned
  std::vector<std::int64_t> draw(std::int64_t count, const std::vector<double>& shares,
                                 bool targets, torch::Generator generator,
                                 double most_turn = kAnyTurn) const;
  static constexpr double kAnyTurn = 1e9;
  /// @return radians between the views of the pair that is turned most; 0 when no pose is known
  double most_turn() const;
  /// @return the first `count` of a group, evenly spread over it
  std::vector<std::int64_t> spread(std::size_t group, std::int64_t count, bool targets) const;

  /// @return whether the poses of any pairs are known
  bool posed() const;

  /// @param wanted  with splats, every index is a second view
  Batch batch(const std::vector<std::int64_t>& indices, const Wanted& wanted,
              torch::Device device) const;

 private:
  struct Place {
    std::size_t shard, group;
    std::int64_t row;
  };

  void add_splats(Batch& batch, const std::vector<std::int64_t>& indices,
                  torch::Device device) const;
  void add_partners(Batch& batch, const std::vector<std::int64_t>& indices,
                    torch::Device device) const;

  std::vector<ShardTensors> shards_;
  std::vector<std::string> groups_;
  std::vector<Place> places_;
  struct Turned {
    double turn;          ///< radians; 0 when unknown
    std::int64_t second;  ///< place of the pair's second view; the first is before it
  };
  struct Members {
    std::vector<std::int64_t> places;
    std::vector<Turned> by_turn;  ///< its pairs, the least turned first
    std::int64_t size() const { return static_cast<std::int64_t>(places.size()); }
    std::int64_t pick(double unit, bool targets, double most_turn) const;
  };
  std::vector<Members> members_;
  std::int64_t side_ = 0;
};

}  // namespace ps::train
