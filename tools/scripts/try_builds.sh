#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Builds Camway in the ways that others build it, and not as the presets do, and says which of them fail
# or print a warning.
#
#   tools/scripts/try_builds.sh [--quick] [WAY...]
#
#   WAY      of these; all if none is named:
#            plain          cmake -S . -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build
#            without-tests  the same with -DCAMWAY_TESTS=OFF
#            O3             with asserts, at -O3
#            clang          with the oldest Clang that is supported, 14
#            subproject     as a part of another project: add_subdirectory and FetchContent
#   --quick  without the tests, and without optimisation: tells whether the code compiles and links that
#            way and what the front end warns of, in a third of the time; CI does so with `plain`
#
# Builds in build/try/WAY, with ccache where it is installed; CCACHE_DISABLE=1 tries all anew. Exit code:
# 0 all are good, 1 else.
set -euo pipefail
cd "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../.."

readonly kName=try_builds
readonly kWays=(plain without-tests O3 clang subproject)
# shellcheck source=tools/scripts/steps.sh
source tools/scripts/steps.sh

usage() { sed -n '/^# Builds/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "tools/scripts/try_builds.sh"; }

quick=false
ways=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --quick) quick=true ;;
    --help | -h) usage && exit 0 ;;
    *)
      [[ " ${kWays[*]} " == *" $1 "* ]] || { say "$1 is no way to build" >&2; usage >&2; exit 1; }
      ways+=("$1")
      ;;
  esac
  shift
done
[[ ${#ways[@]} -gt 0 ]] || ways=("${kWays[@]}")
if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi

# configure_and_build FOLDER OPTION...: with CMake's own generator, as nobody chose one.
configure_and_build() {
  local folder=$1
  shift
  if $quick; then
    set -- "$@" -DCAMWAY_TESTS=OFF -DCMAKE_CXX_FLAGS_RELEASE="-O0 -DNDEBUG" \
      -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O0
  fi
  cmake -S . -B "$folder" "$@" && cmake --build "$folder" --parallel "$(build_jobs)"
}

try() {
  local folder=build/try/$1
  case $1 in
    plain) configure_and_build "$folder" -DCMAKE_BUILD_TYPE=Release ;;
    without-tests) configure_and_build "$folder" -DCMAKE_BUILD_TYPE=Release -DCAMWAY_TESTS=OFF ;;
    O3)
      configure_and_build "$folder" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
        -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O3 -g1"
      ;;
    clang)
      configure_and_build "$folder" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++-14
      ;;
    subproject)
      cmake -DSOURCE_DIR="$PWD" -DWORK_DIR="$PWD/$folder" -DCOMPILE=ON -P tests/build/subproject.cmake
      ;;
  esac
}

bad=()
for way in "${ways[@]}"; do
  say "$way"
  log=build/try/$way.log
  mkdir -p build/try
  start=$SECONDS
  verdict=good
  try "$way" >"$log" 2>&1 || verdict="FAILED, see $log"
  warnings=$(grep -cE '(: |CMake )[Ww]arning' "$log" || true)
  if [[ $verdict == good && $warnings -gt 0 ]]; then verdict="$warnings warnings, see $log"; fi
  say "$way: $verdict ($((SECONDS - start)) s)"
  [[ $verdict == good ]] || bad+=("$way")
done
[[ ${#bad[@]} -eq 0 ]]
