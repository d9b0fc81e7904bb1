#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Every program with its standard streams closed, in all seven ways: it ends as it does with open ones,
# and its files hold what they hold then. A descriptor 0, 1 or 2 that is free would be the next file or
# socket that is opened, and get what is printed.
#
#   tools/scripts/netns.sh tests/tools/closed_streams.sh PROGRAMS SCENES
#
# Exit code: 0, or 1 with a line for each fault.
set -euo pipefail

kPrograms=$(realpath "$1")
kScenes=$(realpath "$2")
readonly kPrograms kScenes
readonly kWays=('<&-' '>&-' '2>&-' '<&- >&-' '<&- 2>&-' '>&- 2>&-' '<&- >&- 2>&-')
readonly kRequest=$kScenes/requests/maze-free-cells.json
PATH=$kPrograms:$PATH
faults=0
daemon=
folder=$(mktemp -d)
trap '[[ -z $daemon ]] || kill "$daemon" || true; rm -r "$folder"' EXIT
cd "$folder"
mkdir open closed

fault() {
  echo "FAULT $*"
  faults=$((faults + 1))
}

# exit_code_of COMMAND: of a command that writes to nobody.
exit_code_of() {
  local code=0
  timeout 60 bash -c "exec $1" || code=$?
  echo $code
}

# try COMMAND CODE [MUTE_CODE]: it has to end with CODE ("as-open": the one that it ends with where
# nothing is closed), or where standard output is closed with MUTE_CODE, if it prints there. @ in it is
# the folder for its files.
try() {
  local command=$1 expected=$2 way file code right
  code=$(exit_code_of "${command//@/open} >open.out 2>open.err </dev/null")
  [[ $expected != as-open ]] || expected=$code
  [[ $code == "$expected" ]] || fault "$command: ends with $code, not $expected: $(<open.err)"
  for way in "${kWays[@]}"; do
    rm -f closed/*
    code=$(exit_code_of "${command//@/closed} </dev/null >closed.out 2>closed.err $way")
    right=$expected
    [[ " $way" != *' >&-'* ]] || right=${3:-$expected}
    [[ $code == "$right" ]] || fault "$command $way: ends with $code, not $right"
    for file in open/*; do
      [[ -e $file ]] || continue
      cmp -s "$file" "closed/${file#open/}" || fault "$command $way: ${file#open/} is another one"
    done
  done
  rm -f open/*
}

# start_daemon WAY: with its log, if that is open, in daemon.err.
start_daemon() {
  : >daemon.err
  bash -c "exec camwayd --scene maze=$kScenes/maze.obj,occupancy=0.1 --scene-roots $kScenes \
    </dev/null >daemon.out 2>daemon.err $1" &
  daemon=$!
  until camway status >/dev/null 2>&1; do kill -0 "$daemon" || return 1; done
}

stop_daemon() {
  local code=0
  kill "$daemon" || true # it may have died
  wait "$daemon" || code=$?
  daemon=
  [[ $code == 0 ]] || fault "camwayd $1: ends with $code"
}

camway plan --request "$kRequest" --response plan.json --no-timing 2>/dev/null
scene="--scene $kScenes/maze.obj"
path="$scene --request $kRequest --response plan.json"

try "camway plan --request $kRequest --response @/plan.json --no-timing" 0
try "camway plan --request $kRequest --no-timing" 0 2
try "camway plan --request nowhere.json" 2
try "camway plan --request -" 2
try "camway check $path --json" 0 2
try "camway info $scene" 0 2
try "camway info --scene nowhere.obj" 2
try "camway occupancy $scene --resolution 0.2 --point 1,1,1 --write @/map.bt" 0 2
try "camway draw $path --picture @/plan.svg" 0
try "camway status --url bogus://" 2
try "camwayd --version" 0 2
try "camwayd --scene maze=$kScenes/maze.obj --check-config" 0 2
try "camwayd --scene nowhere.obj --check-config" 2

start_daemon ''
lcm-logger --quiet session.lcmlog &
logger=$!
until [[ -e session.lcmlog ]]; do sleep 0.1; done
camway load --scene "maze=$kScenes/maze.obj" --request "$kRequest" --seconds 1 >/dev/null
kill -INT $logger
wait $logger || true

try "camway replay session.lcmlog --scene maze=$kScenes/maze.obj" 0 2
try "camway load --scene maze=$kScenes/maze.obj --request $kRequest --seconds 0.2" 0 2
try "camway status --json" 0 2
try "camway scene describe maze" 0 2
try "camway scene export maze --to @/map.bt" 0 2
try "camway scene load uploaded --upload $kScenes/maze.obj" 0 2
try "camway scene describe nowhere" 2
try "camway occupancy --daemon maze --point 1,1,1" 0 2
try "camway watch nowhere --request $kRequest" 2
try "camway doctor" as-open 2
stop_daemon 'with open streams'

for way in "${kWays[@]}"; do
  start_daemon "$way" || fault "camwayd $way: does not come up"
  camway load --scene "maze=$kScenes/maze.obj" --request "$kRequest" --seconds 0.2 >/dev/null \
    || fault "camwayd $way: answers are wrong or lost"
  stop_daemon "$way"
  [[ ! -s daemon.out ]] || fault "camwayd $way: prints $(<daemon.out)"
done

echo "$faults faults"
[[ $faults == 0 ]]
