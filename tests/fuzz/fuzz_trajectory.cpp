// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.h"
#include "tests/fuzz/target.h"

static void parse(std::string_view bytes) {
  // The first byte chooses the name, by which two formats are told.
  const char* const names[] = {"fuzz.txt", "images.txt", "fuzz.log"};
  if (!bytes.empty())
    ps::parse_trajectory(bytes.substr(1), names[static_cast<unsigned char>(bytes[0]) % 3]);
}
PS_FUZZ(parse)
