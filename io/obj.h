// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "libps/rooms/model.h"

namespace ps {

struct ObjOptions {
  std::size_t most_triangles = 50000;  ///< a model with more is refused
  int texture_side = 256;              ///< larger pictures are shrunk to this, in pixels
};

/// @brief Gives the bytes of the file that an OBJ names (its MTL, a picture), or nothing when there
/// is none.
using ObjFiles = std::function<std::optional<std::string>(const std::string& file)>;

/// @brief Reads a Wavefront OBJ: v, vt, f, usemtl, mtllib; of materials Kd, d, Tr and map_Kd.
/// Faces of any number of corners become triangles; negative indices count back; points, lines,
/// normals and groups are passed over. A material or picture that is missing leaves the default
/// colour. A textured material's colour is its tint alone, its largest channel 1: exporters write
/// grey or black there and mean the picture. Triangles that mostly lie where their picture is
/// transparent are left out.
/// @param name  stands in messages
/// @return positions, uvs, triangles, materials and textures, in the file's units and axes
/// Throws ps::Error when a line cannot be read, an index points nowhere, a picture is broken, or
/// there are more triangles than `options` allow or none.
rooms::Model parse_obj(std::string_view text, const std::string& name, const ObjFiles& files,
                       const ObjOptions& options = {});

}  // namespace ps
