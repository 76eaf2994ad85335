// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace ps::apps {

/// @brief A file of weights that comes with the program: from its install, else from the source
/// tree it was built from. Throws ps::Error that names both places when it is in neither.
/// @param name  "depth.safetensors"
std::filesystem::path default_weights(const std::string& name);

/// @return the same, or nothing where it is in neither place
std::optional<std::filesystem::path> find_default_weights(const std::string& name);

}  // namespace ps::apps
