#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Fuzzes what reads bytes of strangers, with libFuzzer and the address and undefined-behaviour
# sanitizers, for as long as one likes. The tests do the same for seconds, without clang.
#
#   tools/scripts/fuzz.sh [--seconds N] [--jobs N] [TARGET...]
#
#   --seconds   how long for each target (600)
#   --jobs      compilers at a time (one for each core)
#   TARGET      of these; all if none is named:
#               wire sent_mesh envelope key_file fleet fleet_parts mesh points unigrafix bezier camera_file
#               import_record map_file inventor_file cache_file change_record log_message
#               stream_answer source_record request_json response_json path_json session pack config door_message
#
# Needs clang 16 or later, as older ones cannot read the ranges of Debian's C++ library (apt-get install
# --no-install-recommends clang-16 libclang-rt-16-dev). Builds in build/fuzz. What was found to be of interest stays
# in build/fuzz/corpus/TARGET, and the next run goes on from there; inputs that broke something are
# in build/fuzz/found. Exit code: 0 nothing was found, 3 something was, anything else: it did not run.
set -euo pipefail

root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
build=$root/build/fuzz
seconds=600
jobs=$(nproc)
targets=()
readonly kTargets=(wire sent_mesh envelope key_file fleet fleet_parts mesh points unigrafix bezier camera_file
  import_record map_file inventor_file cache_file change_record log_message stream_answer source_record
  request_json response_json path_json session pack config door_message)

usage() { sed -n '/^# Fuzzes/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"; }

while [[ $# -gt 0 ]]; do
  case $1 in
    --seconds) seconds=$2 && shift ;;
    --jobs) jobs=$2 && shift ;;
    --help | -h) usage && exit 0 ;;
    *)
      [[ " ${kTargets[*]} " == *" $1 "* ]] || { echo "fuzz: $1 is no target" >&2; usage >&2; exit 2; }
      targets+=("$1")
      ;;
  esac
  shift
done
[[ ${#targets[@]} -gt 0 ]] || targets=("${kTargets[@]}")
newest_clang() {
  local name
  for name in clang++-{19,18,17,16} clang++; do
    command -v "$name" >/dev/null || continue
    [[ $("$name" -dumpversion) =~ ^(1[6-9]|[2-9][0-9])\. ]] && echo "$name" && return
  done
  echo "fuzz: needs clang 16 or later: apt-get install --no-install-recommends clang-16" \
    "libclang-rt-16-dev" >&2
  return 2
}
clang=$(newest_clang)

cd "$root"
# Warnings are no errors here: the preset is for GCC, and a newer Clang warns of more.
cmake --preset dev -B "$build" -DCMAKE_CXX_COMPILER="$clang" -DCAMWAY_FUZZ=ON -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF \
  -DCAMWAY_SANITIZE=fuzzer-no-link,address,undefined >/dev/null
cmake --build "$build" --parallel "$jobs" --target "${targets[@]/#/fuzz_}"

mkdir -p "$build/found"
found=0
for target in "${targets[@]}"; do
  corpus=$build/corpus/$target
  CAMWAY_WRITE_SEEDS=$corpus "$build/bin/fuzz_$target"
  echo "fuzz: $target for $seconds s"
  "$build/bin/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=4096 \
    -max_len=70000 -print_final_stats=1 -artifact_prefix="$build/found/$target-" "$corpus" \
    >"$build/$target.log" 2>&1 || { found=3; tail -n 40 "$build/$target.log"; }
  grep -E '^stat::(number_of_executed_units|average_exec_per_sec|peak_rss_mb)|cov: ' "$build/$target.log" |
    tail -n 4
done
if [[ $found -eq 0 ]]; then echo "fuzz: nothing was found"; else echo "fuzz: see build/fuzz/found"; fi
exit $found
