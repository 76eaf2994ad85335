// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/safetensors.h"

namespace ps {

/// How many of a file's first bytes is_torch_checkpoint() wants to see, where it has so many.
constexpr std::size_t kCheckpointHead = 512;

/// @return whether a file that begins so is a pickle, a zip or a tar, and no safetensors file
bool is_torch_checkpoint(std::string_view head);

/// @brief Reads the tensors of a file that torch.save wrote, in its zip or its legacy container.
///
/// A top-level dict's `state_dict` or `model_state_dict` is taken where there is one, else all
/// tensors that dicts and lists lead to, named by the way to them: `model.conv1.weight`. Views of
/// any strides become whole tensors. Options, optimizers and other objects beside are passed over.
///
/// Nothing is run: the pickle is read by a machine (io/pickle.h) that knows the instructions that
/// tensors need, and describes objects instead of making them. It refuses all other instructions,
/// and calls of anything but tensors and plain values.
///
/// Memory is bounded by a few times the file's size, whatever the file says. Throws ps::Error,
/// which names file and tensor, on whatever is unsound, and when there is no tensor.
TensorMap read_torch_checkpoint(const std::filesystem::path& path);

/// @brief The same from a file's bytes; `name` stands in messages.
TensorMap parse_torch_checkpoint(std::string_view bytes, const std::string& name);

}  // namespace ps
