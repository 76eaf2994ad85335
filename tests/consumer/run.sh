#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# run.sh BUILD: installs BUILD into a temporary prefix, then builds project/ against it and runs it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$1" --prefix "$work/prefix" >/dev/null
"$work/prefix/bin/pixelsynth" --version
headers=$work/prefix/include/pixelsynth
if grep -rl '^// Internal to ' "$headers"; then
  echo "these headers were to stay at home" >&2
  exit 1
fi
(cd "$headers" && find . -name '*.h' | sort | sed 's|^./|#include "|; s|$|"|') >"$work/all_headers.cpp"
grep -q camera.h "$work/all_headers.cpp"
cmake -S "$here/project" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_BUILD_TYPE=Release -DALL_HEADERS="$work/all_headers.cpp"
cmake --build "$work/build"
"$work/build/consumer" "$work/cloud.ply"
test -s "$work/cloud.ply"
# The installed program finds its parts.
"$work/prefix/bin/pixelsynth" -q render "$work/cloud.ply" -o "$work/cloud.mp4" --frames 2
test -s "$work/cloud.mp4"
if command -v Xvfb >/dev/null; then
  env -u DISPLAY "$work/prefix/bin/pixelsynth" -q view "$work/cloud.ply" --screenshot "$work/cloud.png"
  test -s "$work/cloud.png"
fi
