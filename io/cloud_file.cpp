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

Cloud read_cloud(const std::filesystem::path& path) {
  return is_pcd(path) ? read_pcd(path) : read_ply(path);
}

void write_cloud(const std::filesystem::path& path, const Cloud& cloud, const std::string& up) {
  is_pcd(path) ? write_pcd(path, cloud) : write_ply(path, cloud, up);
}

}  // namespace ps
