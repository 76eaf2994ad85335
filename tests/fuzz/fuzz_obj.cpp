// SPDX-License-Identifier: BSD-3-Clause
#include "io/obj.h"
#include "tests/fuzz/target.h"

/// An OBJ, a zero byte, its MTL, a zero byte, a picture: whatever name is asked for.
static void parse(std::string_view bytes) {
  const auto part = [&] {
    const std::size_t end = std::min(bytes.find('\0'), bytes.size());
    const std::string_view taken = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    return taken;
  };
  const std::string_view obj = part(), mtl = part(), picture = bytes;
  ps::parse_obj(obj, "fuzz.obj", [&](const std::string& file) {
    return std::optional<std::string>(file.find("mtl") == std::string::npos ? picture : mtl);
  });
}
PS_FUZZ(parse)
