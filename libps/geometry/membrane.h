// SPDX-License-Identifier: BSD-3-Clause
// Internal to the geometry room: fills an image smoothly from weighted values.
#pragma once

#include <opencv2/core.hpp>

namespace ps {

/// @brief A membrane over an image, of one unit between neighbours, held by a spring at each pixel.
/// @param value   where the spring holds; any finite number where the weight is 0
/// @param weight  the spring's strength, at least 0; a weight w over a region averages its values
/// over some 1 / sqrt(w) pixels, and lets what comes from outside decay over as many
/// @return u that minimises sum weight (u - value)^2 + sum over 4-neighbours (u_p - u_q)^2, to a
/// few thousandths of the range of the values; 0 everywhere when all weights are 0
///
/// By full multigrid: Briggs, Henson, McCormick, A Multigrid Tutorial, chapter 3. In single
/// precision; the same bytes for any number of threads. Both images are of one size, not empty.
cv::Mat1f solve_membrane(const cv::Mat1f& value, const cv::Mat1f& weight);

}  // namespace ps
