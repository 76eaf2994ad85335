# SPDX-License-Identifier: BSD-3-Clause
# What apps/run.sh and tests/run.sh share; to be sourced. Everything here speaks on stderr alone.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Installs what is missing of apps/packages.txt. Asks dpkg once, so it costs nothing when all is there.
install_packages() {
  local wanted missing as_root=()
  wanted=$(sed 's/#.*//' "$root/apps/packages.txt" | tr -s ' \n' '\n' | sort -u | sed '/^$/d')
  missing=$(comm -23 <(echo "$wanted") <(
    dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null |
      sed -n 's/^installed //p' | sort -u))
  [ -z "$missing" ] && return
  echo "pixelsynth: installing" $missing >&2
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  export DEBIAN_FRONTEND=noninteractive
  if ! { "${as_root[@]}" apt-get update -q && "${as_root[@]}" apt-get install -q -y \
    --no-install-recommends $missing; } >"$root/build/packages.log" 2>&1; then
    tail -n 5 "$root/build/packages.log" >&2
    echo "pixelsynth: packages could not be installed; build/packages.log says more" >&2
    return 1
  fi
}

# build PRESET TARGET...: configures once, then builds what is older than its sources.
build() {
  local preset=$1 quiet=(--quiet)
  local dir=$root/build/$preset
  shift
  if [ ! -f "$dir/build.ninja" ]; then
    (cd "$root" && cmake --preset "$preset") >"$dir.log" 2>&1 || {
      tail -n 20 "$dir.log" >&2
      return 1
    }
  fi
  if ninja -C "$dir" -n "$@" | grep -q 'no work to do'; then return; fi
  echo "pixelsynth: building $preset; the first time takes minutes" >&2
  [ -t 2 ] && quiet=()
  ninja -C "$dir" "${quiet[@]}" "$@" >&2
}

mkdir -p "$root/build"
