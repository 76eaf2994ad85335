// SPDX-License-Identifier: BSD-3-Clause
#include "io/depth_file.h"
#include "tests/fuzz/target.h"

/// PFM (ours) and PNG (libpng by OpenCV); other decoders are not ours to fuzz.
static void parse(std::string_view bytes) {
  const char first = bytes.empty() ? 0 : bytes[0];
  if (first == 'P' || first == '\x89') ps::parse_depth(bytes, "fuzz");
}
PS_FUZZ(parse)
