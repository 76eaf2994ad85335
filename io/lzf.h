// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: the compression of PCD files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ps {

/// @brief Compresses into LZF, the format of PCD's binary_compressed: runs of up to 32 plain bytes,
/// and copies of up to 264 bytes from up to 8192 back. (PCL has it too, in a library that brings
/// some sixty others.)
/// @param plain  less than 4 GiB
/// @return at most one byte in 32 more than `plain`
std::string lzf_compress(std::string_view plain);

/// @return the `size` bytes that `packed` stands for; empty when it stands for more or fewer or is
/// damaged
std::optional<std::string> lzf_decompress(std::string_view packed, std::size_t size);

}  // namespace ps
