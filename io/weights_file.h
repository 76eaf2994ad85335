// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/safetensors.h"
#include "libps/nn/weights.h"

namespace ps {

/// How floats are stored.
enum class FloatType { f32, f16, bf16 };

/// @return whether the name begins with one of the published networks: `pts_regressor.`, `vqvae.`,
/// `outpaint2.`, `projector.`, `netD.`, `classifier.`
bool names_network(const std::string& name);

/// @brief The project's name of a tensor of a published state dict: from the network's name on
/// (`model.module.vqvae.enc_b.blocks.0.bias` -> `vqvae.enc_b.blocks.0.bias`), a repeated netD once;
/// a name without a network loses `model.`, `module.` or `model.module.` at its beginning.
std::string project_name(const std::string& name);

/// @brief Reads a safetensors file or a torch checkpoint (told by content, not by name), under the
/// project's names. Throws ps::Error as their readers do (io/safetensors.h, io/torch_checkpoint.h),
/// and when a name is empty or not printable, or two names become one.
TensorMap read_weight_tensors(const std::filesystem::path& path);

/// @brief The same as weights of networks. Integers are known by name only: lookups refuse them.
nn::Weights read_weights(const std::filesystem::path& path);

/// @brief The same from a file's bytes; `name` stands in messages.
nn::Weights parse_weights(std::string_view bytes, const std::string& name);

/// @brief The words that a safetensors file holds beside its weights; of a torch checkpoint, none.
/// Throws ps::Error as read_safetensors_metadata() does.
Metadata read_metadata(const std::filesystem::path& path);

/// @brief The tensors with all floats stored as `type`, rounded to nearest even; integers stay as
/// they are. Throws ps::Error that names the tensor when a finite number becomes infinite.
/// @param where  stands in messages: the file they are for
TensorMap stored_as(TensorMap tensors, FloatType type, const std::string& where);

/// @brief Writes weights as safetensors, floats stored as `type`; tensors that are no floats are
/// left out. The file appears whole or not at all. Throws ps::Error as stored_as() and
/// write_safetensors() do.
void write_weights(const std::filesystem::path& path, const nn::Weights& weights, FloatType type,
                   const Metadata& metadata = {});

}  // namespace ps
