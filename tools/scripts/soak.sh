#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Loads a daemon for a long time and judges it: no answer lost, none wrong, and its memory grows by
# no more than 1 % once its caches are full.
#
#   tools/scripts/soak.sh [--seconds N] [--clients N] [--bin FOLDER] [--json FILE]
#
#   --seconds   how long (3600); the first tenth, at least a minute, counts as warm-up
#   --clients   how many ask at the same time (8)
#   --bin       where camwayd and camway are (build/release/bin, else build/dev/bin)
#   --json      where the measurements go, memory over time among them
#
# Runs in a private network namespace (tools/scripts/netns.sh). Exit code: 0 all is well, 3 it is not,
# anything else: there was no soak.
set -euo pipefail

root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
seconds=3600
clients=8
bin=
json=

usage() { sed -n '/^# Loads a daemon/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"; }

while [[ $# -gt 0 ]]; do
  case $1 in
    --seconds) seconds=$2 ;;
    --clients) clients=$2 ;;
    --bin) bin=$2 ;;
    --json) json=$2 ;;
    --help | -h) usage && exit 0 ;;
    *) echo "soak: unknown argument $1" >&2 && usage >&2 && exit 2 ;;
  esac
  shift 2
done

if [[ -z $bin ]]; then
  bin=$root/build/release/bin
  [[ -x $bin/camwayd ]] || bin=$root/build/dev/bin
fi
[[ -x $bin/camwayd && -x $bin/camway ]] || { echo "soak: no camwayd and camway in $bin" >&2; exit 2; }
[[ -n ${CAMWAY_NETNS:-} ]] || exec "$root/tools/scripts/netns.sh" "${BASH_SOURCE[0]}" --seconds "$seconds" \
  --clients "$clients" --bin "$bin" ${json:+--json "$json"}

"$bin/camwayd" --scene "office=$root/scenes/office.obj" --log-level warn &
daemon=$!
trap 'kill "$daemon" 2>/dev/null || true; wait "$daemon" || true' EXIT

warm_up=$((seconds / 10 > 60 ? seconds / 10 : 60))
requests=()
for request in "$root"/scenes/requests/office-{free,graze}-*.json; do
  requests+=(--request "$request")
done
"$bin/camway" load --scene "office=$root/scenes/office.obj" "${requests[@]}" --clients "$clients" \
  --seconds "$seconds" --daemon-pid "$daemon" --warm-up-s "$warm_up" --max-growth-percent 1 \
  ${json:+--json "$json"}
