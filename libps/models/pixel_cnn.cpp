// SPDX-License-Identifier: BSD-3-Clause
#include "libps/models/pixel_cnn.h"

#include <algorithm>
#include <array>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/models/layers.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/norm.h"

namespace ps::models {
namespace {

constexpr char kName[] = "PixelCnn";
constexpr int kTaps = 9;
constexpr std::array<int, 3> kUpBlocks = {2, 2, 2};
constexpr std::array<int, 3> kDownBlocks = {2, 3, 3};
constexpr std::size_t kSkips = 8;  ///< as many as the down half has blocks

nn::MaskedConvolution masked(const Layers& layers, const std::string& name, int in, int out,
                             int dilation, nn::Storage storage) {
  return {layers.weight(name, {out, in, 3, 3}), layers.vector(name + ".bias", out), dilation,
          storage};
}

CodeConvolution read_first(const Layers& layers) {
  const nn::WeightTensor weight = layers.weight("u_init", {0, 0, 3, 3});
  return {weight, layers.vector("u_init.bias", static_cast<int>(weight.shape[0]))};
}

std::vector<GatedStage> read_stages(const Layers& layers, bool down, int f, nn::Storage storage) {
  std::vector<GatedStage> stages;
  const std::string half = down ? "down_layers." : "up_layers.";
  const std::string between = down ? "upsize_u_stream." : "downsize_u_stream.";
  const std::array<int, 3>& counts = down ? kDownBlocks : kUpBlocks;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    GatedStage stage;
    for (int b = 0; b < counts[s]; ++b) {
      const std::string name = half + std::to_string(s) + ".u_stream." + std::to_string(b) + ".";
      std::optional<nn::Linear> skip;
      if (down) skip = layers.linear(name + "nin_skip.lin_a", 2 * f, f);
      stage.blocks.push_back({masked(layers, name + "conv_input", 2 * f, f, 1, storage),
                              std::move(skip),
                              masked(layers, name + "conv_out", 2 * f, 2 * f, 1, storage)});
    }
    if (s + 1 < counts.size()) {
      stage.dilated = masked(layers, between + std::to_string(s), f, f, 2, storage);
    }
    stages.push_back(std::move(stage));
  }
  return stages;
}

void check_input(const std::int32_t* codes, int count, const LocalMasks& masks,
                 const nn::Shape& shape) {
  const std::size_t cells =
      shape.images > 0 ? shape.pixels() / static_cast<std::size_t>(shape.images) : 0;
  for (const auto* mask : {&masks.first, &masks.later, &masks.dilated}) {
    if (mask->size() != kTaps * cells) {
      throw Error(kName, "a mask has " + std::to_string(mask->size()) + " values",
                  std::to_string(kTaps * cells) + ": 9 for each cell");
    }
  }
  for (std::size_t i = 0; i < shape.pixels(); ++i) {
    if (codes[i] >= count) {
      throw Error(kName, "code " + std::to_string(i) + " is " + std::to_string(codes[i]),
                  "codes below " + std::to_string(count) + ", negative where not yet sampled");
    }
  }
}

/// One forward: what its steps share.
struct Pass {
  const LocalMasks& masks;
  nn::Workspace& workspace;
  nn::TensorView x;                          ///< the last step's output, f channels
  nn::TensorView spare;                      ///< where the next one's goes
  std::array<nn::TensorView, kSkips> skips;  ///< concat_elu of what the up half pushed
  std::size_t pushed = 0;

  nn::TensorView take(int channels) {
    nn::Shape shape = x.shape;
    shape.channels = channels;
    return workspace.take(shape);
  }

  /// @param elu  concat_elu of x   @param skip  concat_elu of the other input, or null
  void run(const GatedBlock& block, const nn::TensorView& elu, const nn::TensorView* skip) {
    const nn::Workspace::Scope scope(workspace);
    const int f = x.shape.channels;
    const nn::TensorView h = take(f), h_elu = take(2 * f), gates = take(2 * f);
    block.input(elu, masks.later.data(), h);
    nn::positional_norm(h, h);
    if (skip != nullptr) {
      nn::Epilogue add;
      add.residual = &h;
      (*block.skip)(*skip, h, add);
    }
    nn::concat_elu(h, h_elu);
    block.output(h_elu, masks.later.data(), gates);
    const nn::TensorView value = gates.channels(0, f);
    nn::positional_norm(value, value);
    nn::gated_add(x, value, gates.channels(f, f), spare);
    std::swap(x, spare);
  }

  void run(const nn::MaskedConvolution& dilated) {
    dilated(x, masks.dilated.data(), spare);
    nn::positional_norm(spare, spare);
    std::swap(x, spare);
  }

  /// The last output of the up half is where the down half begins; it is no skip.
  void push() {
    if (pushed == kSkips) return;
    skips[pushed] = take(2 * x.shape.channels);
    nn::concat_elu(x, skips[pushed++]);
  }
};

void run_up(const std::vector<GatedStage>& stages, Pass& pass) {
  pass.push();
  for (const GatedStage& stage : stages) {
    for (const GatedBlock& block : stage.blocks) {
      pass.run(block, pass.skips[pass.pushed - 1], nullptr);
      pass.push();
    }
    if (stage.dilated) {
      pass.run(*stage.dilated);
      pass.push();
    }
  }
}

void run_down(const std::vector<GatedStage>& stages, Pass& pass) {
  const nn::TensorView elu = pass.take(2 * pass.x.shape.channels);
  for (const GatedStage& stage : stages) {
    for (const GatedBlock& block : stage.blocks) {
      nn::concat_elu(pass.x, elu);
      pass.run(block, elu, &pass.skips[--pass.pushed]);
    }
    if (stage.dilated) pass.run(*stage.dilated);
  }
}

}  // namespace

CodeConvolution::CodeConvolution(const nn::WeightTensor& weight, std::vector<float> bias)
    : codes_(static_cast<int>(weight.shape[1]) - 1), bias_(std::move(bias)) {
  const std::size_t out = bias_.size(), in = rows();
  rows_.resize(kTaps * in * out);
  const auto value = [&](std::size_t o, std::size_t i, std::size_t t) {
    return weight.values[(o * in + i) * kTaps + t];
  };
  for (std::size_t t = 0; t < kTaps; ++t) {
    for (std::size_t i = 0; i < in; ++i) {
      for (std::size_t o = 0; o < out; ++o) {
        const float ones = value(o, in - 1, t);
        rows_[(t * in + i) * out + o] = i + 1 < in ? value(o, i, t) + ones : ones;
      }
    }
  }
}

void CodeConvolution::operator()(const std::int32_t* codes, const std::uint8_t* mask,
                                 const nn::TensorView& out) const {
  const int height = out.shape.height, width = out.shape.width;
  const std::size_t cells = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  const auto one = [&](std::size_t at) {
    const std::size_t cell = at % cells, image = at - cell;
    const int y = static_cast<int>(cell) / width, x = static_cast<int>(cell) % width;
    float* to = out.pixel(at);
    std::copy(bias_.begin(), bias_.end(), to);
    for (int t = 0; t < kTaps; ++t) {
      const int from_y = y + t / 3 - 1, from_x = x + t % 3 - 1;
      if (mask[static_cast<std::size_t>(t) * cells + cell] == 0 || from_y < 0 || from_y >= height ||
          from_x < 0 || from_x >= width) {
        continue;
      }
      const float* add = row(t, codes[image + static_cast<std::size_t>(from_y * width + from_x)]);
      for (std::size_t o = 0; o < bias_.size(); ++o) to[o] += add[o];
    }
  };
  parallel_chunks(out.shape.pixels(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at) one(at);
  });
}

PixelCnn::PixelCnn(const nn::Weights& weights, const ModelOptions& options)
    : PixelCnn(Layers(weights, "outpaint2.", options), options.storage) {}

PixelCnn::PixelCnn(const Layers& layers, nn::Storage storage)
    : first_(read_first(layers)),
      up_(read_stages(layers, false, channels(), storage)),
      down_(read_stages(layers, true, channels(), storage)),
      last_(layers.linear("nin_out.lin_a", channels(), codes())) {}

void PixelCnn::forward(const std::int32_t* codes, const LocalMasks& masks,
                       const nn::TensorView& logits, nn::Workspace& workspace) const {
  nn::Shape shape = logits.shape;
  shape.channels = this->codes();
  check_shape(kName, "logits", logits, shape);
  check_input(codes, this->codes(), masks, shape);
  const nn::Workspace::Scope scope(workspace);
  shape.channels = channels();
  Pass pass{masks, workspace, workspace.take(shape), workspace.take(shape), {}, 0};
  first_(codes, masks.first.data(), pass.x);
  nn::positional_norm(pass.x, pass.x);
  run_up(up_, pass);
  run_down(down_, pass);
  nn::elu(pass.x, pass.x);
  last_(pass.x, logits);
}

}  // namespace ps::models
