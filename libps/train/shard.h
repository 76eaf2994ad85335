// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ps::train {

/// @brief A shard of examples is a safetensors file of n views of s x s pixels, in pairs: view 2k+1
/// is of the same place as view 2k, from elsewhere, and has what of view 2k is seen there.
///
///     color    U8  [n, s, s, 3]    RGB
///     depth    F16 [n, s, s]       canonical metres, 0 = unknown
///     focal    F32 [n]             focal length over s
///     kind     U8  [n]             of room; 255 = unknown
///     splat    U8  [n / 2, s, s, 3]  view 2k lifted and splatted into view 2k+1
///     flags    U8  [n / 2, s, s]   1 = a point falls here; 2 = missing, dilated (SPEC.md 4)
///     order    I32 [n / 2, cells]  cells in order of generation (SPEC.md 6)
///     lens     F32 [n, 4]          fx, fy, cx, cy in pixels; pixel centres are at integers
///     pose     F32 [n / 2, 12]     first_from_second, row-major 3x4: R | t, metres
///
/// `lens` and `pose` come together or not at all: older shards have neither.
///
/// Shards are named GROUP-NUMBER.safetensors. Group `frames` is real, `rooms` is not; of `posed`,
/// real too, poses alone are known: depth is 0, flags are kMissing, splat and order say nothing.
///
/// Canonical metres are those in which the focal length is s: depth * s / focal in pixels. What a
/// picture looks like tells no more (Yin and others, Metric3D, ICCV 2023, section 3.1).
constexpr const char kRooms[] = "rooms", kFrames[] = "frames", kPosed[] = "posed";
constexpr unsigned char kHit = 1, kMissing = 2, kUnknownKind = 255;

}  // namespace ps::train
