// SPDX-License-Identifier: BSD-3-Clause
// What the sampler's tests share: orders, codes and weights by chance, and the logits seen.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "libps/models/pixel_cnn.h"
#include "libps/outpaint/order.h"
#include "tests/support/random_weights.h"

namespace ps::outpaint {

/// Random orders of a small grid: any permutation, any cells missing.
inline Order random_order(std::mt19937& random, int height, int width, double share) {
  std::vector<int> cells(static_cast<std::size_t>(height * width));
  std::iota(cells.begin(), cells.end(), 0);
  std::shuffle(cells.begin(), cells.end(), random);
  std::vector<std::uint8_t> missing;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    missing.push_back(random() % 1000 < static_cast<unsigned>(share * 1000));
  }
  return order_from(height, width, cells, missing);
}

inline std::vector<std::int32_t> random_codes(std::mt19937& random, std::size_t count, int codes) {
  std::vector<std::int32_t> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(static_cast<std::int32_t>(random() % static_cast<unsigned>(codes)));
  return values;
}

inline models::PixelCnn small_network() {
  return models::PixelCnn(models::random_pixel_cnn(11, 24));
}

/// The same weights, each tensor's values in another order.
inline nn::Weights shuffled(const nn::Weights& weights, unsigned seed) {
  std::mt19937 random(seed);
  std::map<std::string, nn::WeightTensor> tensors = weights.tensors();
  for (auto& [name, tensor] : tensors) {
    std::shuffle(tensor.values.begin(), tensor.values.end(), random);
  }
  return {"shuffled weights", std::move(tensors)};
}

/// The same weights, one tensor's values replaced.
inline nn::Weights with_all(const nn::Weights& weights, const std::string& name, float value) {
  std::map<std::string, nn::WeightTensor> tensors = weights.tensors();
  std::vector<float>& values = tensors.at(name).values;
  std::fill(values.begin(), values.end(), value);
  return {"changed weights", std::move(tensors)};
}

/// Logits of all cells that were sampled, by completion and cell.
struct Logits {
  std::map<std::pair<int, int>, std::vector<float>> seen;
  std::mutex mutex;
  std::function<void(int, int, const float*)> observer(int codes) {
    return [this, codes](int cell, int completion, const float* logits) {
      const std::lock_guard<std::mutex> lock(mutex);
      seen[{completion, cell}].assign(logits, logits + codes);
    };
  }
  const std::vector<float>& of(int cell, int completion = 0) {
    return seen[{completion, cell}];  // empty where nothing was sampled
  }
};

}  // namespace ps::outpaint
