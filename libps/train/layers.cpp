// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/layers.h"

#include <cmath>

#include "libps/train/narrow.h"

namespace ps::train {
namespace {

thread_local bool narrow_products = false;

Tensor wide(const Tensor& x) { return x.to(torch::kFloat32); }

}  // namespace

NarrowProducts::NarrowProducts(bool narrow) : before_(narrow_products) { narrow_products = narrow; }

NarrowProducts::~NarrowProducts() { narrow_products = before_; }

bool products_are_narrow() { return narrow_products; }

Tensor as_factor(const Tensor& x) {
  return narrow_products && x.defined() ? x.to(torch::kBFloat16) : x;
}

Tensor conv2d(const Tensor& x, const Tensor& weight, const Tensor& bias, int stride, int padding) {
  return wide(torch::conv2d(as_factor(x), as_factor(weight), as_factor(bias), stride, padding));
}

void add_convolution(Parameters& p, const std::string& name, int in, int out, int kernel,
                     double gain, bool bias) {
  p.normal(name + ".weight", {out, in, kernel, kernel},
           gain * std::sqrt(2.0 / (in * kernel * kernel)));
  if (bias) p.constant(name + ".bias", {out}, 0);
}

void add_transposed(Parameters& p, const std::string& name, int in, int out, double gain) {
  // Of 4x4 taps at stride 2, four meet in a pixel.
  p.normal(name + ".weight", {in, out, 4, 4}, gain * std::sqrt(2.0 / (in * 4)));
  p.constant(name + ".bias", {out}, 0);
}

void add_batch_norm(Parameters& p, const std::string& name, int channels) {
  p.constant(name + ".weight", {channels}, 1);
  p.constant(name + ".bias", {channels}, 0);
  p.state(name + ".running_mean", torch::zeros({channels}));
  p.state(name + ".running_var", torch::ones({channels}));
}

void add_normed(Parameters& p, const std::string& name, int in, int out) {
  p.normal(name + ".weight_v", {out, in}, 1);
  p.constant(name + ".weight_g", {out, 1}, 1);
  p.constant(name + ".bias", {out}, 0);
}

Tensor convolution(const Parameters& p, const std::string& name, const Tensor& x, int stride,
                   int padding) {
  const auto bias = p.trained().find(name + ".bias");
  return conv2d(x, p[name + ".weight"], bias == p.trained().end() ? Tensor() : bias->second, stride,
                padding);
}

Tensor transposed(const Parameters& p, const std::string& name, const Tensor& x) {
  const Tensor &weight = p[name + ".weight"], &bias = p[name + ".bias"];
  if (!narrow_products) return torch::conv_transpose2d(x, weight, bias, 2, 1);
  // libtorch 1.13 refuses transposed convolutions of bfloat16. Each of the four pixels that a pixel
  // becomes is a 3x3 convolution of it, of which 2x2 taps are not 0: the even ones of each axis see
  // taps 3 and 1 of the four, the odd ones 2 and 0.
  constexpr std::int64_t kNone = 4;
  const Tensor taps = torch::tensor({std::int64_t{3}, std::int64_t{1}, kNone, kNone,
                                     std::int64_t{2}, std::int64_t{0}})
                          .to(x.device());
  const std::int64_t in = weight.size(0), out = weight.size(1);
  const Tensor phases = torch::constant_pad_nd(weight, {0, 1, 0, 1})
                            .index_select(2, taps)
                            .index_select(3, taps)
                            .view({in, out, 2, 3, 2, 3})
                            .permute({1, 2, 4, 0, 3, 5})
                            .reshape({4 * out, in, 3, 3});
  const Tensor pixels =
      torch::conv2d(as_factor(x), as_factor(phases), as_factor(bias.repeat_interleave(4)), 1, 1);
  return wide(torch::pixel_shuffle(pixels, 2));
}

Tensor batch_norm(const Parameters& p, const std::string& name, const Tensor& x, bool training) {
  return torch::batch_norm(x, p[name + ".weight"], p[name + ".bias"], p[name + ".running_mean"],
                           p[name + ".running_var"], training, 0.1, 1e-5, false);
}

}  // namespace ps::train
