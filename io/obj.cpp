// SPDX-License-Identifier: BSD-3-Clause
#include "io/obj.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "io/bytes.h"
#include "io/mtl.h"
#include "io/polygon.h"
#include "io/text.h"

namespace ps {
namespace {

using rooms::Model;

/// What a texture takes away shows at points of a triangle on a grid of this many steps a side.
constexpr int kCutSteps = 6;

struct Reader {
  Reader(std::string_view text, const std::string& file, const ObjFiles& open,
         const ObjOptions& limits)
      : lines(text, file), name(file), files(open), options(limits) {}

  LineReader lines;
  const std::string& name;
  const ObjFiles& files;
  const ObjOptions& options;
  Model model;
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<float, 2>> uvs;
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> position_at;   ///< of each vertex, the position it last gave
  std::vector<std::uint32_t> other, uv_of;  ///< of each position: the vertex's one before, its uv
  std::vector<std::uint32_t> face;          ///< of the line that is read: positions
  std::vector<std::array<float, 3>> polygon;
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<std::string> libraries;
  std::map<std::string, std::uint32_t> materials;  ///< of the model, by name
  std::uint32_t material = 0;

  void read();
  void read_face(std::string_view line);
  std::uint32_t read_corner(std::string_view token);
  std::size_t index(std::string_view token, std::size_t count) const;
  template <std::size_t n>
  std::array<float, n> numbers(std::string_view line) const;
  void use(const std::string& wanted);
  std::vector<Mask> paint();
  void cut(const std::vector<Mask>& opaque);
};

template <std::size_t n>
std::array<float, n> Reader::numbers(std::string_view line) const {
  std::array<float, n> values;
  for (float& value : values) {
    value = static_cast<float>(take_finite(line, lines, "a coordinate"));
    if (!std::isfinite(value)) throw Error(lines.where(), "a coordinate is too large");
  }
  return values;
}

/// @return what an index of the file, which counts from 1 or back from -1, points to
std::size_t Reader::index(std::string_view token, std::size_t count) const {
  const std::optional<std::int64_t> value = to_number<std::int64_t>(token);
  const auto most = static_cast<std::int64_t>(count);
  if (!value || *value == 0 || *value > most || *value < -most) {
    throw Error(lines.where(), "a face's corner is " + in_quotes(token),
                "an index up to " + std::to_string(count));
  }
  return static_cast<std::size_t>(*value > 0 ? *value - 1 : most + *value);
}

/// `vertex`, `vertex/uv`, `vertex//normal` or `vertex/uv/normal`.
std::uint32_t Reader::read_corner(std::string_view token) {
  const std::size_t slash = std::min(token.find('/'), token.size());
  const std::size_t vertex = index(token.substr(0, slash), vertices.size());
  token.remove_prefix(std::min(slash + 1, token.size()));
  const std::string_view uv_token = token.substr(0, token.find('/'));
  const std::size_t uv = uv_token.empty() ? 0 : index(uv_token, uvs.size()) + 1;
  for (std::uint32_t p = position_at[vertex]; p != kNone; p = other[p]) {
    if (uv_of[p] == uv) return p;
  }
  const auto fresh = static_cast<std::uint32_t>(model.positions.size());
  other.push_back(position_at[vertex]);
  uv_of.push_back(static_cast<std::uint32_t>(uv));
  position_at[vertex] = fresh;
  model.positions.push_back(vertices[vertex]);
  model.uvs.push_back(uv == 0 ? std::array<float, 2>{} : uvs[uv - 1]);
  return fresh;
}

void Reader::read_face(std::string_view line) {
  const std::size_t count = count_tokens(line);
  if (count < 3) return;
  if (model.triangles.size() + count - 2 > options.most_triangles) {
    throw Error(name, "has more than " + std::to_string(options.most_triangles) + " triangles",
                "a simpler model");
  }
  if (materials.empty()) use("");
  face.clear();
  polygon.clear();
  position_at.resize(vertices.size(), kNone);
  for (std::size_t i = 0; i < count; ++i) {
    face.push_back(read_corner(next_token(line)));
    polygon.push_back(model.positions[face.back()]);
  }
  triangulate(polygon, triangles);
  for (const auto& [a, b, c] : triangles) {
    model.triangles.push_back({{face[a], face[b], face[c]}, material});
  }
}

void Reader::use(const std::string& wanted) {
  const auto count = static_cast<std::uint32_t>(materials.size());
  material = materials.emplace(wanted, count).first->second;
}

void Reader::read() {
  for (std::string_view line; lines.next_content(line);) {
    const std::string_view key = next_token(line);
    if (key == "v") {
      vertices.push_back(numbers<3>(line));
    } else if (key == "vt") {
      uvs.push_back(numbers<2>(line));
    } else if (key == "f") {
      read_face(line);
    } else if (key == "usemtl") {
      use(std::string(trimmed(line)));
    } else if (key == "mtllib") {
      libraries.emplace_back(trimmed(line));
    }
  }
  if (model.triangles.empty()) throw Error(name, "has no triangles", "one at least");
}

/// Fills in the materials that are used, and their textures.
/// @return where each texture is opaque
std::vector<Mask> Reader::paint() {
  std::map<std::string, MtlMaterial> defined;
  for (const std::string& library : libraries) {
    if (const auto text = files(library)) parse_mtl(*text, library, defined);
  }
  std::map<std::string, int> textures;
  std::vector<Mask> opaque;
  model.materials.resize(materials.size());
  for (const auto& [wanted, number] : materials) {
    const MtlMaterial& from = defined[wanted];
    rooms::ModelMaterial& to = model.materials[number];
    to.color = from.color;
    to.opacity = from.opacity;
    if (from.texture.empty()) continue;
    const auto [found, fresh] = textures.emplace(from.texture, -1);
    const auto bytes = fresh ? files(from.texture) : std::nullopt;
    if (bytes) {
      CutTexture texture = parse_texture(*bytes, from.texture, options.texture_side);
      found->second = static_cast<int>(model.textures.size());
      model.textures.push_back(std::move(texture.texture));
      opaque.push_back(texture.opaque);
    }
    to.texture = found->second;
    const float tint = *std::max_element(to.color.begin(), to.color.end());
    if (to.texture < 0) continue;
    for (float& channel : to.color) channel = tint > 0 ? channel / tint : 1;
  }
  return opaque;
}

/// @return the pixel of a side of `count` where a coordinate lies, in a picture that repeats
int wrapped(double coordinate, int count) {
  const double share = coordinate - std::floor(coordinate);
  return std::min(static_cast<int>(share * count), count - 1);
}

/// Leaves out the triangles that their texture mostly takes away.
void Reader::cut(const std::vector<Mask>& opaque) {
  const auto gone = [&](const Model::Triangle& triangle) {
    const int texture = model.materials[triangle.material].texture;
    if (texture < 0 || opaque[static_cast<std::size_t>(texture)].empty()) return false;
    const Mask& mask = opaque[static_cast<std::size_t>(texture)];
    const auto &a = model.uvs[triangle.corners[0]], &b = model.uvs[triangle.corners[1]],
               &c = model.uvs[triangle.corners[2]];
    int seen = 0;
    for (int i = 0; i < kCutSteps; ++i) {
      for (int j = 0; j + i < kCutSteps; ++j) {
        const double s = (i + 1.0 / 3) / kCutSteps, t = (j + 1.0 / 3) / kCutSteps;
        const auto at = [&](std::size_t axis) {
          return a[axis] * (1 - s - t) + b[axis] * s + c[axis] * t;
        };
        seen += mask(wrapped(-at(1), mask.rows), wrapped(at(0), mask.cols)) != 0 ? 1 : -1;
      }
    }
    return seen < 0;
  };
  auto& all = model.triangles;
  all.erase(std::remove_if(all.begin(), all.end(), gone), all.end());
  if (all.empty()) throw Error(name, "all of it is transparent", "a triangle that is seen");
}

}  // namespace

Model parse_obj(std::string_view text, const std::string& name, const ObjFiles& files,
                const ObjOptions& options) {
  return guarded(name, [&] {
    Reader reader(text, name, files, options);
    reader.read();
    reader.cut(reader.paint());
    if (reader.model.textures.empty()) reader.model.uvs = {};
    return std::move(reader.model);
  });
}

}  // namespace ps
