// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/cloud_fields.h"
#include "io/cloud_file.h"
#include "io/lzf.h"
#include "io/text.h"

namespace ps {
namespace {

struct PcdField {
  std::string name;
  std::size_t bytes = 4;  ///< of one number
  char kind = 'F';        ///< I, U or F
  std::size_t count = 1;
};

struct Header {
  std::vector<PcdField> fields;
  std::optional<std::size_t> width, height, points;
  std::string data;  ///< ascii, binary or binary_compressed

  std::size_t stride() const {
    std::size_t bytes = 0;
    for (const PcdField& field : fields) bytes += field.bytes * field.count;
    return bytes;
  }
};

Scalar scalar_of(const PcdField& field, const LineReader& lines) {
  const std::string key = field.kind + std::to_string(field.bytes);
  const std::pair<const char*, Scalar> kinds[] = {
      {"I1", Scalar::i8},  {"U1", Scalar::u8},  {"I2", Scalar::i16}, {"U2", Scalar::u16},
      {"I4", Scalar::i32}, {"U4", Scalar::u32}, {"I8", Scalar::i64}, {"U8", Scalar::u64},
      {"F4", Scalar::f32}, {"F8", Scalar::f64}};
  for (const auto& [name, scalar] : kinds) {
    if (key == name) return scalar;
  }
  throw Error(lines.where(), "field " + in_quotes(field.name) + " is of type " + in_quotes(key),
              "I or U of 1 to 8 bytes, or F of 4 or 8");
}

std::size_t take_size(std::string_view& line, const LineReader& lines, std::size_t most) {
  const std::string_view word = next_token(line);
  const std::optional<std::size_t> value = to_number<std::size_t>(word);
  if (value && *value <= most) return *value;
  throw Error(lines.where(), word.empty() ? "the line ends too early" : in_quotes(word),
              "a whole number up to " + std::to_string(most));
}

/// One line of the header, from its keyword on.
void parse_header_line(std::string_view line, const LineReader& lines, Header& header) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  const std::string_view keyword = next_token(line);
  if (keyword == "FIELDS" || keyword == "COLUMNS") {
    header.fields.clear();
    for (auto name = next_token(line); !name.empty(); name = next_token(line)) {
      header.fields.push_back({std::string(name)});
    }
  } else if (keyword == "SIZE") {
    for (PcdField& field : header.fields) field.bytes = take_size(line, lines, 8);
  } else if (keyword == "TYPE") {
    for (PcdField& field : header.fields) {
      const std::string_view kind = next_token(line);
      field.kind = kind.size() == 1 ? kind.front() : '?';
    }
  } else if (keyword == "COUNT") {
    for (PcdField& field : header.fields) field.count = take_size(line, lines, 1 << 16);
  } else if (keyword == "WIDTH") {
    header.width = take_size(line, lines, kMost);
  } else if (keyword == "HEIGHT") {
    header.height = take_size(line, lines, kMost);
  } else if (keyword == "POINTS") {
    header.points = take_size(line, lines, std::size_t{1} << 48);
  } else if (keyword == "DATA") {
    header.data = std::string(next_token(line));
  } else if (keyword != "VERSION" && keyword != "VIEWPOINT") {
    throw Error(lines.where(), "header line " + in_quotes(keyword),
                "FIELDS, SIZE, ... DATA of a PCD");
  }
}

Header parse_header(LineReader& lines) {
  Header header;
  std::string_view line;
  while (header.data.empty()) {
    if (!lines.next_content(line))
      throw Error(lines.where(), "the header has no DATA line", "a PCD");
    parse_header_line(line, lines, header);
  }
  if (header.width && header.height) {
    const std::size_t points = *header.width * *header.height;
    if (header.points.value_or(points) != points) {
      throw Error(lines.where(), "POINTS is not WIDTH times HEIGHT", std::to_string(points));
    }
    header.points = points;
  }
  if (!header.points) throw Error(lines.where(), "the header does not count points", "POINTS");
  for (const char* name : {"x", "y", "z"}) {
    const bool there =
        std::any_of(header.fields.begin(), header.fields.end(),
                    [&](const PcdField& field) { return field.name == name && field.count == 1; });
    if (!there) throw Error(lines.where(), "there is no field " + std::string(name), "x y z");
  }
  for (const PcdField& field : header.fields) scalar_of(field, lines);
  return header;
}

Role role(const PcdField& field, Scalar type) {
  return field.count == 1 ? role_of(field.name, type) : Role::none;
}

Cloud parse_ascii(const Header& header, LineReader& lines) {
  std::vector<Column> columns;
  for (const PcdField& field : header.fields) {
    const Scalar type = scalar_of(field, lines);
    columns.insert(columns.end(), field.count, {role(field, type), type, false});
  }
  return parse_points(*header.points, columns, lines);
}

[[noreturn]] void too_short(const Header& header, std::size_t bytes, const LineReader& lines) {
  throw Error(lines.where(),
              "the header promises " + std::to_string(*header.points) + " points of " +
                  std::to_string(header.stride()) + " bytes, but " + std::to_string(bytes) +
                  " bytes follow",
              "the whole file");
}

/// Records one after the other.
Cloud parse_binary(const Header& header, const LineReader& lines) {
  const std::string_view data = lines.rest();
  const std::size_t stride = header.stride();
  if (*header.points > data.size() / stride) too_short(header, data.size(), lines);
  std::vector<Field> fields;
  const char* at = data.data();
  for (const PcdField& field : header.fields) {
    const Scalar type = scalar_of(field, lines);
    fields.push_back({role(field, type), type, at, stride});
    at += field.bytes * field.count;
  }
  return gather(*header.points, fields, false);
}

/// @return the block after the two sizes, decompressed
std::string decompressed(const Header& header, const LineReader& lines) {
  const std::string_view data = lines.rest();
  if (data.size() < 8) too_short(header, data.size(), lines);
  const std::size_t packed = load<std::uint32_t>(data.data());
  const std::size_t plain = load<std::uint32_t>(data.data() + 4);
  // LZF makes at most 264 bytes of three.
  if (packed > data.size() - 8 || plain > packed * 88) too_short(header, data.size(), lines);
  std::optional<std::string> block = lzf_decompress(data.substr(8, packed), plain);
  if (!block) throw Error(lines.where(), "the compressed block is damaged", "LZF");
  return std::move(*block);
}

/// Field after field, each for all points. PCL leaves fields called `_` out of the block.
Cloud parse_compressed(const Header& header, const LineReader& lines) {
  const std::string block = decompressed(header, lines);
  const auto padding = [](const PcdField& field) { return field.name == "_"; };
  Header without = header;
  without.fields.erase(std::remove_if(without.fields.begin(), without.fields.end(), padding),
                       without.fields.end());
  const std::size_t points = *header.points;
  const bool padded = points == block.size() / header.stride();
  const Header& stored = padded ? header : without;
  if (points > block.size() / stored.stride()) too_short(header, block.size(), lines);
  std::vector<Field> fields;
  const char* at = block.data();
  for (const PcdField& field : stored.fields) {
    const Scalar type = scalar_of(field, lines);
    fields.push_back({role(field, type), type, at, field.bytes * field.count});
    at += field.bytes * field.count * points;
  }
  return gather(points, fields, false);
}

Cloud parse_data(const Header& header, LineReader& lines) {
  if (header.data == "ascii") return parse_ascii(header, lines);
  if (header.data == "binary") return parse_binary(header, lines);
  if (header.data == "binary_compressed") return parse_compressed(header, lines);
  throw Error(lines.where(), "DATA " + in_quotes(header.data),
              "ascii, binary or binary_compressed");
}

// --- writing ------------------------------------------------------------------------------------

/// Where each field of a point is: once for records, once for planes.
struct Stored {
  std::size_t offset_in_point;
  std::size_t bytes;
};

std::vector<Stored> stored_fields() {
  return {{offsetof(Point, x), 4},     {offsetof(Point, y), 4},         {offsetof(Point, z), 4},
          {offsetof(Point, rgba), 4},  {offsetof(Point, footprint), 4}, {offsetof(Point, view), 2},
          {offsetof(Point, origin), 1}};
}

constexpr std::size_t kRecord = 23;

/// @param planes  field after field, not point after point
std::string packed(const Cloud& cloud, bool planes) {
  std::string out(cloud.size() * kRecord, '\0');
  std::size_t offset = 0;
  for (const Stored& field : stored_fields()) {
    char* at = out.data() + (planes ? offset * cloud.size() : offset);
    for (const Point& point : cloud.points) {
      std::memcpy(at, reinterpret_cast<const char*>(&point) + field.offset_in_point, field.bytes);
      at += planes ? field.bytes : kRecord;
    }
    offset += field.bytes;
  }
  return out;
}

std::string compressed_block(const Cloud& cloud, const std::string& where) {
  const std::size_t most = std::numeric_limits<std::uint32_t>::max();
  // Data that cannot be made smaller grow by one byte in 32.
  if (cloud.size() * kRecord / 32 * 33 + 64 > most) {
    throw Error(where, std::to_string(cloud.size()) + " points do not fit a compressed PCD",
                "an uncompressed PCD, or a PLY");
  }
  const std::string plain = packed(cloud, true);
  const std::string block = lzf_compress(plain);
  const std::uint32_t sizes[2] = {static_cast<std::uint32_t>(block.size()),
                                  static_cast<std::uint32_t>(plain.size())};
  return std::string(reinterpret_cast<const char*>(sizes), sizeof sizes) + block;
}

std::string header_text(std::size_t points, bool compressed, const std::string& up) {
  const std::string count = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\n" + cloud_comments(up, "# ", "") +
         "VERSION 0.7\nFIELDS x y z rgb footprint view origin\nSIZE 4 4 4 4 4 2 1\n"
         "TYPE F F F F F U U\nCOUNT 1 1 1 1 1 1 1\nWIDTH " +
         count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " +
         (compressed ? "binary_compressed\n" : "binary\n");
}

}  // namespace

Cloud parse_pcd(std::string_view bytes, const std::string& name, std::size_t* dropped) {
  return guarded(name, [&] {
    LineReader lines(bytes, name);
    const Header header = parse_header(lines);
    Cloud cloud = parse_data(header, lines);
    if (dropped != nullptr) *dropped = *header.points - cloud.size();
    return cloud;
  });
}

Cloud read_pcd(const std::filesystem::path& path, std::size_t* dropped) {
  return guarded(path.string(),
                 [&] { return parse_pcd(FileBytes(path).view(), path.string(), dropped); });
}

void write_pcd(const std::filesystem::path& path, const Cloud& cloud, bool compressed,
               const std::string& up) {
  guarded(path.string(), [&] {
    check_finite(cloud, path.string());
    const std::string data =
        compressed ? compressed_block(cloud, path.string()) : packed(cloud, false);
    AtomicFile file(path);
    file.write(header_text(cloud.size(), compressed, up));
    file.write(data);
    file.commit();
  });
}

}  // namespace ps
