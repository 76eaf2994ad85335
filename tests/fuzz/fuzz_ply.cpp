// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply.h"
#include "tests/fuzz/target.h"

static void parse(std::string_view bytes) { ps::parse_ply(bytes, "fuzz.ply"); }
PS_FUZZ(parse)
