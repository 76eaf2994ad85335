#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# tests/run.sh: installs what is missing, builds, and runs all tests; then again under the address
# and undefined-behaviour sanitizers, the rooms with threads under the thread sanitizer, and the
# readers under libFuzzer.
# tests/run.sh --quick: all tests, no sanitizers.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../apps/setup.sh"

summary=""
failed=0

# suite NAME PRESET CTEST-ARGS...: runs tests of a build and keeps ctest's closing line.
suite() {
  local name=$1 dir=$root/build/$2 start=$SECONDS status=0
  shift 2
  ctest --test-dir "$dir" --output-on-failure --no-tests=error -j "$(nproc)" "$@" |
    tee "$dir.ctest.log" || status=$?
  [ "$status" -eq 0 ] || failed=1
  summary+="$name: $(grep 'tests passed' "$dir.ctest.log" || echo 'no test ran')"
  summary+=" ($((SECONDS - start)) s)"$'\n'
}

# warnings_are_errors PRESET: in this build, from now on. (Users' compilers may know more warnings.)
warnings_are_errors() {
  local cache=$root/build/$1/CMakeCache.txt
  if ! grep -qs '^PIXELSYNTH_WERROR:BOOL=ON' "$cache"; then
    (cd "$root" && cmake --preset "$1" -DPIXELSYNTH_WERROR=ON) >"$root/build/$1.log" 2>&1 || {
      tail -n 20 "$root/build/$1.log" >&2
      return 1
    }
  fi
}

sanitized() {
  local readers=("$root"/tests/fuzz/fuzz_*.cpp)
  readers=("${readers[@]##*/}")
  build asan
  suite "address, undefined" asan -LE networks
  export TSAN_OPTIONS=suppressions=$root/tests/tsan.supp
  build tsan core_test eval_test geometry_test nn_test models_test outpaint_test scene_test
  # Features of photos are found by OpenCV's threads, not by ours, and take minutes here; whole
  # scenes go through the same loops as their parts, which are tested here.
  suite threads tsan \
    -E '_NOT_BUILT|^Apps|^Install|SecondPose|SecondView|PhotoMatches|MatchPhotos|Stress|Knobs|ViewMethod'
  build fuzz "${readers[@]%.cpp}"
  if "$root/tests/fuzz/run.sh"; then
    summary+="fuzz: every reader is clean"$'\n'
  else
    summary+="fuzz: a reader FAILED"$'\n'
    failed=1
  fi
}

case "${1:-}" in
  "" | --quick) ;;
  *)
    echo "usage: tests/run.sh [--quick]" >&2
    exit 2
    ;;
esac
install_packages
warnings_are_errors release
build release
suite tests release
[ "${1:-}" = --quick ] || sanitized
printf '\n%s' "$summary"
exit "$failed"
