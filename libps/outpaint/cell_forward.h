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

/// @brief Keeps what later cells read of earlier ones: the inputs of all locally masked
/// convolutions.
class CellForward {
 public:
  CellForward(const models::PixelCnn& network, const Plan& plan);

  /// @brief Makes room for the cells that differ between completions. What was kept of them is
  /// lost.
  void resize(std::size_t completions);

  /// @brief Computes the shared cells, or the cells of a level for all completions.
  /// @param code  (cell, completion) -> the code there, for all cells that the group sees
  /// @return logits of the group's missing cells, [cells][completions or 1, if shared][codes],
  /// until the
  ///         next call
  nn::TensorView run(const Group& group, bool shared,
                     const std::function<std::int32_t(int cell, std::size_t completion)>& code);

  std::size_t bytes() const;
  /// @return bytes for each cell and completion
  std::size_t bytes_each() const;

 private:
  /// The input of one locally masked convolution, for all cells.
  struct Store {
    int channels = 0;
    std::vector<float> shared;   ///< [cells][channels]
    std::vector<float> varying;  ///< [cells][completions][channels]
  };
  struct Step;

  const float* kept(const Store& store, int cell, std::size_t completion) const;

  const models::PixelCnn& network_;
  const Plan& plan_;
  std::vector<Store> stores_;  ///< in the order in which a forward needs them
  std::size_t completions_ = 0;
  nn::Workspace workspace_;
};

}  // namespace ps::outpaint
