// SPDX-License-Identifier: BSD-3-Clause
#include "apps/probe.h"
#include "apps/program.h"

namespace ps::apps {

void add_probe(CLI::App& program, const Context& context) {
  auto* probe = program.add_subcommand(
      "probe", "Runs one module on saved tensors, so that implementations can be compared.");
  probe->require_subcommand(1);
  add_probe_splat(*probe, context);
  add_probe_networks(*probe, context);
  add_probe_outpaint(*probe, context);
}

}  // namespace ps::apps
