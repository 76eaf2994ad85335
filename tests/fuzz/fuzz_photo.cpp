// SPDX-License-Identifier: BSD-3-Clause
#include "io/exif.h"
#include "io/image_bytes.h"
#include "io/photo.h"
#include "tests/fuzz/target.h"

/// Segments, chunks and EXIF of any file; decoding of all kinds but TIFF, as libtiff is not ours.
static void parse(std::string_view bytes) {
  const ps::Exif exif = ps::parse_exif(ps::check_image_bytes(bytes, "fuzz"));
  (void)exif.focal_px({540, 360});
  if (bytes[0] != 'I' && bytes[0] != 'M') ps::parse_photo(bytes, "fuzz");
}
PS_FUZZ(parse)
