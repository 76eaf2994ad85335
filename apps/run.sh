#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# apps/run.sh VERB ARGS: runs pixelsynth, from any folder. On a fresh Debian 12 it first installs
# what is missing and builds; later it builds only what has changed. Try apps/run.sh --help.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

prepare() {
  flock 9  # two runs at once build once
  install_packages
  build release pixelsynth
}
prepare 9>"$root/build/.lock"
exec "$root/build/release/apps/pixelsynth" "$@"
