// SPDX-License-Identifier: BSD-3-Clause
#include "apps/probe.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "libps/core/error.h"
#include "libps/nn/weights.h"

namespace ps::apps {
namespace {

constexpr std::size_t kLongestSide = std::size_t{1} << 24;

std::string text_of(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t side : shape) {
    text += (text.empty() ? "" : ", ") + (side == 0 ? "any" : std::to_string(side));
  }
  return "[" + text + "]";
}

bool fits(std::size_t side, std::size_t wanted) {
  return wanted == 0 ? side >= 1 && side <= kLongestSide : side == wanted;
}

}  // namespace

void add_files(CLI::App& verb, ProbeFiles& files) {
  verb.add_option("--in", files.in, "Safetensors to read")->required()->type_name("FILE");
  verb.add_option("--out", files.out, "Safetensors to write")->required()->type_name("FILE");
  verb.add_option("--prefix", files.prefix, "What the tensors' names in --in begin with")
      ->type_name("TEXT");
}

ProbeInput::ProbeInput(const ProbeFiles& files)
    : files_(files), tensors_(read_safetensors(files.in)) {}

bool ProbeInput::has(const std::string& name) const {
  return tensors_.count(files_.prefix + name) > 0;
}

const FileTensor& ProbeInput::take(const std::string& name) const {
  const auto found = tensors_.find(files_.prefix + name);
  if (found != tensors_.end()) return found->second;
  std::string names;
  for (const auto& [other, tensor] : tensors_) names += (names.empty() ? "" : ", ") + other;
  throw Error(files_.in, "has no tensor '" + files_.prefix + name + "'; it has " +
                             (names.empty() ? "none" : names));
}

const FileTensor& ProbeInput::take(const std::string& name,
                                   const std::vector<std::size_t>& shape) const {
  const FileTensor& tensor = take(name);
  if (!std::equal(tensor.shape.begin(), tensor.shape.end(), shape.begin(), shape.end(), fits)) {
    throw Error(
        files_.in,
        "tensor '" + files_.prefix + name + "' has the shape " + nn::to_string(tensor.shape),
        text_of(shape));
  }
  const std::vector<float> values = tensor.as_floats();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) refuse(name, i, values[i], "finite numbers");
  }
  return tensor;
}

void ProbeInput::refuse(const std::string& name, std::size_t at, float value,
                        const std::string& expected) const {
  std::ostringstream text;
  text << "tensor '" << files_.prefix << name << "' holds " << value << " at value " << at;
  throw Error(files_.in, text.str(), expected);
}

std::vector<std::int32_t> ProbeInput::codes(const std::string& name,
                                            const std::vector<std::size_t>& shape) const {
  constexpr float kMost = 1 << 24;  // beyond, floats are not all whole numbers
  const std::vector<float> values = take(name, shape).as_floats();
  std::vector<std::int32_t> codes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::abs(values[i]) > kMost || values[i] != std::floor(values[i])) {
      refuse(name, i, values[i], "codes, which are whole numbers");
    }
    codes.push_back(static_cast<std::int32_t>(values[i]));
  }
  return codes;
}

void check_finite(const TensorMap& made, const std::string& weights) {
  for (const auto& [name, tensor] : made) {
    const std::vector<float> values = tensor.as_floats();
    const auto finite = [](float value) { return std::isfinite(value); };
    const auto bad = std::find_if_not(values.begin(), values.end(), finite);
    if (bad == values.end()) continue;
    throw Error(weights,
                "these weights make " + std::to_string(*bad) + " at value " +
                    std::to_string(bad - values.begin()) + " of '" + name + "'",
                "weights that make finite numbers of this input");
  }
}

std::vector<std::uint8_t> mask_of(const FileTensor& tensor) {
  std::vector<std::uint8_t> mask;
  for (const float value : tensor.as_floats()) mask.push_back(value != 0);
  return mask;
}

outpaint::Order order_of(const ProbeInput& in) {
  const FileTensor& background = in.take("bg256", {1, 0, 0});
  std::vector<std::uint8_t> mask = mask_of(background);
  const cv::Mat1b view(static_cast<int>(background.shape[1]), static_cast<int>(background.shape[2]),
                       mask.data());
  return outpaint::order_of(view);
}

}  // namespace ps::apps
