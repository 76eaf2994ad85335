// SPDX-License-Identifier: BSD-3-Clause
#include "libps/train/checkpoint.h"

#include <cstring>

#include "io/safetensors.h"
#include "io/weights_file.h"
#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::train {
namespace {

fs::path checkpoint_path(const TrainOptions& options) {
  return options.out / "checkpoint.safetensors";
}

const char* dtype_of(const Tensor& tensor) {
  if (tensor.scalar_type() == torch::kFloat64) return "F64";
  if (tensor.scalar_type() == torch::kInt64) return "I64";
  return "F32";
}

FileTensor to_file(const Tensor& tensor) {
  const Tensor dense = tensor.detach().cpu().contiguous();
  FileTensor file;
  file.dtype = dtype_of(dense);
  for (const auto side : dense.sizes()) file.shape.push_back(static_cast<std::size_t>(side));
  file.bytes.resize(static_cast<std::size_t>(dense.nbytes()));
  std::memcpy(file.bytes.data(), dense.data_ptr(), file.bytes.size());
  return file;
}

Tensor from_file(FileTensor& file) {
  const std::vector<std::int64_t> shape(file.shape.begin(), file.shape.end());
  if (file.dtype == "F64" || file.dtype == "I64") {
    return torch::from_blob(file.bytes.data(), shape,
                            file.dtype == "F64" ? torch::kFloat64 : torch::kInt64)
        .clone();
  }
  std::vector<float> values = file.as_floats();
  return torch::from_blob(values.data(), shape, torch::kFloat32).clone();
}

TensorsByName tensors_of(TensorMap files) {
  TensorsByName tensors;
  for (auto& [name, file] : files) tensors[name] = from_file(file);
  return tensors;
}

/// What a run must have in common with the one that it goes on with.
TensorsByName identity(Stage& stage, const TrainOptions& options, std::int64_t step) {
  const std::vector<std::int64_t> values = {step,
                                            options.steps,
                                            options.batch,
                                            static_cast<std::int64_t>(options.seed),
                                            options.arithmetic == "bf16",
                                            options.keep_codes,
                                            options.codes == kColors};
  TensorsByName tensors = {{"run." + options.stage, torch::tensor(values)}};
  for (const auto& network : stage.networks()) {
    tensors.merge(network.parameters->named());
    tensors.merge(network.adam->named());
  }
  return tensors;
}

}  // namespace

void save_checkpoint(Stage& stage, const TrainOptions& options, std::int64_t step) {
  TensorMap files;
  for (const auto& [name, tensor] : identity(stage, options, step)) files[name] = to_file(tensor);
  write_safetensors(checkpoint_path(options), files);
}

std::int64_t load_checkpoint(Stage& stage, const TrainOptions& options) {
  const fs::path path = checkpoint_path(options);
  if (!fs::exists(path)) return 0;
  const std::string where = path.string();
  const TensorsByName tensors = tensors_of(read_safetensors(path));
  const auto run = tensors.find("run." + options.stage);
  if (run == tensors.end() || run->second.numel() < 4) {
    throw Error(where, "this checkpoint is not of stage " + options.stage, "another --output");
  }
  // Older checkpoints say less: they are of f32 and all of the network.
  const auto value = [&](int i) {
    return i < run->second.numel() ? run->second[i].item<std::int64_t>() : 0;
  };
  if (value(1) != options.steps || value(2) != options.batch ||
      value(3) != static_cast<std::int64_t>(options.seed)) {
    throw Error(where,
                "this run has " + std::to_string(value(1)) + " steps of " +
                    std::to_string(value(2)) + " examples and seed " + std::to_string(value(3)),
                "the same to go on with it, or another --output");
  }
  if ((value(4) != 0) != (options.arithmetic == "bf16") || (value(5) != 0) != options.keep_codes) {
    throw Error(where,
                std::string("this run has --arithmetic ") + (value(4) != 0 ? "bf16" : "f32") +
                    (value(5) != 0 ? " and --keep-codes" : ", without --keep-codes"),
                "the same to go on with it, or another --output");
  }
  if (run->second.numel() > 6 && (value(6) != 0) != (options.codes == kColors)) {
    throw Error(where, "this run is of other --codes", "the same, or another --output");
  }
  for (const auto& network : stage.networks()) {
    network.parameters->load(tensors, where);
    network.adam->load(tensors, where);
  }
  return value(0);
}

fs::path save_weights(Stage& stage, const TrainOptions& options, std::int64_t step) {
  TensorMap files;
  for (const auto& network : stage.networks()) {
    if (!network.shipped) continue;
    network.adam->swap_average();
    for (const auto& [name, tensor] : network.parameters->named()) files[name] = to_file(tensor);
    network.adam->swap_average();
  }
  const fs::path path = options.out / "weights.safetensors";
  Metadata words = stage.metadata();
  words["stage"] = options.stage;
  words["seed"] = std::to_string(options.seed);
  words["steps"] = std::to_string(step);
  write_safetensors(path, files, words);
  return path;
}

TensorsByName read_tensors(const fs::path& path) { return tensors_of(read_weight_tensors(path)); }

void load_weights(Stage& stage, const fs::path& path) {
  const TensorsByName tensors = read_tensors(path);
  for (const auto& network : stage.networks()) {
    if (!network.shipped) continue;
    network.parameters->load(tensors, path.string());
    network.adam->restart_average();
  }
}

}  // namespace ps::train
