// SPDX-License-Identifier: BSD-3-Clause
// Internal to the checkpoint reader: the way to the tensors.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "io/pickle.h"

namespace ps {

constexpr std::size_t kLongestTensorName = 512;

/// @return the tensors that dicts and lists lead to from `state_dict` or `model_state_dict` of a
/// dict `root`, else from `root`, each with the keys to it, joined by dots. Throws ps::Error when
/// values nest too deep (they may run in circles) or names are too long.
/// @param where  the file, for messages
std::vector<std::pair<std::string, const PickleValue*>> find_tensors(const PickleValue& root,
                                                                     const std::string& where);

}  // namespace ps
