#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Fuzzes every reader for SECONDS in all (60 when not given), from the seeds in corpus/.
# usage: tests/fuzz/run.sh [SECONDS] [BUILD_FOLDER]
# Fails when a target crashes, leaks, hangs, takes more than 2 GB or throws anything but ps::Error; the
# input that did it is left in BUILD_FOLDER/findings.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
seconds=${1:-60}
build=${2:-$here/../../build/fuzz}
set -- "$build"/tests/fuzz/fuzz_*
each=$((seconds / $# > 0 ? seconds / $# : 1))
mkdir -p "$build/findings"
failed=0
for target in "$@"; do
  name=${target##*/fuzz_}
  grown="$build/corpus/$name"
  mkdir -p "$grown"
  if ! UBSAN_OPTIONS=print_stacktrace=1 "$target" -max_total_time="$each" -timeout=10 -rss_limit_mb=2048 \
      -max_len=65536 -verbosity=0 -artifact_prefix="$build/findings/$name-" \
      "$grown" "$here/corpus/$name" > "$build/findings/$name.log" 2>&1; then
    echo "$name: FAILED, see $build/findings" >&2
    tail -n 40 "$build/findings/$name.log" >&2
    failed=1
  else
    echo "$name: clean after $each s"
  fi
done
exit $failed
