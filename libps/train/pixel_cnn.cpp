// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/pixel_cnn.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "libps/train/layers.h"

namespace ps::train {
namespace {

constexpr int kTaps = 9;
constexpr std::array<std::array<int, 3>, 2> kBlocks = {{{2, 2, 2}, {2, 3, 3}}};

/// Rows of x by number; zeros where the number is negative.
Tensor rows_of(const Tensor& x, const Tensor& index) {
  if (!x.is_cpu()) {
    const Tensor rows = x.index_select(0, index.clamp_min(0));
    return rows.masked_fill_((index < 0).unsqueeze(1), 0);
  }
  const Tensor out = torch::empty({index.size(0), x.size(1)}, x.options());
  const auto* const from = static_cast<const char*>(x.data_ptr());
  auto* const to = static_cast<char*>(out.data_ptr());
  const std::int64_t* const rows = index.data_ptr<std::int64_t>();
  const std::int64_t bytes = x.size(1) * static_cast<std::int64_t>(x.element_size());
  at::parallel_for(0, index.size(0), 2048, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      char* const row = to + i * bytes;
      if (rows[i] < 0) {
        std::memset(row, 0, static_cast<std::size_t>(bytes));
      } else {
        std::memcpy(row, from + rows[i] * bytes, static_cast<std::size_t>(bytes));
      }
    }
  });
  return out;
}

/// Of each kTaps rows by number their sum, in float; negative numbers count as zeros.
template <class T>
void sum_rows(const Tensor& x, const Tensor& index, const Tensor& sums) {
  const std::int64_t channels = x.size(1);
  const T* const from = x.data_ptr<T>();
  const std::int64_t* const rows = index.data_ptr<std::int64_t>();
  float* const to = sums.data_ptr<float>();
  at::parallel_for(0, sums.size(0), 512, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      float* const sum = to + i * channels;
      std::fill_n(sum, channels, 0.F);
      for (int tap = 0; tap < kTaps; ++tap) {
        const std::int64_t row = rows[i * kTaps + tap];
        if (row < 0) continue;
        const T* const summand = from + row * channels;
        for (std::int64_t c = 0; c < channels; ++c) sum[c] += static_cast<float>(summand[c]);
      }
    }
  });
}

Tensor summed_rows(const Tensor& x, const Tensor& index) {
  const std::int64_t cells = index.size(0) / kTaps, channels = x.size(1);
  if (!x.is_cpu()) {
    return rows_of(x, index).view({cells, kTaps, channels}).sum(1, false, torch::kFloat32);
  }
  const Tensor sums = torch::empty({cells, channels}, x.options().dtype(torch::kFloat32));
  if (x.scalar_type() == torch::kBFloat16) {
    sum_rows<at::BFloat16>(x, index, sums);
  } else {
    sum_rows<float>(x, index, sums);
  }
  return sums;
}

/// What the visible taps of each cell read, side by side: [rows, c] -> [rows, 9 c], already as
/// narrow as the product wants it, which halves the memory that it goes through. Its gradient is
/// gathered too: each cell is read through a tap by one cell at most.
class GatherTaps : public torch::autograd::Function<GatherTaps> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& x,
                        const Tensor& from, const Tensor& to) {
    context->save_for_backward({to});
    return rows_of(as_factor(x).contiguous(), from).view({x.size(0), kTaps * x.size(1)});
  }
  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const Tensor to = context->get_saved_variables()[0];
    const Tensor gradient = gradients[0].contiguous();
    return {summed_rows(gradient.view({-1, gradient.size(1) / kTaps}), to), Tensor(), Tensor()};
  }
};

/// Rows [r, in] times a matrix [out, in], as a 1x1 convolution: it stays in oneDNN's threads, where
/// a matrix product would wake the BLAS's own.
Tensor product(const Tensor& x, const Tensor& weight, const Tensor& bias) {
  const Tensor pixels = x.view({1, x.size(0), 1, x.size(1)}).permute({0, 3, 1, 2});
  const Tensor out = conv2d(pixels, weight.view({weight.size(0), weight.size(1), 1, 1}), bias);
  return out.permute({0, 2, 3, 1}).reshape({x.size(0), weight.size(0)});
}

Tensor masked_convolution(const Parameters& p, const std::string& name, const Tensor& x,
                          const TapIndex& taps) {
  const Tensor& weight = p[name + ".weight"];
  const Tensor by_tap = weight.permute({0, 2, 3, 1}).reshape({weight.size(0), -1});
  return product(GatherTaps::apply(x, taps.from, taps.to), by_tap, p[name + ".bias"]);
}

Tensor normed_rows(const Parameters& p, const std::string& name, const Tensor& x) {
  const Tensor& v = p[name + ".weight_v"];
  return product(x, v * (p[name + ".weight_g"] / v.norm(2, {1}, true)), p[name + ".bias"]);
}

/// (x - mean) / sqrt(var + eps) with the unbiased variance, by way of layer norm's biased one.
Tensor positional_norm(const Tensor& x) {
  constexpr double kEps = 1e-5;
  const auto c = static_cast<double>(x.size(1)), ratio = (c - 1) / c;
  return torch::layer_norm(x, {x.size(1)}, {}, {}, kEps * ratio) * std::sqrt(ratio);
}

Tensor concat_elu(const Tensor& x) { return torch::elu(torch::cat({x, -x}, 1)); }

std::string block_name(int half, int stage, int block) {
  return std::string(half == 1 ? "down" : "up") + "_layers." + std::to_string(stage) +
         ".u_stream." + std::to_string(block) + ".";
}

std::string dilated_name(int half, int stage) {
  return std::string(half == 1 ? "upsize" : "downsize") + "_u_stream." + std::to_string(stage);
}

Tensor gated_block(const Parameters& p, const std::string& name, const Tensor& x,
                   const Tensor* skip, const TapIndex& taps) {
  Tensor h = positional_norm(masked_convolution(p, name + "conv_input", concat_elu(x), taps));
  if (skip != nullptr) h = h + normed_rows(p, name + "nin_skip.lin_a", concat_elu(*skip));
  const auto gates = masked_convolution(p, name + "conv_out", concat_elu(h), taps).chunk(2, 1);
  return x + positional_norm(gates[0].contiguous()) * torch::sigmoid(gates[1]);
}

/// What the first layer adds for each tap and code: rows [9 * codes, f] of weights, the ones'
/// added.
Tensor code_table(const Tensor& weight) {
  const std::int64_t codes = weight.size(1) - 1;
  const Tensor by_tap = weight.permute({2, 3, 1, 0}).reshape({kTaps, codes + 1, weight.size(0)});
  const Tensor table = by_tap.narrow(1, 0, codes) + by_tap.narrow(1, codes, 1);
  return torch::cat(
      {table.reshape({kTaps * codes, -1}), torch::zeros({1, weight.size(0)}, weight.options())});
}

}  // namespace

TapIndex tap_index(const Tensor& order, int height, int width, int dilation, bool centre) {
  const std::int64_t n = order.size(0), cells = order.size(1);
  const auto longs = order.options();
  const Tensor places = torch::arange(cells, longs).expand({n, cells});
  const Tensor rank = torch::zeros_like(order).scatter(1, order, places);
  const Tensor cell = torch::arange(cells, longs),
               base = torch::arange(n, longs).unsqueeze(1) * cells;
  const Tensor y = torch::div(cell, width, "floor"), x = cell - y * width;
  // The cell itself passes as "not later", the others by rank.
  const auto visible = [&](const Tensor& reader, const Tensor& read, const Tensor& inside,
                           int tap) {
    if (tap == kTaps / 2) return torch::full({n, cells}, centre, torch::kBool).to(order.device());
    const Tensor earlier =
        rank.gather(1, read.expand({n, cells})) < rank.gather(1, reader.expand({n, cells}));
    return earlier.logical_and(inside);
  };
  std::vector<Tensor> from, to;
  for (int tap = 0; tap < kTaps; ++tap) {
    const int dy = (tap / 3 - 1) * dilation, dx = (tap % 3 - 1) * dilation;
    const auto moved = [&](int sign) {
      const Tensor my = y + sign * dy, mx = x + sign * dx;
      const Tensor inside =
          (my >= 0).logical_and(my < height).logical_and(mx >= 0).logical_and(mx < width);
      return std::make_pair((my * width + mx).masked_fill(inside.logical_not(), 0), inside);
    };
    const auto [read, reads] = moved(1);
    from.push_back((base + read).masked_fill(visible(cell, read, reads, tap).logical_not(), -1));
    const auto [reader, is_read] = moved(-1);
    to.push_back(((base + reader) * kTaps + tap)
                     .masked_fill(visible(reader, cell, is_read, tap).logical_not(), -1));
  }
  return {torch::stack(from, 2).reshape({-1}), torch::stack(to, 2).reshape({-1})};
}

PixelCnn::PixelCnn(int f, int codes, std::uint64_t seed)
    : parameters("outpaint2.", seed), codes_(codes) {
  Parameters& p = parameters;
  p.normal("u_init.weight", {f, codes + 1, 3, 3}, .3);
  // The first cell sees nothing but this. Zeros have no variance to divide by: gradients would grow
  // by 1 / sqrt(eps) in each norm.
  p.normal("u_init.bias", {f}, .3);
  for (int half = 0; half < 2; ++half) {
    const auto& counts = kBlocks[static_cast<std::size_t>(half)];
    for (int s = 0; s < 3; ++s) {
      for (int b = 0; b < counts[static_cast<std::size_t>(s)]; ++b) {
        const std::string name = block_name(half, s, b);
        add_convolution(p, name + "conv_input", 2 * f, f, 3);
        if (half == 1) add_normed(p, name + "nin_skip.lin_a", 2 * f, f);
        add_convolution(p, name + "conv_out", 2 * f, 2 * f, 3);
      }
      if (s < 2) add_convolution(p, dilated_name(half, s), f, f, 3);
    }
  }
  add_normed(p, "nin_out.lin_a", f, codes);
  // Shares, summed over steps: numbers that an f16 can hold.
  p.state("code_counts", torch::full({codes}, 1.0 / codes));
}

Tensor PixelCnn::forward(const Tensor& codes, const Tensor& order) const {
  const Parameters& p = parameters;
  const int h = static_cast<int>(codes.size(1)), w = static_cast<int>(codes.size(2));
  const TapIndex first = tap_index(order, h, w, 1, false), later = tap_index(order, h, w, 1, true),
                 dilated = tap_index(order, h, w, 2, true);
  const Tensor taps = torch::arange(kTaps, order.options()).repeat({codes.numel()});
  const Tensor read = codes.reshape({-1}).index_select(0, first.from.clamp_min(0)) + taps * codes_;
  const Tensor entry = read.masked_fill(first.from < 0, kTaps * codes_).view({-1, kTaps});
  Tensor x = torch::embedding(code_table(p["u_init.weight"]), entry).sum(1) + p["u_init.bias"];
  x = positional_norm(x);
  std::vector<Tensor> pushed = {x};
  for (int half = 0; half < 2; ++half) {
    for (int s = 0; s < 3; ++s) {
      const int count = kBlocks[static_cast<std::size_t>(half)][static_cast<std::size_t>(s)];
      for (int b = 0; b < count; ++b) {
        x = gated_block(p, block_name(half, s, b), x, half == 1 ? &pushed.back() : nullptr, later);
        if (half == 1) pushed.pop_back();
        if (half == 0) pushed.push_back(x);
      }
      if (s == 2) continue;
      x = positional_norm(masked_convolution(p, dilated_name(half, s), x, dilated));
      if (half == 0) pushed.push_back(x);
    }
    if (half == 0) pushed.pop_back();  // the last one is where the down half begins
  }
  return normed_rows(p, "nin_out.lin_a", torch::elu(x));
}

}  // namespace ps::train
