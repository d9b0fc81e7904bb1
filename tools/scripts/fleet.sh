#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Runs a fleet on one machine, as an example of how its parts fit: a server of NATS with JetStream, a
# front, and planners. A planner that ends is started again. Ctrl-C ends all.
#
#   tools/scripts/fleet.sh [--planners N] [--folder FOLDER] [--port PORT] [--bin FOLDER] [-- ARGUMENT...]
#
#   --planners  how many planners (3), with one worker each
#   --folder    where the server keeps the scenes of the fleet, and all write their logs (out/fleet)
#   --port      of the server of NATS, on 127.0.0.1 (4222)
#   --bin       where camwayd is (build/release/bin, else build/dev/bin, else where PATH says)
#   ARGUMENT    for the front, such as --scene office=scenes/office.obj
#
# Prints "fleet: ready" when the front serves and all planners plan. Needs the package nats-server.
# Exit code: 0 it was ended by a signal, 1 a part could not be started or the front or the server ended.
set -euo pipefail

root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
planners=3
folder=out/fleet
port=4222
bin=

say() { printf 'fleet: %s\n' "$*"; }
fail() { say "$*" >&2 && exit 1; }
usage() { sed -n '/^# Runs a fleet/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"; }

while [[ $# -gt 0 && $1 != -- ]]; do
  case $1 in
    --planners | --folder | --port | --bin)
      [[ $# -ge 2 ]] || { echo "fleet: $1 needs a value" >&2 && exit 2; }
      declare "${1#--}=$2" ;;
    --help | -h) usage && exit 0 ;;
    *) echo "fleet: unknown argument $1" >&2 && usage >&2 && exit 2 ;;
  esac
  shift 2
done
[[ ${1:-} == -- ]] && shift

for value in "$planners" "$port"; do
  [[ $value =~ ^[0-9]+$ ]] || { echo "fleet: '$value' is no number" >&2 && exit 2; }
done

if [[ -z $bin ]]; then
  for bin in "$root/build/release/bin" "$root/build/dev/bin" ""; do
    [[ -x $bin/camwayd ]] && break
  done
  [[ -n $bin ]] || bin=$(dirname "$(command -v camwayd)") || fail "camwayd is not there: build it first"
fi
export PATH="$PATH:/usr/sbin:/sbin"  # Debian's nats-server lives there
command -v nats-server >/dev/null || fail "nats-server is not there: install the package nats-server"
mkdir -p "$folder"
readonly kServer=nats://127.0.0.1:$port
readonly kPatienceS=60

# Waits until a file has a line with this text, while a process lives.
await_line() {
  local file=$1 text=$2 process=$3 end=$((SECONDS + kPatienceS))
  until grep -q -- "$text" "$file" 2>/dev/null; do
    kill -0 "$process" 2>/dev/null || { tail -n 5 "$file" >&2; return 1; }
    [[ $SECONDS -lt $end ]] || return 1
    sleep 0.05
  done
}

# Keeps a planner running, whatever ends it.
keep_planner() {
  local number=$1 planner=
  trap '[[ -z $planner ]] || kill "$planner" 2>/dev/null; wait; exit 0' TERM INT
  while true; do
    "$bin/camwayd" --role planner --fleet "$kServer" --workers 1 2>>"$folder/planner-$number.log" &
    planner=$!
    wait "$planner" || true
    say "planner $number ended; starting it again"
    sleep 0.2
  done
}

parts=()
stop() {
  trap - TERM INT EXIT
  # The server last: the others tell it that they leave.
  [[ ${#parts[@]} -le 1 ]] || kill "${parts[@]:1}" 2>/dev/null || true
  [[ ${#parts[@]} -le 1 ]] || wait "${parts[@]:1}" 2>/dev/null || true
  [[ ${#parts[@]} -eq 0 ]] || kill "${parts[0]}" 2>/dev/null || true
  wait
}
trap stop EXIT
trap 'stop; exit 0' TERM INT

nats-server --jetstream --store_dir "$folder/nats" --addr 127.0.0.1 --port "$port" \
  --log "$folder/nats-server.log" &
parts+=($!)
await_line "$folder/nats-server.log" "Server is ready" "${parts[0]}" ||
  fail "the server of NATS does not start: see $folder/nats-server.log"
: >"$folder/front.log"
"$bin/camwayd" --role front --fleet "$kServer" "$@" 2>>"$folder/front.log" &
parts+=($!)
await_line "$folder/front.log" "serving" "${parts[1]}" ||
  fail "the front does not start: see $folder/front.log"
for ((number = 1; number <= planners; ++number)); do
  : >"$folder/planner-$number.log"
  keep_planner "$number" &
  parts+=($!)
done
for ((number = 1; number <= planners; ++number)); do
  await_line "$folder/planner-$number.log" "planning" "${parts[number + 1]}" ||
    fail "planner $number does not start: see $folder/planner-$number.log"
done
plural=s
if [[ $planners == 1 ]]; then plural=; fi
say "ready: front, $planners planner$plural, server $kServer; logs in $folder"
wait -n "${parts[0]}" "${parts[1]}" || true
fail "the front or the server of NATS ended: see $folder"
