// SPDX-License-Identifier: BSD-3-Clause
// Every operator against libtorch's own in double precision, over larger shapes than the slow
// references allow.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include "libps/nn/codebook.h"
#include "libps/nn/convolution.h"
#include "libps/nn/elementwise.h"
#include "libps/nn/linear.h"
#include "libps/nn/masked_convolution.h"
#include "libps/nn/norm.h"
#include "libps/nn/resample.h"
#include "libps/nn/softmax.h"
#include "libps/nn/transposed_convolution.h"
#include "tests/nn/support.h"

namespace ps::nn {
namespace {

constexpr int kCases = 12;
constexpr double kWinograd = 5e-6;

/// Of the largest value: the rounding of one chain of sums grows as the root of its length.
/// Measured: at most 6.2e-8 times it.
double chain_bound(std::size_t products) { return 1e-7 * std::sqrt(static_cast<double>(products)); }
/// @param weight  [out, ...]
double chain_bound(const WeightTensor& weight) {
  return chain_bound(weight.elements() / weight.shape[0]);
}

torch::Tensor planes(const TensorView& view) {
  const Shape& s = view.shape;
  torch::Tensor tensor = torch::empty({s.images, s.channels, s.height, s.width});
  to_planes(view, tensor.data_ptr<float>());
  return tensor.to(torch::kDouble);
}

reference::Values values(const torch::Tensor& tensor) {
  const torch::Tensor channels_last = tensor.permute({0, 2, 3, 1}).contiguous();
  const auto size = [&](int axis) { return static_cast<int>(channels_last.size(axis)); };
  reference::Values values(Shape{size(0), size(1), size(2), size(3)});
  std::copy_n(channels_last.data_ptr<double>(), values.values.size(), values.values.begin());
  return values;
}

torch::Tensor tensor(const std::vector<float>& values) {
  return torch::tensor(values).to(torch::kDouble);
}

torch::Tensor tensor(const WeightTensor& weight) {
  const std::vector<std::int64_t> shape(weight.shape.begin(), weight.shape.end());
  return tensor(weight.values).reshape(shape);
}

/// [values] as [1, values, 1, 1]
torch::Tensor by_channel(const std::vector<float>& values) {
  return tensor(values).reshape({1, -1, 1, 1});
}

Shape large_shape(Random& random) {
  return {random.images(), random.integer(2, 40), random.integer(2, 40),
          random.pick({2, 3, 17, 64, 80, 130})};
}

using Operator = std::function<void(const TensorView& in, const TensorView& out)>;
using TorchOperator = std::function<torch::Tensor(const torch::Tensor&)>;

void expect_same(const Operator& ours, const TorchOperator& theirs, double bound, float range = 3) {
  Random random(131);
  for (int i = 0; i < kCases; ++i) {
    const Slice in(large_shape(random), random.pick({0, 5}), random, -range, range);
    const reference::Values expected = values(theirs(planes(in)));
    on_every_isa([&] {
      const Slice out(expected.shape, random.pick({0, 3}));
      ours(in, out);
      EXPECT_TRUE(near(out, expected, bound)) << "from " << text(in.shape());
    });
  }
}

TEST(Torch, activations_are_the_same) {
  expect_same([](auto& in, auto& out) { activate(in, out, kRelu); },
              [](auto& x) { return torch::relu(x); }, 0);
  expect_same([](auto& in, auto& out) { activate(in, out, kLeakyRelu); },
              [](auto& x) { return torch::leaky_relu(x, 0.2); }, 1e-7);
  expect_same(
      elu, [](auto& x) { return torch::elu(x); }, 3e-7);
  expect_same(
      concat_elu,
      [](auto& x) {
        return torch::elu(torch::cat({x, -x}, 1));
      },
      3e-7);
  expect_same(
      nn::tanh, [](auto& x) { return torch::tanh(x); }, 3e-7);
  expect_same(
      sigmoid, [](auto& x) { return torch::sigmoid(x); }, 3e-7);
}

TEST(Torch, sums_and_scales_are_the_same) {
  Random random(132);
  const std::vector<float> scale = random.reals(130), shift = random.reals(130);
  expect_same(
      [&](auto& in, auto& out) { scale_shift(in, scale.data(), shift.data(), out, kLeakyRelu); },
      [&](auto& x) {
        const auto part = [&](const std::vector<float>& v) {
          return by_channel(v).slice(1, 0, x.size(1));
        };
        return torch::leaky_relu(x * part(scale) + part(shift), 0.2);
      },
      3e-7);
  expect_same([](auto& in, auto& out) { add(in, in, out, kRelu); },
              [](auto& x) { return torch::relu(x + x); }, 0);
  expect_same([](auto& in, auto& out) { gated_add(in, in, in, out); },
              [](auto& x) { return x + x * torch::sigmoid(x); }, 3e-7);
}

TEST(Torch, norms_are_the_same) {
  expect_same(
      [](auto& in, auto& out) { instance_norm(in, out); },
      [](auto& x) { return torch::instance_norm(x, {}, {}, {}, {}, true, 0.1, 1e-5, false); },
      5e-6);
  expect_same(
      positional_norm,
      [](auto& x) {
        const torch::Tensor d = x - x.mean({1}, true);
        const torch::Tensor variance = (d * d).sum({1}, true) / (x.size(1) - 1);
        return d / torch::sqrt(variance + 1e-5);
      },
      5e-6);
}

TEST(Torch, softmax_is_the_same) {
  expect_same([](auto& in, auto& out) { softmax(in, out, 0.7f); },
              [](auto& x) { return torch::softmax(x / 0.7, 1); }, 1e-6, 20);
}

TEST(Torch, resampling_is_the_same) {
  expect_same(
      upsample_bilinear_2x,
      [](auto& x) {
        const std::vector<std::int64_t> size = {2 * x.size(2), 2 * x.size(3)};
        return torch::upsample_bilinear2d(x, size, false);
      },
      5e-7);
  for (const bool count : {false, true}) {
    expect_same([&](auto& in, auto& out) { average_pool(in, out, count); },
                [&](auto& x) { return torch::avg_pool2d(x, 3, 2, 1, false, count); }, 5e-7);
  }
  for (const MaxPool& pool : {MaxPool{3, 2, 1, false}, MaxPool{3, 2, 0, true},
                              MaxPool{2, 2, 0, false}, MaxPool{2, 3, 1, true}}) {
    expect_same([&](auto& in, auto& out) { max_pool(in, out, pool); },
                [&](auto& x) {
                  return torch::max_pool2d(x, pool.kernel, pool.stride, pool.padding, 1, pool.ceil);
                },
                0);
  }
  expect_same(
      global_average,
      [](auto& x) {
        return x.mean({2, 3}, true);
      },
      5e-7);
}

void expect_same_convolution(Random& random, const ConvolutionOptions& options, int kernel,
                             const std::function<double(const WeightTensor&)>& bound) {
  const Slice in(large_shape(random), random.pick({0, 5}), random);
  const WeightTensor weight =
      random.weights({random.pick({1, 3, 32, 80, 130}), in.shape().channels, kernel, kernel});
  const std::vector<float> bias = random.reals(weight.shape[0]);
  const Convolution shape_of(weight, bias, options);
  const Shape out_shape = shape_of.output(in.shape());
  if (out_shape.pixels() == 0) return;  // torch refuses those
  const reference::Values expected = values(torch::conv2d(
      planes(in), tensor(weight), tensor(bias), options.stride, options.padding, options.dilation));
  on_every_isa([&] {
    const Slice out(out_shape, random.pick({0, 3}));
    Workspace workspace;
    Convolution(weight, bias, options)(in, out, workspace);
    EXPECT_TRUE(near(out, expected, bound(weight)))
        << "from " << text(in.shape()) << ", kernel " << kernel;
  });
}

TEST(Torch, convolutions_are_the_same) {
  Random random(133);
  for (int i = 0; i < 3 * kCases; ++i) {
    ConvolutionOptions options = {random.integer(1, 2), random.integer(0, 2), random.integer(1, 2)};
    options.method = Method::direct;
    expect_same_convolution(random, options, random.pick({1, 3, 3, 4, 7}),
                            [](const WeightTensor& weight) { return chain_bound(weight); });
  }
}

TEST(Torch, winograd_convolutions_are_the_same) {
  Random random(134);
  for (int i = 0; i < kCases; ++i) {
    ConvolutionOptions options = {1, random.integer(0, 2)};
    options.method = Method::winograd;
    expect_same_convolution(random, options, 3, [](const WeightTensor&) { return kWinograd; });
  }
}

TEST(Torch, transposed_convolutions_are_the_same) {
  Random random(135);
  for (int i = 0; i < kCases; ++i) {
    const Slice in(large_shape(random), random.pick({0, 5}), random);
    const WeightTensor weight = random.weights({in.shape().channels, random.pick({3, 64}), 4, 4});
    const std::vector<float> bias = random.reals(weight.shape[1]);
    const reference::Values expected =
        values(torch::conv_transpose2d(planes(in), tensor(weight), tensor(bias), 2, 1));
    on_every_isa([&] {
      const Slice out(expected.shape, random.pick({0, 3}));
      TransposedConvolution(weight, bias)(in, out);
      EXPECT_TRUE(near(out, expected, chain_bound(4 * weight.shape[0])))
          << "from " << text(in.shape());
    });
  }
}

/// Locally masked convolution as its authors write it: unfold, mask, multiply.
torch::Tensor masked(const torch::Tensor& x, const torch::Tensor& mask, const torch::Tensor& weight,
                     const torch::Tensor& bias, int dilation) {
  const torch::Tensor patches =
      torch::im2col(x, {3, 3}, {dilation, dilation}, {dilation, dilation}, {1, 1});
  const torch::Tensor seen =
      patches.reshape({x.size(0), x.size(1), 9, -1}) * mask.reshape({1, 1, 9, -1});
  const torch::Tensor sums = torch::matmul(weight.reshape({weight.size(0), -1}),
                                           seen.reshape({x.size(0), 9 * x.size(1), -1}));
  return sums.reshape({x.size(0), weight.size(0), x.size(2), x.size(3)}) +
         bias.reshape({1, -1, 1, 1});
}

TEST(Torch, masked_convolutions_are_the_same) {
  Random random(136);
  for (int i = 0; i < kCases; ++i) {
    const Slice in(large_shape(random), random.pick({0, 5}), random);
    const WeightTensor weight = random.weights({random.pick({3, 80}), in.shape().channels, 3, 3});
    const std::vector<float> bias = random.reals(weight.shape[0]);
    std::vector<std::uint8_t> mask;
    std::vector<float> mask_values;
    for (int k = 0; k < 9 * in.shape().height * in.shape().width; ++k) {
      mask.push_back(random.coin());
      mask_values.push_back(mask.back());
    }
    const int dilation = random.integer(1, 2);
    const reference::Values expected =
        values(masked(planes(in), tensor(mask_values), tensor(weight), tensor(bias), dilation));
    on_every_isa([&] {
      const Slice out(expected.shape, random.pick({0, 3}));
      MaskedConvolution(weight, bias, dilation)(in, mask.data(), out);
      EXPECT_TRUE(near(out, expected, chain_bound(weight))) << "from " << text(in.shape());
    });
  }
}

TEST(Torch, linear_layers_are_the_same) {
  Random random(137);
  for (int i = 0; i < kCases; ++i) {
    const Slice in(large_shape(random), random.pick({0, 5}), random);
    const WeightTensor weight = random.weights({random.pick({1, 80, 512}), in.shape().channels});
    const std::vector<float> bias = random.reals(weight.shape[0]);
    const torch::Tensor last = planes(in).permute({0, 2, 3, 1});
    const reference::Values expected =
        values(torch::linear(last, tensor(weight), tensor(bias)).permute({0, 3, 1, 2}));
    on_every_isa([&] {
      const Slice out(expected.shape, random.pick({0, 3}));
      Linear(weight, bias)(in, out);
      EXPECT_TRUE(near(out, expected, chain_bound(weight))) << "from " << text(in.shape());
    });
  }
}

TEST(Torch, nearest_codes_are_as_near) {
  Random random(138);
  for (int i = 0; i < kCases; ++i) {
    const Slice in(large_shape(random), random.pick({0, 5}), random);
    const WeightTensor embed = random.weights({in.shape().channels, 512});
    const torch::Tensor x = planes(in).permute({0, 2, 3, 1}).reshape({-1, in.shape().channels});
    const torch::Tensor e = tensor(embed);
    const torch::Tensor distances =
        (x * x).sum({1}, true) - 2 * torch::matmul(x, e) + (e * e).sum({0}, true);
    const torch::Tensor least = std::get<0>(distances.min(1));
    on_every_isa([&] {
      std::vector<std::int32_t> codes(in.shape().pixels());
      Codebook(embed).nearest(in, codes.data());
      for (std::size_t p = 0; p < codes.size(); ++p) {
        const auto row = static_cast<std::int64_t>(p);
        EXPECT_LE(distances[row][codes[p]].item<double>(), least[row].item<double>() + 1e-4);
      }
    });
  }
}

}  // namespace
}  // namespace ps::nn
