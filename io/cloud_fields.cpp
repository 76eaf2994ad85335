// SPDX-License-Identifier: BSD-3-Clause
#include "io/cloud_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "io/bytes.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

constexpr std::size_t kChunk = 1 << 14;

/// Rounded into [0, most]; NaN is 0.
std::uint32_t whole(double value, double most) {
  return value > 0 ? static_cast<std::uint32_t>(std::min(value, most) + 0.5) : 0;
}

/// A colour: integers are of their type's range, floating point of [0, 1].
std::uint8_t colour(double value, Scalar type) {
  double white = 255;
  if (type == Scalar::u16) white = 65535;
  if (type == Scalar::f32 || type == Scalar::f64) white = 1;
  return static_cast<std::uint8_t>(whole(value / white * 255, 255));
}

float to_float(double value) {
  const bool fits = std::abs(value) <= std::numeric_limits<float>::max();
  return fits ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
}

void set_rgb(Point& point, std::uint32_t rgb) { point.rgba = 0xff000000u | rgb; }

void set(Point& point, Role role, Scalar type, double value) {
  switch (role) {
    case Role::none:
      break;
    case Role::x:
      point.x = to_float(value);
      break;
    case Role::y:
      point.y = to_float(value);
      break;
    case Role::z:
      point.z = to_float(value);
      break;
    case Role::red:
      point.r = colour(value, type);
      break;
    case Role::green:
      point.g = colour(value, type);
      break;
    case Role::blue:
      point.b = colour(value, type);
      break;
    case Role::rgb:
      set_rgb(point, whole(value, 0xffffffffu));
      break;
    case Role::footprint:
      point.footprint = value > 0 && std::isfinite(to_float(value)) ? to_float(value) : 0;
      break;
    case Role::view:
      point.view = static_cast<std::uint16_t>(whole(value, 65535));
      break;
    case Role::origin:
      point.origin = value > 0 ? 1 : 0;
      break;
  }
}

bool is_colour(Role role) {
  return role == Role::red || role == Role::green || role == Role::blue || role == Role::rgb;
}

template <class Parts>
Point prototype(const Parts& parts) {
  Point point;
  const bool coloured = std::any_of(parts.begin(), parts.end(),
                                    [](const auto& part) { return is_colour(part.role); });
  if (!coloured) set_rgb(point, 0x808080);
  return point;
}

bool finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void drop_unfinite(Cloud& cloud) {
  const auto end = std::remove_if(cloud.points.begin(), cloud.points.end(),
                                  [](const Point& point) { return !finite(point); });
  cloud.points.erase(end, cloud.points.end());
  cloud.width = static_cast<std::uint32_t>(cloud.points.size());
  cloud.height = 1;
  cloud.is_dense = true;
}

[[noreturn]] void fail_number(std::string_view token, const LineReader& lines) {
  throw Error(lines.where(), token.empty() ? "the line ends too early" : in_quotes(token),
              "a number for each property");
}

/// Packed colours may be written as the float that has their bits, or as the integer.
double packed_rgb(double value, Scalar type) {
  if (type != Scalar::f32 || value >= 1) return value;
  if (std::isnan(value)) return 0x808080;
  const float bits = to_float(value);
  return load<std::uint32_t>(reinterpret_cast<const char*>(&bits));
}

void parse_point(std::string_view line, const std::vector<Column>& columns, const LineReader& lines,
                 Point& point) {
  for (const Column& column : columns) {
    std::string_view token = next_token(line);
    std::optional<double> value = to_number<double>(token);
    if (!value) fail_number(token, lines);
    if (column.list) {
      for (double left = *value; left >= 1; --left) {
        token = next_token(line);
        if (!to_number<double>(token)) fail_number(token, lines);
      }
    } else if (column.role == Role::rgb) {
      set(point, Role::rgb, column.type, packed_rgb(*value, column.type));
    } else {
      set(point, column.role, column.type, *value);
    }
  }
  if (!next_token(line).empty()) {
    throw Error(lines.where(), "the line has more numbers than the header says",
                std::to_string(columns.size()) + " properties");
  }
}

}  // namespace

std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 10> kSizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

double load_scalar(Scalar type, const char* at, bool swap) {
  switch (type) {
    case Scalar::i8:
      return load<std::int8_t>(at);
    case Scalar::u8:
      return load<std::uint8_t>(at);
    case Scalar::i16:
      return load<std::int16_t>(at, swap);
    case Scalar::u16:
      return load<std::uint16_t>(at, swap);
    case Scalar::i32:
      return load<std::int32_t>(at, swap);
    case Scalar::u32:
      return load<std::uint32_t>(at, swap);
    case Scalar::i64:
      return static_cast<double>(load<std::int64_t>(at, swap));
    case Scalar::u64:
      return static_cast<double>(load<std::uint64_t>(at, swap));
    case Scalar::f32:
      return load<float>(at, swap);
    case Scalar::f64:
      return load<double>(at, swap);
  }
  return 0;
}

Role role_of(std::string_view name, Scalar type) {
  static const std::map<std::string_view, Role> kRoles{
      {"x", Role::x},
      {"y", Role::y},
      {"z", Role::z},
      {"red", Role::red},
      {"r", Role::red},
      {"diffuse_red", Role::red},
      {"green", Role::green},
      {"g", Role::green},
      {"diffuse_green", Role::green},
      {"blue", Role::blue},
      {"b", Role::blue},
      {"diffuse_blue", Role::blue},
      {"rgb", Role::rgb},
      {"rgba", Role::rgb},
      {"scalar_footprint", Role::footprint},
      {"footprint", Role::footprint},
      {"scalar_view", Role::view},
      {"view", Role::view},
      {"scalar_origin", Role::origin},
      {"origin", Role::origin},
  };
  const auto found = kRoles.find(name);
  if (found == kRoles.end()) return Role::none;
  return found->second == Role::rgb && size_of(type) != 4 ? Role::none : found->second;
}

Cloud gather(std::size_t count, const std::vector<Field>& fields, bool swap) {
  Cloud cloud;
  cloud.points.resize(count, prototype(fields));
  parallel_chunks(count, kChunk, [&](std::size_t begin, std::size_t end) {
    for (const Field& field : fields) {
      if (field.role == Role::none) continue;
      // A packed colour is copied as bits: as a float it would often be NaN.
      const Scalar type = field.role == Role::rgb ? Scalar::u32 : field.type;
      for (std::size_t i = begin; i < end; ++i) {
        const char* at = field.at + i * field.stride;
        set(cloud.points[i], field.role, type, load_scalar(type, at, swap));
      }
    }
  });
  drop_unfinite(cloud);
  return cloud;
}

Cloud parse_points(std::size_t count, const std::vector<Column>& columns, LineReader& lines) {
  // A number and its blank or end of line are two bytes at least.
  if (count > (lines.rest().size() + 1) / 2 / std::max<std::size_t>(columns.size(), 1)) {
    throw Error(lines.where(),
                "the header promises " + std::to_string(count) + " points, but " +
                    std::to_string(lines.rest().size()) + " bytes follow",
                "a line for each point");
  }
  Cloud cloud;
  cloud.points.resize(count, prototype(columns));
  for (std::size_t i = 0; i < count; ++i) {
    std::string_view line;
    do {
      if (!lines.next(line)) {
        throw Error(
            lines.where(),
            "the file ends after " + std::to_string(i) + " of " + std::to_string(count) + " points",
            "the whole file");
      }
    } while (line.find_first_not_of(" \t") == std::string_view::npos);
    parse_point(line, columns, lines, cloud.points[i]);
  }
  drop_unfinite(cloud);
  return cloud;
}

void check_finite(const Cloud& cloud, const std::string& where) {
  const auto bad = std::find_if_not(cloud.points.begin(), cloud.points.end(), finite);
  if (bad == cloud.points.end()) return;
  throw Error(where, "point " + std::to_string(bad - cloud.points.begin()) + " is not finite",
              "finite coordinates");
}

}  // namespace ps
