// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/pixel_cnn.h"

#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "libps/train/elu_taps.h"
#include "libps/train/layers.h"
#include "libps/train/narrow.h"

namespace ps::train {
namespace {

constexpr std::array<std::array<int, 3>, 2> kBlocks = {{{2, 2, 2}, {2, 3, 3}}};

/// Rows [r, in] times a matrix [out, in], as a 1x1 convolution: it stays in oneDNN's threads, where
/// a matrix product would wake the BLAS's own. Rows are laid out as wide pictures, as oneDNN takes
/// pixels of a row together.
Tensor rows_times(const Tensor& x, const Tensor& weight, const Tensor& bias) {
  const std::int64_t width = std::gcd(x.size(0), std::int64_t{128});
  const Tensor pixels = x.view({1, x.size(0) / width, width, x.size(1)}).permute({0, 3, 1, 2});
  const Tensor out = torch::conv2d(pixels, weight.view({weight.size(0), -1, 1, 1}), bias);
  return out.permute({0, 2, 3, 1}).reshape({x.size(0), weight.size(0)});
}

/// rows_times() of narrow factors. Gradients are products of the same kinds, and a matrix product,
/// which libtorch leaves to oneDNN where it is narrow; a 1x1 convolution's own gradients take
/// twice as long there.
class NarrowProduct : public torch::autograd::Function<NarrowProduct> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& x,
                        const Tensor& weight, const Tensor& bias) {
    const Tensor narrow = weight.to(torch::kBFloat16);
    context->save_for_backward({x, narrow});
    return rows_times(x, narrow, bias.to(torch::kBFloat16)).to(torch::kFloat32);
  }
  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const auto saved = context->get_saved_variables();
    const Tensor &x = saved[0], &weight = saved[1];
    const Tensor gradient = gradients[0].to(torch::kBFloat16).contiguous();
    const Tensor by_x = rows_times(gradient, weight.t().contiguous(), {});
    return {by_x, torch::mm(gradient.t(), x).to(torch::kFloat32), gradients[0].sum(0)};
  }
};

Tensor product(const Tensor& x, const Tensor& weight, const Tensor& bias) {
  if (!products_are_narrow()) return rows_times(x, weight, bias);
  const Tensor narrow = as_factor(x).contiguous();
  if (x.is_cpu()) return NarrowProduct::apply(narrow, weight, bias);
  return rows_times(narrow, as_factor(weight), as_factor(bias)).to(torch::kFloat32);
}

/// @param read  what its taps read of each cell
Tensor masked_convolution(const Parameters& p, const std::string& name, const Tensor& read) {
  const Tensor& weight = p[name + ".weight"];
  const Tensor by_tap = weight.permute({0, 2, 3, 1}).reshape({weight.size(0), -1});
  return product(read, by_tap, p[name + ".bias"]);
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

std::string block_name(int half, int stage, int block) {
  return std::string(half == 1 ? "down" : "up") + "_layers." + std::to_string(stage) +
         ".u_stream." + std::to_string(block) + ".";
}

std::string dilated_name(int half, int stage) {
  return std::string(half == 1 ? "upsize" : "downsize") + "_u_stream." + std::to_string(stage);
}

Tensor gated_block(const Parameters& p, const std::string& name, const Tensor& x,
                   const Tensor* skip, const TapIndex& taps) {
  Tensor h =
      positional_norm(masked_convolution(p, name + "conv_input", elu_taps(x, taps.from, taps.to)));
  if (skip != nullptr) h = h + normed_rows(p, name + "nin_skip.lin_a", concat_elu(*skip));
  const auto gates =
      masked_convolution(p, name + "conv_out", elu_taps(h, taps.from, taps.to)).chunk(2, 1);
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
      x = positional_norm(
          masked_convolution(p, dilated_name(half, s), gathered_taps(x, dilated.from, dilated.to)));
      if (half == 0) pushed.push_back(x);
    }
    if (half == 0) pushed.pop_back();  // the last one is where the down half begins
  }
  return normed_rows(p, "nin_out.lin_a", torch::elu(x));
}

}  // namespace ps::train
