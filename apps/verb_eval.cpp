// SPDX-License-Identifier: BSD-3-Clause
#include "apps/verb_eval.h"

#include "apps/program.h"

namespace ps::apps {

void add_eval(CLI::App& program, const Context& context) {
  auto* eval = program.add_subcommand("eval", "Measures: depth, views against true ones, how well views agree, clouds, and what people prefer.");
  eval->require_subcommand(1);
  add_eval_depth(*eval, context);
  add_eval_views(*eval, context);
  add_eval_consistency(*eval, context);
  add_eval_cloud(*eval, context);
  add_eval_ab(*eval, context);
}

}  // namespace ps::apps
