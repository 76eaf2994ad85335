// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: what PLY and PCD readers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/text.h"
#include "libps/geometry/point.h"

namespace ps {

/// How a number is stored in a cloud file.
enum class Scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

std::size_t size_of(Scalar type);

/// @param swap  whether it is in the other byte order than this machine's
double load_scalar(Scalar type, const char* at, bool swap);

/// What a number of a cloud file is to a Point; `rgb` is 0xRRGGBB in one number (PCD).
enum class Role : std::uint8_t { none, x, y, z, red, green, blue, rgb, footprint, view, origin };

/// @return the role of a PLY property or PCD field of that name and type
Role role_of(std::string_view name, Scalar type);

/// One number of every record of a binary cloud: that of record i is at `at + i * stride`.
struct Field {
  Role role = Role::none;
  Scalar type = Scalar::f32;
  const char* at = nullptr;
  std::size_t stride = 0;
};

/// One column of an ASCII cloud.
struct Column {
  Role role = Role::none;
  Scalar type = Scalar::f32;
  bool list = false;  ///< a count and as many numbers, ignored
};

/// @brief Points from binary records. The caller has checked that all `count` records are there.
/// Points that are not finite are dropped; without colour they are grey (128).
/// @param swap  whether numbers are in the other byte order than this machine's
Cloud gather(std::size_t count, const std::vector<Field>& fields, bool swap);

/// @brief Points from lines of numbers, dropped and grey as in gather().
/// Throws ps::Error when fewer lines or numbers are there than promised, or they are none.
Cloud parse_points(std::size_t count, const std::vector<Column>& columns, LineReader& lines);

/// @brief Throws ps::Error, naming `where`, when a coordinate is not finite.
void check_finite(const Cloud& cloud, const std::string& where);

}  // namespace ps
