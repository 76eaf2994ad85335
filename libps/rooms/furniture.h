// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "libps/rooms/model.h"

namespace ps::rooms {

struct FurnitureStore;  // Internal: models made ready for rays.

/// @brief Models made ready to stand in rooms: search trees and picture pyramids, built once and
/// shared by all rooms and threads. Immutable; copies share.
class Furniture {
 public:
  /// Triangles without area are left out; a model that has none left is never placed.
  /// Parts of opacity under 0.5 are not drawn. An index out of range, a picture of another size
  /// than it says, uvs of another number than the positions, or a coordinate that is no finite
  /// number throws ps::Error that names the model.
  explicit Furniture(const std::vector<Model>& models);

  /// @return how many models have something to show; those too large for rooms are not placed
  std::size_t size() const;

  std::shared_ptr<const FurnitureStore> share() const { return store_; }

 private:
  std::shared_ptr<const FurnitureStore> store_;
};

}  // namespace ps::rooms
