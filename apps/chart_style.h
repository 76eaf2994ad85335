// SPDX-License-Identifier: BSD-3-Clause
// Internal to charts: what their parts are drawn with.
#pragma once

#include <cstddef>
#include <iterator>

namespace ps::apps {

/// Of curves: Okabe and Ito's colours, which colour-blind people can tell apart, less the yellow,
/// which white swallows; then three of Paul Tol's muted scheme.
constexpr unsigned kCurveColors[] = {0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00,
                                     0x56b4e9, 0x882255, 0x332288, 0x999933};
constexpr unsigned color_of_curve(std::size_t i) {
  return kCurveColors[i % std::size(kCurveColors)];
}

constexpr unsigned kInk = 0x222222, kGrid = 0xe4e4e4, kLeader = 0x888888;
constexpr double kWords = 13, kTitle = 16;  ///< letters, pixels
constexpr double kDot = 4, kRing = 8;       ///< radii, pixels

}  // namespace ps::apps
