// SPDX-License-Identifier: BSD-3-Clause
#include "apps/lift_arguments.h"

#include "apps/program.h"

namespace ps::apps {

void add_lift_options(CLI::App& verb, LiftOptions& options) {
  const auto at_least_0 = in_range(0, kNoBound);
  verb.add_option("--min-depth", options.min_depth, "Skip what is nearer, metres")
      ->type_name("M")
      ->check(at_least_0);
  verb.add_option("--max-depth", options.max_depth, "Skip what is farther, metres")
      ->type_name("M")
      ->check(at_least_0);
  verb.add_option("--edge-footprints", options.edge_footprints,
                  "Drop a pixel that flies at a depth edge: so many pixel widths behind one "
                  "neighbour and before the opposite; 0 keeps all")
      ->type_name("F")
      ->check(at_least_0);
}

void check_depth_range(const LiftOptions& options) {
  check_order("--min-depth", options.min_depth, "--max-depth", options.max_depth);
}

}  // namespace ps::apps
