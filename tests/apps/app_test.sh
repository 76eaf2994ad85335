#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# app_test.sh PROGRAM SAMPLES SNIPPET: runs the snippet in an empty folder; every line of it must succeed;
# one claim for each line, as `A && B` cannot fail under set -e unless it is the last.
# In it, `pixelsynth` is the program, $S the samples, and these are claims:
set -euo pipefail
program=$1 S=$2 snippet=$3
shared=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../../../shared
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/here"
cd "$work/here"
unset DISPLAY

complain() {
  echo "$*" >&2
  [ ! -s "$work/err" ] || sed 's/^/stderr: /' "$work/err" >&2
  exit 1
}

# is OPERANDS...: `[` says so. Under set -e a failing `[ A ] && [ B ]` ends nothing; this ends the test.
is() { [ "$@" ] || complain "not: $*"; }

pixelsynth() { $program "$@"; }

# fails STATUS PATTERN ARGS...: this status, one line on stderr that matches, nothing new or half-written.
fails() {
  local status=$1 pattern=$2 got=0 before
  before=$(find . | sort)
  shift 2
  $program "$@" >"$work/out" 2>"$work/err" || got=$?
  [ "$got" -eq "$status" ] || complain "exit status is $got instead of $status"
  [ "$(wc -l <"$work/err")" -eq 1 ] || complain "stderr has $(wc -l <"$work/err") lines, not one"
  grep -q '^pixelsynth' "$work/err" || complain "the line does not begin with the program's name"
  grep -Eq -- "$pattern" "$work/err" || complain "the line does not match $pattern"
  [ "$(find . | sort)" = "$before" ] || complain "something was written: $(find . | sort)"
}

# works ARGS...: status 0, nothing unfinished is left. What it said is in $work/out and $work/err.
works() {
  $program "$@" >"$work/out" 2>"$work/err" || complain "exit status is $?"
  [ -z "$(find . -name '*partial*' -o -name '.?*' -o -name '*.tmp*')" ] || complain "left: $(find .)"
}

# says PATTERN: the last run's stderr matches.   prints PATTERN: its stdout does.
says() { grep -Eq -- "$1" "$work/err" || complain "stderr does not match $1"; }
prints() { grep -Eq -- "$1" "$work/out" || complain "stdout does not match $1: $(cat "$work/out")"; }

# writes FILE...: these are there and not empty.
writes() {
  local file
  for file in "$@"; do [ -s "$file" ] || complain "$file is missing or empty"; done
}

# json KEY FILE: the value of a top-level number.
json() { sed -n "s/^  \"$1\": \(.*[^,]\),*$/\1/p" "$2"; }

# size_of PICTURE-OR-VIDEO: 96x64
size_of() { ffprobe -v error -show_entries stream=width,height -of csv=p=0:s=x "$1" | head -n 1; }

# pixel PICTURE X Y: its colour, "255 0 0"; of what is no picture, words that no other has
pixel() { ffmpeg -v error -i "$1" -vf "crop=1:1:$2:$3" -f rawvideo -pix_fmt rgb24 - | od -An -tu1 | xargs || echo "no pixel of $1"; }

needs() { command -v "$1" >/dev/null || { echo "skipped: $1 is not installed"; exit 77; }; }
needs_shared() { [ -e "$shared/$1" ] || { echo "skipped: ../shared/$1 is not there"; exit 77; }; }

eval "$snippet"
