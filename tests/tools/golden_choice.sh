#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Tests which build golden_sessions.sh takes, and that it says so: a stale one must not answer for newer code.
#
#   golden_choice.sh SCRIPT
set -euo pipefail

script=$1
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
mkdir -p "$root/tools/scripts" "$root/scenes/sessions"
cp "$script" "$root/tools/scripts/golden_sessions.sh"

# make_build NAME: makes programs that say of which build they are.
make_build() {
  local program
  mkdir -p "$root/build/$1/bin"
  for program in camway camwayd; do
    printf '#!/bin/sh\necho "of %s"\n' "$1" >"$root/build/$1/bin/$program"
    chmod +x "$root/build/$1/bin/$program"
  done
}

# expect NAME: the script takes this build.
expect() {
  local said
  said=$("$root/tools/scripts/golden_sessions.sh" maze)
  grep -qF "$root/build/$1/bin/camway: of $1" <<<"$said" && grep -qF "maze: of $1" <<<"$said" && return
  printf 'golden_choice: expected the build %s:\n%s\n' "$1" "$said" >&2
  exit 1
}

make_build dev
expect dev
make_build release
touch -d '1 hour ago' "$root/build/release/bin/"*
expect dev
touch -d '2 hours ago' "$root/build/dev/bin/"*
expect release
