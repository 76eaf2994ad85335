// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/lpips.h"

#include <string>
#include <vector>

#include "libps/core/error.h"
#include "libps/train/checkpoint.h"
#include "libps/train/layers.h"

namespace ps::train {
namespace {

struct Fire {
  int index;
  bool pooled;  ///< max pooling comes before it
  bool compared;
};
constexpr Fire kFires[] = {{3, true, false},  {4, false, true}, {6, true, false},
                           {7, false, true},  {9, true, true},  {10, false, true},
                           {11, false, true}, {12, false, true}};

Tensor unit(const Tensor& x) { return x / (x.square().sum(1, true) + 1e-10).sqrt(); }

}  // namespace

Lpips::Lpips(const std::filesystem::path& weights, torch::Device device)
    : weights_(read_tensors(weights)) {
  for (auto& [name, tensor] : weights_) tensor = tensor.to(device);
}

const Tensor& Lpips::at(const std::string& name) const {
  const auto found = weights_.find(name);
  if (found == weights_.end())
    throw Error("--features", "there is no tensor " + name, "weights of LPIPS over SqueezeNet");
  return found->second;
}

Tensor Lpips::convolution(const std::string& name, const Tensor& x, int stride, int padding) const {
  return torch::relu(conv2d(x, at(name + ".weight"), at(name + ".bias"), stride, padding));
}

std::vector<Tensor> Lpips::features(const Tensor& image) const {
  const Tensor shift = torch::tensor({-.030f, -.088f, -.188f}, image.options()).view({1, 3, 1, 1});
  const Tensor scale = torch::tensor({.458f, .448f, .450f}, image.options()).view({1, 3, 1, 1});
  Tensor x = convolution("net.0", (image - shift) / scale, 2, 0);
  std::vector<Tensor> found = {x};
  for (const Fire& fire : kFires) {
    const std::string name = "net." + std::to_string(fire.index) + ".";
    if (fire.pooled) x = torch::max_pool2d(x, 3, 2, 0, 1, true);
    const Tensor narrow = convolution(name + "squeeze", x, 1, 0);
    x = torch::cat({convolution(name + "expand1x1", narrow, 1, 0),
                    convolution(name + "expand3x3", narrow, 1, 1)},
                   1);
    if (fire.compared) found.push_back(x);
  }
  return found;
}

Tensor Lpips::distance(const Tensor& a, const Tensor& b) const {
  const std::vector<Tensor> of_a = features(a);
  std::vector<Tensor> of_b;
  {
    const torch::NoGradGuard guard;
    of_b = features(b);
  }
  Tensor sum = torch::zeros({}, a.options());
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const Tensor& weight = at("lin" + std::to_string(i) + ".model.1.weight");
    sum = sum + torch::conv2d((unit(of_a[i]) - unit(of_b[i])).square(), weight).mean({2, 3}).mean();
  }
  return sum;
}

}  // namespace ps::train
