// SPDX-License-Identifier: BSD-3-Clause
#include "io/safetensors.h"
#include "tests/fuzz/target.h"

static void parse(std::string_view bytes) { ps::parse_safetensors(bytes, "fuzz.safetensors"); }
PS_FUZZ(parse)
