// SPDX-License-Identifier: BSD-3-Clause
#include "io/mp4.h"
#include "tests/fuzz/target.h"

static void parse(std::string_view bytes) { ps::index_first(std::string(bytes), "fuzz.mp4"); }
PS_FUZZ(parse)
