// SPDX-License-Identifier: BSD-3-Clause
#include "io/cloud_file.h"

#include "io/pcd.h"
#include "io/ply.h"
#include "io/text.h"
#include "libps/core/error.h"

namespace ps {
namespace {

bool is_pcd(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension != ".ply" && extension != ".pcd") {
    throw Error(path.string(), "is no cloud by its name", ".ply or .pcd");
  }
  return extension == ".pcd";
}

}  // namespace

Cloud read_cloud(const std::filesystem::path& path, std::size_t* dropped) {
  return is_pcd(path) ? read_pcd(path, dropped) : read_ply(path, dropped);
}

void write_cloud(const std::filesystem::path& path, const Cloud& cloud, const std::string& up,
                 bool compressed) {
  is_pcd(path) ? write_pcd(path, cloud, compressed, up) : write_ply(path, cloud, up);
}

std::string cloud_comments(const std::string& up, const std::string& begin,
                           const std::string& scalar) {
  const std::string axes = up.empty() ? "those of the poses" : "of the world, " + up + " is up";
  std::string text;
  for (const std::string& line :
       {std::string("pixelsynth " PIXELSYNTH_VERSION), std::string("units metres"),
        "axes " + axes + "; cameras x right, y down, z forward",
        scalar + "footprint metres that one pixel covered",
        scalar + "view number of the view that added the point",
        scalar + "origin 0 observed, 1 outpainted"}) {
    text += begin + line + "\n";
  }
  return text;
}

}  // namespace ps
