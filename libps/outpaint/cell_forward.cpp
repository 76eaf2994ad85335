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
  CellForward& owner;
  const Group& group;
  std::size_t completions;  ///< rows of a cell
  bool shared;
  std::size_t next_store = 0;
  nn::TensorView x, spare;
  std::vector<nn::TensorView> skips;  ///< concat_elu of what the up half pushed

  std::size_t rows() const { return group.cells.size() * completions; }
  nn::TensorView take(int channels) {
    return owner.workspace_.take({1, 1, static_cast<int>(rows()), channels});
  }

  /// Where the group's rows are kept in the next store.
  nn::TensorView keep(Store** store) {
    *store = &owner.stores_[next_store++];
    const auto channels = static_cast<std::size_t>((*store)->channels);
    float* data = shared ? (*store)->shared.data() + group.first * channels
                         : (*store)->varying.data() + group.first * completions * channels;
    return {data, {1, 1, static_cast<int>(rows()), (*store)->channels}, channels};
  }

  void convolve(const nn::MaskedConvolution& convolution, const Store& store,
                const std::vector<int>& seen, const nn::TensorView& out) const {
    nn::IndirectRows product;
    product.count = rows();
    product.taps = kTaps;
    product.sources = [&](std::size_t begin, std::size_t end, const float** pointers) {
      for (std::size_t row = begin; row < end; ++row) {
        const int* cells = seen.data() + row / completions * kTaps;
        for (int tap = 0; tap < kTaps; ++tap) {
          pointers[nn::slot_of(row - begin, tap, kTaps)] =
              cells[tap] < 0 ? nullptr : owner.kept(store, cells[tap], row % completions);
        }
      }
    };
    nn::Epilogue epilogue;
    epilogue.bias = convolution.bias().data();
    nn::indirect_product(convolution.matrix(), product, out, epilogue);
  }

  void first(const std::function<std::int32_t(int, std::size_t)>& code) const {
    const models::CodeConvolution& layer = owner.network_.first();
    const auto channels = static_cast<std::size_t>(layer.out_channels());
    parallel_chunks(rows(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const int* cells = group.near.data() + row / completions * kTaps;
        float* to = x.pixel(row);
        std::copy(layer.bias().begin(), layer.bias().end(), to);
        for (int tap = 0; tap < kTaps; ++tap) {
          if (tap == kTaps / 2 || cells[tap] < 0) continue;
          const float* add = layer.row(tap, code(cells[tap], row % completions));
          for (std::size_t i = 0; i < channels; ++i) to[i] += add[i];
        }
      }
    });
    nn::positional_norm(x, x);
  }

  /// @param elu   concat_elu of x, kept in `store`
  /// @param skip  concat_elu of the other input, or null
  void block(const models::GatedBlock& layers, const Store& store, const nn::TensorView* skip) {
    const nn::Workspace::Scope scope(owner.workspace_);
    const int f = x.shape.channels;
    const nn::TensorView h = take(f), gates = take(2 * f), value = gates.channels(0, f);
    convolve(layers.input, store, group.near, h);
    nn::positional_norm(h, h);
    if (skip) {
      nn::Epilogue add;
      add.residual = &h;
      (*layers.skip)(*skip, h, add);
    }
    Store* inner = nullptr;
    nn::concat_elu(h, keep(&inner));
    convolve(layers.output, *inner, group.near, gates);
    nn::positional_norm(value, value);
    nn::gated_add(x, value, gates.channels(f, f), spare);
    std::swap(x, spare);
  }

  void dilate(const nn::MaskedConvolution& layer) {
    Store* store = nullptr;
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
        Store* store = nullptr;
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
        Store* store = nullptr;
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
    stores_.push_back({channels, {}, {}});
    stores_.back().shared.resize(plan.shared.cells.size() * static_cast<std::size_t>(channels));
  });
}

void CellForward::resize(std::size_t completions) {
  completions_ = completions;
  for (Store& store : stores_) {
    const std::size_t count =
        plan_.varying * completions * static_cast<std::size_t>(store.channels);
    if (store.varying.size() < count) store.varying.resize(count);
  }
}

const float* CellForward::kept(const Store& store, int cell, std::size_t completion) const {
  const auto at = static_cast<std::size_t>(cell);
  const auto place = static_cast<std::size_t>(plan_.place[at]);
  const auto channels = static_cast<std::size_t>(store.channels);
  if (plan_.is_shared[at]) return store.shared.data() + place * channels;
  return store.varying.data() + (place * completions_ + completion) * channels;
}

nn::TensorView CellForward::run(
    const Group& group, bool shared,
    const std::function<std::int32_t(int cell, std::size_t completion)>& code) {
  const nn::Workspace::Scope scope(workspace_);
  Step step{*this, group, shared ? 1 : completions_, shared, 0, {}, {}, {}};
  const std::size_t sampled = group.missing * step.completions;
  const nn::TensorView logits =
      workspace_.take({1, 1, static_cast<int>(sampled), network_.codes()});
  step.x = step.take(network_.channels());
  step.spare = step.take(network_.channels());
  step.first(code);
  step.up();
  step.down();
  nn::TensorView last = step.x;
  last.shape.width = static_cast<int>(sampled);  // missing cells come first
  nn::elu(last, last);
  network_.last()(last, logits);
  return logits;
}

std::size_t CellForward::bytes_each() const {
  std::size_t floats = 0;
  for (const Store& store : stores_) floats += static_cast<std::size_t>(store.channels);
  return floats * sizeof(float);
}

std::size_t CellForward::bytes() const {
  std::size_t floats = 0;
  for (const Store& store : stores_) floats += store.shared.size() + store.varying.size();
  return floats * sizeof(float) + workspace_.bytes();
}

}  // namespace ps::outpaint
