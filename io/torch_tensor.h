// SPDX-License-Identifier: BSD-3-Clause
// Internal to the checkpoint reader: what torch's pickles say of tensors and storages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/pickle.h"
#include "io/safetensors.h"

namespace ps {

/// @brief A run of numbers that lies outside the pickle, or a part of one.
struct TorchStorage {
  std::string_view key;     ///< its name in the container
  std::string_view dtype;   ///< as safetensors spells it
  std::size_t element = 0;  ///< bytes of one number
  std::size_t count = 0;    ///< numbers in all
  std::size_t first = 0;    ///< where the part begins
  std::size_t part = 0;     ///< numbers of the part

  std::size_t bytes() const { return count * element; }
};

/// @brief A tensor: a view of a storage. Element (i, j, ...) is number
/// first + i * strides[0] + j * strides[1] + ... of the storage, which is always within it.
struct TorchTensor {
  TorchStorage storage;
  std::size_t first = 0;
  std::vector<std::size_t> shape;
  std::vector<std::size_t> strides;
  std::size_t count = 0;  ///< elements

  std::size_t bytes() const { return count * storage.element; }
};

/// @return whether torch.save writes calls of this: to make a tensor or a plain value. None is
/// made.
bool is_torch_call(std::string_view global);

/// @return whether the value names a storage; torch's legacy pickles also name source code
bool is_torch_storage(const PickleValue& persistent);

/// @brief Reads what the pickle says of a storage. Throws ps::Error when it is unsound.
/// @param where  the file, for messages
TorchStorage torch_storage(const PickleValue& persistent, const std::string& where);

/// @return whether the value is a tensor or a parameter
bool is_torch_tensor(const PickleValue& value);

/// @brief Reads what the pickle says of a tensor. Throws ps::Error when it is unsound or leaves its
/// storage.
/// @param where  file and tensor, for messages
TorchTensor torch_tensor(const PickleValue& value, const std::string& where);

/// @param storage  its bytes, storage.bytes() of them
/// @param swap     whether they are big-endian
FileTensor gather(const TorchTensor& tensor, std::string_view storage, bool swap);

}  // namespace ps
