// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/completions.h"

#include <utility>
#include <vector>

#include "libps/models/pixel_cnn.h"
#include "libps/outpaint/sampler.h"

namespace ps::train {
namespace {

template <class To>
std::vector<To> values_of(const Tensor& tensor) {
  const Tensor dense = tensor.flatten().to(torch::kCPU, torch::kInt64).contiguous();
  const std::int64_t* const data = dense.data_ptr<std::int64_t>();
  std::vector<To> values;
  for (std::int64_t i = 0; i < dense.numel(); ++i) values.push_back(static_cast<To>(data[i]));
  return values;
}

}  // namespace

nn::Weights weights_of(const Parameters& parameters) {
  std::map<std::string, nn::WeightTensor> tensors;
  for (const auto& [name, tensor] : parameters.named()) {
    const Tensor dense = tensor.to(torch::kCPU, torch::kFloat32).contiguous();
    nn::WeightTensor& to = tensors[name];
    for (const auto side : dense.sizes()) to.shape.push_back(static_cast<std::size_t>(side));
    to.values.assign(dense.data_ptr<float>(), dense.data_ptr<float>() + dense.numel());
  }
  return {"trained", std::move(tensors)};
}

Tensor completions(const Parameters& pixel_cnn, const Tensor& codes, const Tensor& order,
                   const Tensor& unseen, int count) {
  const std::int64_t h = codes.size(0), w = codes.size(1);
  const models::PixelCnn network(weights_of(pixel_cnn));
  const outpaint::Order cells =
      outpaint::order_from(static_cast<int>(h), static_cast<int>(w), values_of<int>(order),
                           values_of<std::uint8_t>(unseen));
  outpaint::Sampler sampler(network, cells, values_of<std::int32_t>(codes));
  std::vector<Tensor> all;
  for (const outpaint::Completion& completion : sampler.sample(0, count)) {
    all.push_back(torch::tensor(completion.codes, torch::kInt32).to(torch::kInt64).view({h, w}));
  }
  return torch::stack(all).to(codes.device());
}

}  // namespace ps::train
