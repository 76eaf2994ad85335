// SPDX-License-Identifier: BSD-3-Clause
#include "io/weights_file.h"
#include "tests/fuzz/target.h"

static void parse(std::string_view bytes) { ps::parse_weights(bytes, "fuzz.pth"); }
PS_FUZZ(parse)
