// SPDX-License-Identifier: BSD-3-Clause
// Internal to the outpaint room: the PixelCNN's layers for some cells of some completions, whose
// neighbours were computed before.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "libps/models/pixel_cnn.h"
#include "libps/outpaint/plan.h"

namespace ps::outpaint {

/// @brief Memory of completions that advance together: what later cells read of earlier ones (the
/// inputs of all locally masked convolutions), and scratch memory.
struct Lane {
  std::size_t places = 0, completions = 0;
  nn::AlignedFloats values;  ///< [convolutions][places][completions][channels]
  std::size_t capacity = 0;  ///< floats
  nn::Workspace workspace;

  std::size_t bytes() const { return capacity * sizeof(float) + workspace.bytes(); }
};

/// @brief Computes the shared cells once, then the others level by level, in lanes.
class CellForward {
 public:
  CellForward(const models::PixelCnn& network, const Plan& plan);

  /// The code of a cell of a lane's completion.
  using Code = std::function<std::int32_t(int cell, std::size_t completion)>;

  /// @brief Computes the shared cells. Before any lane is run.
  /// @return logits of those that are missing, [cells][codes], until the next call
  nn::TensorView run_shared(const Code& code);

  /// @brief Makes room for so many completions. What was kept is lost.
  void resize(Lane& lane, std::size_t completions) const;

  /// @brief Computes the cells of a level for all completions of a lane. Lanes may run at once.
  /// @return logits of the missing cells, [cells][completions][codes], until the lane's next call
  nn::TensorView run(const Group& level, Lane& lane, const Code& code) const;

  std::size_t bytes() const { return shared_.bytes(); }
  /// @return bytes that a lane keeps for each completion
  std::size_t bytes_each() const { return plan_.lane_places * channels_ * sizeof(float); }

 private:
  /// The input of one locally masked convolution.
  struct Store {
    std::size_t channels;
    std::size_t before;  ///< channels of all stores before it
  };
  struct Step;

  void resize(Lane& lane, std::size_t places, std::size_t completions) const;

  const models::PixelCnn& network_;
  const Plan& plan_;
  std::vector<Store> stores_;  ///< in the order in which a forward needs them
  std::size_t channels_ = 0;   ///< of all stores
  Lane shared_;                ///< one completion that all others share
};

}  // namespace ps::outpaint
