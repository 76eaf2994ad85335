// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/obj.h"
#include "libps/rooms/model.h"

namespace ps {

/// Where Debian's package sweethome3d-furniture puts its catalogues.
inline constexpr const char* kDebianFurniture = "/usr/share/sweethome3d/furniture";

/// Who made how many of the models that were taken, and what allows their use.
struct FurnitureCredit {
  std::string catalogue, creator, licence;
  int models = 0;
};

struct Furniture {
  std::vector<rooms::Model> models;
  std::vector<FurnitureCredit> credits;  ///< of `models`, sorted by catalogue and creator
  std::vector<std::string> left_out;     ///< one line for each model that was not taken, and why
};

/// @return whether a licence, as a catalogue words it, is the public domain, CC0 or CC BY; not when
/// it asks for more (share alike) or forbids use or changes
bool is_free_licence(std::string_view licence);

/// @brief Reads a Sweet Home 3D catalogue (.sh3f: a zip archive of OBJ files, listed in
/// PluginFurnitureCatalog.properties). Each model is turned by its modelRotation, scaled along each
/// axis to the catalogue's size and stood on the origin, as rooms::Model says.
/// Left out: models without a free licence, larger than `options` allow, or broken.
/// Throws ps::Error when the archive or its list cannot be read.
Furniture parse_furniture(std::string_view bytes, const std::string& name,
                          const ObjOptions& options = {});

/// @brief The same from a .sh3f file, or from all those of a folder in the order of their names.
/// Throws ps::Error when there is none.
Furniture read_furniture(const std::filesystem::path& path, const ObjOptions& options = {});

}  // namespace ps
