// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ps::models {

/// What a PixelCNN's file calls the mark of the codebook that it was trained on, in its metadata.
inline constexpr char kCodebookMark[] = "codebook";

/// @brief A few numbers that tell codebooks apart: sums of all embeddings' values under signs by
/// chance, always the same ones. Rounded to half precision, a codebook has nearly the same mark.
/// @param embed  the values of `vqvae.quantize_t.embed`
/// @return as text, to stand in a file's metadata
std::string codebook_mark(const std::vector<float>& embed);

/// @return whether two marks are of one codebook, rounded differently or moved by less than a
/// twentieth of itself; also where one is no mark, which says nothing
bool same_codebook(const std::string& a, const std::string& b);

}  // namespace ps::models
