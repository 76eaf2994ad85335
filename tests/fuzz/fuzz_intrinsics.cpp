// SPDX-License-Identifier: BSD-3-Clause
#include "io/intrinsics_file.h"
#include "tests/fuzz/target.h"

static void parse(std::string_view bytes) { ps::parse_intrinsics(bytes, "fuzz.txt", 540, 360); }
PS_FUZZ(parse)
