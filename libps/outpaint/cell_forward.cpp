// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/cell_forward.h"

#include <algorithm>

#include "libps/core/parallel.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/indirect_product.h"
#include "libps/nn/norm.h"

namespace ps::outpaint {
namespace {

constexpr int kTaps = 9;

/// Calls visit(channels) for the input of every locally masked convolution behind the first, in
/// order.
template <class Visit>
void for_each_input(const models::PixelCnn& network, const Visit& visit) {
  const int f = network.channels();
  for (const auto* half : {&network.up(), &network.down()}) {
    for (const models::GatedStage& stage : *half) {
      for (std::size_t i = 0; i < stage.blocks.size(); ++i) {
        visit(2 * f);
        visit(2 * f);
      }
      if (stage.dilated) visit(f);
    }
  }
}

}  // namespace

/// One run over a group: what its layers share.
struct CellForward::Step {
  const CellForward& owner;
  const Group& group;
  Lane& lane;
  std::size_t next_store = 0;
  nn::TensorView x = {}, spare = {};
  std::vector<nn::TensorView> skips = {};  ///< concat_elu of what the up half pushed

  std::size_t rows() const { return group.cells.size() * lane.completions; }
  nn::TensorView take(int channels) const {
    return lane.workspace.take({1, 1, static_cast<int>(rows()), channels});
  }

  /// Where a place's rows begin in a store.
  static float* at(const Lane& lane, const Store& store, std::size_t place) {
    return lane.values.get() +
           (store.before * lane.places + place * store.channels) * lane.completions;
  }

  /// Where the group's rows are kept in the next store.
  nn::TensorView keep(const Store** store) {
    *store = &owner.stores_[next_store++];
    const auto channels = static_cast<int>((*store)->channels);
    return {at(lane, **store, group.first),
            {1, 1, static_cast<int>(rows()), channels},
            (*store)->channels};
  }

  /// The rows that a tap of a cell reads: one for all completions, or one for each.
  struct Source {
    const float* begin = nullptr;  ///< null = nothing
    std::size_t step = 0;
  };
  Source source(const Store& store, int cell) const {
    if (cell < 0) return {};
    const auto index = static_cast<std::size_t>(cell);
    const auto place = static_cast<std::size_t>(owner.plan_.place[index]);
    if (owner.plan_.is_shared[index]) return {at(owner.shared_, store, place), 0};
    return {at(lane, store, place), store.channels};
  }

  void convolve(const nn::MaskedConvolution& convolution, const Store& store,
                const std::vector<int>& seen, const nn::TensorView& out) const {
    nn::IndirectRows product;
    product.count = rows();
    product.taps = kTaps;
    product.sources = [&](std::size_t begin, std::size_t end, const float** pointers) {
      for (std::size_t row = begin; row < end;) {
        const std::size_t cell = row / lane.completions, first = row;
        const std::size_t last = std::min(end, (cell + 1) * lane.completions);
        for (int tap = 0; tap < kTaps; ++tap) {
          const Source from = source(store, seen[cell * kTaps + static_cast<std::size_t>(tap)]);
          const float* next = from.begin + (first - cell * lane.completions) * from.step;
          for (row = first; row < last; ++row, next += from.step) {
            pointers[nn::slot_of(row - begin, tap, kTaps)] = from.begin ? next : nullptr;
          }
        }
      }
    };
    nn::Epilogue epilogue;
    epilogue.bias = convolution.bias().data();
    nn::indirect_product(convolution.matrix(), product, out, epilogue);
  }

  void first(const Code& code) const {
    const models::CodeConvolution& layer = owner.network_.first();
    const auto channels = static_cast<std::size_t>(layer.out_channels());
    parallel_chunks(rows(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const int* cells = group.near.data() + row / lane.completions * kTaps;
        float* to = x.pixel(row);
        std::copy(layer.bias().begin(), layer.bias().end(), to);
        for (int tap = 0; tap < kTaps; ++tap) {
          if (tap == kTaps / 2 || cells[tap] < 0) continue;
          const float* add = layer.row(tap, code(cells[tap], row % lane.completions));
          for (std::size_t i = 0; i < channels; ++i) to[i] += add[i];
        }
      }
    });
    nn::positional_norm(x, x);
  }

  /// @param store  keeps concat_elu of x
  /// @param skip   concat_elu of the other input, or null
  void block(const models::GatedBlock& layers, const Store& store, const nn::TensorView* skip) {
    const nn::Workspace::Scope scope(lane.workspace);
    const int f = x.shape.channels;
    const nn::TensorView h = take(f), gates = take(2 * f), value = gates.channels(0, f);
    convolve(layers.input, store, group.near, h);
    nn::positional_norm(h, h);
    if (skip) {
      nn::Epilogue add;
      add.residual = &h;
      (*layers.skip)(*skip, h, add);
    }
    const Store* inner = nullptr;
    nn::concat_elu(h, keep(&inner));
    convolve(layers.output, *inner, group.near, gates);
    nn::positional_norm(value, value);
    nn::gated_add(x, value, gates.channels(f, f), spare);
    std::swap(x, spare);
  }

  void dilate(const nn::MaskedConvolution& layer) {
    const Store* store = nullptr;
    const nn::TensorView kept = keep(&store);
    for (std::size_t row = 0; row < rows(); ++row) {
      std::copy_n(x.pixel(row), x.shape.channels, kept.pixel(row));
    }
    convolve(layer, *store, group.far, spare);
    nn::positional_norm(spare, spare);
    std::swap(x, spare);
  }

  void up() {
    for (const models::GatedStage& stage : owner.network_.up()) {
      for (const models::GatedBlock& layers : stage.blocks) {
        const Store* store = nullptr;
        const nn::TensorView elu = keep(&store);
        nn::concat_elu(x, elu);
        skips.push_back(elu);
        block(layers, *store, nullptr);
      }
      if (!stage.dilated) continue;
      skips.push_back(take(2 * x.shape.channels));
      nn::concat_elu(x, skips.back());
      dilate(*stage.dilated);
    }
  }

  void down() {
    for (const models::GatedStage& stage : owner.network_.down()) {
      for (const models::GatedBlock& layers : stage.blocks) {
        const Store* store = nullptr;
        nn::concat_elu(x, keep(&store));
        const nn::TensorView skip = skips.back();
        skips.pop_back();
        block(layers, *store, &skip);
      }
      if (stage.dilated) dilate(*stage.dilated);
    }
  }
};

CellForward::CellForward(const models::PixelCnn& network, const Plan& plan)
    : network_(network), plan_(plan) {
  for_each_input(network, [&](int channels) {
    stores_.push_back({static_cast<std::size_t>(channels), channels_});
    channels_ += stores_.back().channels;
  });
}

void CellForward::resize(Lane& lane, std::size_t places, std::size_t completions) const {
  lane.places = places;
  lane.completions = completions;
  const std::size_t floats = channels_ * places * completions;
  if (lane.capacity >= floats) return;
  lane.values.reset();
  lane.values = nn::aligned_floats(floats);
  lane.capacity = floats;
}

void CellForward::resize(Lane& lane, std::size_t completions) const {
  resize(lane, plan_.lane_places, completions);
}

nn::TensorView CellForward::run_shared(const Code& code) {
  resize(shared_, plan_.shared.cells.size(), 1);
  return run(plan_.shared, shared_, code);
}

nn::TensorView CellForward::run(const Group& group, Lane& lane, const Code& code) const {
  const nn::Workspace::Scope scope(lane.workspace);
  Step step{*this, group, lane};
  const auto sampled = static_cast<int>(group.missing * lane.completions);
  const nn::TensorView logits = lane.workspace.take({1, 1, sampled, network_.codes()});
  step.x = step.take(network_.channels());
  step.spare = step.take(network_.channels());
  step.first(code);
  step.up();
  step.down();
  nn::TensorView last = step.x;
  last.shape.width = sampled;  // missing cells come first
  nn::elu(last, last);
  network_.last()(last, logits);
  return logits;
}

}  // namespace ps::outpaint
