// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace ps::apps {

/// @return where the program lies
std::filesystem::path program_folder();

/// @brief The address of a function in a part of the program that is loaded when it is first used,
/// as it brings many libraries along: `viewer` (VTK) or `video` (FFmpeg). Part NAME is the shared
/// library libpixelsynth_NAME.so beside the program, or where its install put it.
/// Throws ps::Error when the part cannot be loaded or has no such function.
void* address_in_part(const std::string& part, const char* function);

/// @tparam Function  the type of a function that the part declares extern "C"
template <class Function>
Function* function_of_part(const std::string& part, const char* function) {
  return reinterpret_cast<Function*>(address_in_part(part, function));
}

}  // namespace ps::apps
