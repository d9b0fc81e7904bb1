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
daemon=
folder=$(mktemp -d)
trap '[[ -z $daemon ]] || kill "$daemon" || true; rm -r "$folder"' EXIT
cd "$folder"
: >faults

fault() {
  echo "FAULT $*" >>faults
}

# exit_code_of COMMAND: of a command that writes to nobody.
exit_code_of() {
  local code=0
  timeout 60 bash -c "exec $1" || code=$?
  echo $code
}

# try COMMAND CODE [MUTE_CODE]: it has to end with CODE ("as-open": the one that it ends with where
# nothing is closed), or where standard output is closed with MUTE_CODE, if it prints there. @ in it is
# the folder for its files. The ways to close run at the same time, because most commands wait.
try() {
  local command=$1 expected=$2 i code jobs=()
  mkdir open
  code=$(exit_code_of "${command//@/open} >open.out 2>open.err </dev/null")
  [[ $expected != as-open ]] || expected=$code
  [[ $code == "$expected" ]] || fault "$command: ends with $code, not $expected: $(<open.err)"
  for i in "${!kWays[@]}"; do
    try_closed "$command" "$expected" "${3:-$expected}" "${kWays[i]}" "closed$i" &
    jobs+=($!)
  done
  wait_for "${jobs[@]}"
  rm -r open closed?
}

# try_closed COMMAND CODE MUTE_CODE WAY FOLDER
try_closed() {
  local command=$1 right=$2 way=$4 folder=$5 file code
  mkdir "$folder"
  code=$(exit_code_of "${command//@/$folder} </dev/null >$folder.out 2>$folder.err $way")
  [[ " $way" != *' >&-'* ]] || right=$3
  [[ $code == "$right" ]] || fault "$command $way: ends with $code, not $right"
  for file in open/*; do
    [[ -e $file ]] || continue
    cmp -s "$file" "$folder/${file#open/}" || fault "$command $way: ${file#open/} is another one"
  done
}

# wait_for JOB...: for these processes of this script.
wait_for() {
  local job
  for job in "$@"; do
    wait "$job" || fault "job $job of this script died"
  done
}

# start_daemon NAME WAY: on a channel prefix of that name, with its log, if that is open, in NAME.err.
start_daemon() {
  bash -c "exec camwayd --prefix $1 --scene maze=$kScenes/maze.obj,occupancy=0.1 \
    --scene-roots $kScenes </dev/null >$1.out 2>$1.err $2" &
  daemon=$!
  until camway status --prefix "$1" >/dev/null 2>&1; do kill -0 "$daemon" || return 1; done
}

# stop_daemon NAME
stop_daemon() {
  local code=0
  kill "$daemon" || true # it may have died
  wait "$daemon" || code=$?
  daemon=
  [[ $code == 0 ]] || fault "camwayd $1: ends with $code"
}

# try_daemon WAY NAME: a daemon that is started so has to answer, and to print nothing.
try_daemon() {
  start_daemon "$2" "$1" || fault "camwayd $1: does not come up"
  camway load --prefix "$2" --scene "maze=$kScenes/maze.obj" --request "$kRequest" --seconds 0.2 \
    >/dev/null || fault "camwayd $1: answers are wrong or lost"
  stop_daemon "$1"
  [[ ! -s $2.out ]] || fault "camwayd $1: prints $(<"$2.out")"
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

start_daemon CAMWAY ''
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
try "camway scene load uploaded-@ --upload $kScenes/maze.obj" 0 2
try "camway scene describe nowhere" 2
try "camway occupancy --daemon maze --point 1,1,1" 0 2
try "camway watch nowhere --request $kRequest" 2
try "camway doctor" as-open 2
stop_daemon 'with open streams'

daemons=()
for i in "${!kWays[@]}"; do
  try_daemon "${kWays[i]}" "way$i" &
  daemons+=($!)
done
wait_for "${daemons[@]}"

cat faults
echo "$(wc -l <faults) faults"
[[ ! -s faults ]]
