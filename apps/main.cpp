// SPDX-License-Identifier: BSD-3-Clause
#include "apps/program.h"

int main(int argc, char** argv) {
  try {
    return ps::apps::run(argc, argv);
  } catch (...) {
    return ps::apps::report_failure();
  }
}
