// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd.h"
#include "tests/fuzz/target.h"

static void parse(std::string_view bytes) { ps::parse_pcd(bytes, "fuzz.pcd"); }
PS_FUZZ(parse)
