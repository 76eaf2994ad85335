// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "apps/context.h"

namespace ps::apps {

/// @brief Adds `train data`: shards of examples (libps/train/shard.h) from rooms or real frames.
void add_train_data(CLI::App& train, const Context& context);

}  // namespace ps::apps
