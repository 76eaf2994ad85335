// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/cloud_fields.h"
#include "io/cloud_file.h"
#include "io/text.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

struct Property {
  std::string name;
  Scalar type = Scalar::f32;
  std::optional<Scalar> list;  ///< type of the count, for lists
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;

  bool has_lists() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const Property& property) { return property.list.has_value(); });
  }
  /// @return bytes of one of it in binary; lists as if they were empty
  std::size_t least_bytes() const {
    std::size_t bytes = 0;
    for (const Property& p : properties) bytes += size_of(p.list.value_or(p.type));
    return bytes;
  }
};

struct Header {
  bool ascii = false;
  bool swap = false;
  std::vector<Element> elements;  ///< up to and with the vertices
};

Scalar scalar_of(std::string_view name, const LineReader& lines) {
  static const std::map<std::string_view, Scalar> kScalars{
      {"char", Scalar::i8},     {"int8", Scalar::i8},     {"uchar", Scalar::u8},
      {"uint8", Scalar::u8},    {"short", Scalar::i16},   {"int16", Scalar::i16},
      {"ushort", Scalar::u16},  {"uint16", Scalar::u16},  {"int", Scalar::i32},
      {"int32", Scalar::i32},   {"uint", Scalar::u32},    {"uint32", Scalar::u32},
      {"float", Scalar::f32},   {"float32", Scalar::f32}, {"double", Scalar::f64},
      {"float64", Scalar::f64},
  };
  const auto found = kScalars.find(name);
  if (found != kScalars.end()) return found->second;
  throw Error(lines.where(), "property type " + in_quotes(name),
              "char to double, or int8 to float64");
}

void parse_format(std::string_view line, const LineReader& lines, Header& header) {
  const std::string_view format = next_token(line);
  if (format == "ascii") {
    header.ascii = true;
  } else if (format == "binary_big_endian") {
    header.swap = true;
  } else if (format != "binary_little_endian") {
    throw Error(lines.where(), "format " + in_quotes(format),
                "ascii, binary_little_endian or binary_big_endian");
  }
}

Property parse_property(std::string_view line, const LineReader& lines) {
  Property property;
  std::string_view type = next_token(line);
  if (type == "list") {
    property.list = scalar_of(next_token(line), lines);
    if (*property.list == Scalar::f32 || *property.list == Scalar::f64) {
      throw Error(lines.where(), "a list's count is not an integer", "uchar or another integer");
    }
    type = next_token(line);
  }
  property.type = scalar_of(type, lines);
  property.name = std::string(next_token(line));
  return property;
}

Element parse_element(std::string_view line, const LineReader& lines) {
  Element element;
  element.name = std::string(next_token(line));
  const std::string_view word = next_token(line);
  const std::optional<std::size_t> count = to_number<std::size_t>(word);
  if (!count) throw Error(lines.where(), "element count " + in_quotes(word), "a whole number");
  element.count = *count;
  return element;
}

/// Reads on to end_header; elements after the vertices are left out, as nobody reads them.
Header parse_header(LineReader& lines) {
  Header header;
  std::string_view line;
  if (!lines.next(line) || line != "ply") {
    throw Error(lines.where(), "is no PLY file", "'ply' in the first line");
  }
  bool formatted = false, past_vertices = false;
  while (lines.next(line)) {
    const std::string_view keyword = next_token(line);
    if (keyword == "end_header") {
      if (!formatted) throw Error(lines.where(), "the header has no format line", "one");
      const bool vertices = !header.elements.empty() && header.elements.back().name == "vertex";
      if (!vertices) throw Error(lines.where(), "there is no vertex element", "one");
      return header;
    }
    if (keyword == "format") {
      parse_format(line, lines, header);
      formatted = true;
    } else if (keyword == "element") {
      past_vertices = !header.elements.empty() && header.elements.back().name == "vertex";
      if (!past_vertices) header.elements.push_back(parse_element(line, lines));
    } else if (keyword == "property") {
      if (header.elements.empty()) throw Error(lines.where(), "a property of nothing", "element");
      const Property property = parse_property(line, lines);
      if (!past_vertices) header.elements.back().properties.push_back(property);
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      throw Error(lines.where(), "header line " + in_quotes(keyword),
                  "format, comment, element, property or end_header");
    }
  }
  throw Error(lines.where(), "the header has no end", "end_header");
}

[[noreturn]] void too_short(const Element& element, std::size_t bytes, const std::string& name) {
  throw Error(name,
              "the header promises " + std::to_string(element.count) + " of " +
                  in_quotes(element.name) + ", but " + std::to_string(bytes) + " bytes follow",
              "the whole file");
}

/// Takes all of an element with lists off `data`, and makes it one without.
/// @return its records, without the lists
std::string flatten(Element& element, bool swap, const std::string& name, std::string_view& data) {
  std::string plain;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) {
      std::size_t bytes = size_of(property.list.value_or(property.type));
      if (data.size() < bytes) too_short(element, data.size(), name);
      if (property.list) {
        const double count = load_scalar(*property.list, data.data(), swap);
        const double most = static_cast<double>((data.size() - bytes) / size_of(property.type));
        if (!(count >= 0 && count <= most)) {
          throw Error(name, "a list of " + std::to_string(count) + " in " + in_quotes(element.name),
                      "a list that the file can hold");
        }
        bytes += static_cast<std::size_t>(count) * size_of(property.type);
      } else {
        plain.append(data.substr(0, bytes));
      }
      data.remove_prefix(bytes);
    }
  }
  element.properties.erase(
      std::remove_if(element.properties.begin(), element.properties.end(),
                     [](const Property& property) { return property.list.has_value(); }),
      element.properties.end());
  return plain;
}

std::vector<Field> fields_of(const Element& element, const char* records) {
  std::vector<Field> fields;
  for (const Property& p : element.properties) {
    fields.push_back({role_of(p.name, p.type), p.type, records, element.least_bytes()});
    records += size_of(p.type);
  }
  return fields;
}

Cloud parse_binary(Header& header, std::string_view data, const std::string& name) {
  Cloud cloud;
  for (Element& element : header.elements) {
    const std::size_t bytes = element.least_bytes();
    if (bytes > 0 && element.count > data.size() / bytes) too_short(element, data.size(), name);
    std::string plain;
    const char* records = data.data();
    if (element.has_lists()) {
      plain = flatten(element, header.swap, name, data);
      records = plain.data();
    } else {
      data.remove_prefix(element.count * bytes);
    }
    if (&element == &header.elements.back()) {
      cloud = gather(element.count, fields_of(element, records), header.swap);
    }
  }
  return cloud;
}

Cloud parse_ascii(const Header& header, LineReader& lines) {
  std::string_view line;
  for (std::size_t e = 0; e + 1 < header.elements.size(); ++e) {
    const Element& element = header.elements[e];
    for (std::size_t i = 0; i < element.count && !element.properties.empty();) {
      if (!lines.next(line)) throw Error(lines.where(), "the file ends early", "the whole file");
      if (count_tokens(line) > 0) ++i;
    }
  }
  std::vector<Column> columns;
  for (const Property& p : header.elements.back().properties) {
    const Role role = p.list ? Role::none : role_of(p.name, p.type);
    columns.push_back({role, p.type, p.list.has_value()});
  }
  return parse_points(header.elements.back().count, columns, lines);
}

void check_coordinates(const Element& vertices, const std::string& where) {
  for (const char* name : {"x", "y", "z"}) {
    const bool there = std::any_of(vertices.properties.begin(), vertices.properties.end(),
                                   [&](const Property& p) { return !p.list && p.name == name; });
    if (!there) throw Error(where, "vertices have no " + std::string(name), "x, y and z");
  }
}

// --- writing ------------------------------------------------------------------------------------

constexpr std::size_t kRecord = 3 * sizeof(float) + 3 + sizeof(float) + sizeof(std::uint16_t) + 1;

void pack(const Point& point, char* to) {
  const std::uint8_t rgb[3] = {point.r, point.g, point.b};
  std::memcpy(to, point.data, 12);
  std::memcpy(to + 12, rgb, 3);
  std::memcpy(to + 15, &point.footprint, 4);
  std::memcpy(to + 19, &point.view, 2);
  std::memcpy(to + 21, &point.origin, 1);
}

std::string header_text(std::size_t points, const std::string& up) {
  return "ply\nformat binary_little_endian 1.0\n" + cloud_comments(up, "comment ", "scalar_") +
         "element vertex " + std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
         "property float scalar_footprint\nproperty ushort scalar_view\n"
         "property uchar scalar_origin\nend_header\n";
}

}  // namespace

Cloud parse_ply(std::string_view bytes, const std::string& name, std::size_t* dropped) {
  return guarded(name, [&] {
    LineReader lines(bytes, name);
    Header header = parse_header(lines);
    const Element& vertices = header.elements.back();
    check_coordinates(vertices, name);
    Cloud cloud =
        header.ascii ? parse_ascii(header, lines) : parse_binary(header, lines.rest(), name);
    if (dropped != nullptr) *dropped = vertices.count - cloud.size();
    return cloud;
  });
}

Cloud read_ply(const std::filesystem::path& path, std::size_t* dropped) {
  return guarded(path.string(),
                 [&] { return parse_ply(FileBytes(path).view(), path.string(), dropped); });
}

void write_ply(const std::filesystem::path& path, const Cloud& cloud, const std::string& up) {
  guarded(path.string(), [&] {
    check_finite(cloud, path.string());
    AtomicFile file(path);
    file.write(header_text(cloud.size(), up));
    constexpr std::size_t kBlock = 1 << 18;
    std::string block;
    for (std::size_t begin = 0; begin < cloud.size(); begin += kBlock) {
      const std::size_t count = std::min(kBlock, cloud.size() - begin);
      block.resize(count * kRecord);
      parallel_chunks(count, 1 << 14, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) pack(cloud[begin + i], &block[i * kRecord]);
      });
      file.write(block);
    }
    file.commit();
  });
}

}  // namespace ps
