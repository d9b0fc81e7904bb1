#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Replays the golden sessions in scenes/sessions: requests in our own scenes with the answers that this
# project gives to them. A change of the planner shows there which answers became better or worse.
#
#   tools/scripts/golden_sessions.sh [--update] [--bin FOLDER] [SESSION...]
#
#   --update  records the sessions anew from a daemon in a private network namespace, shows what changed
#             against the old ones, and replaces those that changed
#   --bin     where camway and camwayd are (the newer of build/release/bin and build/dev/bin, else where PATH
#             says)
#   SESSION   only these, by their names without .lcmlog and .camway-session
#
# Exit code: 0 all answers are the same within the tolerances, or --update recorded the sessions; 3 an
# answer is not; 1 a session could not be replayed or recorded.
set -euo pipefail

root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
sessions=$root/scenes/sessions
bin=
update=false
wanted=()

# The bits of sines and cosines depend on the processor (the C library chooses variants), so answers are
# compared within a tenth of a millimetre and a hundredth of a degree.
readonly kTolerances=(--tolerance-m 1e-4 --tolerance-shift-deg 0.01)
# The least deadline is far longer than any request takes, with sanitizers, too, so that no answer depends on
# the speed of the machine.
readonly kDeadline_s=600

say() { printf 'golden_sessions: %s\n' "$*"; }
fail() { say "$*" >&2 && exit 1; }
usage() { sed -n '/^# Replays the golden/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"; }

while [[ $# -gt 0 ]]; do
  case $1 in
    --update) update=true && shift ;;
    --bin)
      [[ $# -ge 2 ]] || { say "--bin needs a value" >&2 && exit 2; }
      bin=$2 && shift 2 ;;
    --help | -h) usage && exit 0 ;;
    -*) usage >&2 && exit 2 ;;
    *) wanted+=("$1") && shift ;;
  esac
done

if [[ -z $bin ]]; then
  # The newer one: a stale build would answer for code that it does not have.
  for folder in "$root/build/release/bin" "$root/build/dev/bin"; do
    [[ -x $folder/camway && -x $folder/camwayd ]] || continue
    [[ -n $bin && ! $folder/camway -nt $bin/camway ]] || bin=$folder
  done
fi
camway=${bin:+$bin/}camway
camwayd=${bin:+$bin/}camwayd

say_binary() {
  local program
  program=$(command -v "$camway") || fail "$camway: there is no such program"
  say "$program: $("$program" --version)"
}

# The scenes by their names in the sessions.
scene_flags() {
  local name
  for name in office maze gallery; do printf '%s\n' --scene "$name=$root/scenes/$name.obj"; done
  printf '%s\n' --scene "map=$sessions/maze.bt"
}

# Prints the requests of a session, one a line: the scene, the file in scenes/requests, and members of
# its options and of itself that differ, as JSON.
requests_of() {
  case $1 in
    office)
      printf '%s\n' "office office-free-two-rooms" "office office-graze-door" "office office-graze-chair" \
        "office office-graze-column" "office office-graze-steps" "office office-wall-corridor" ;;
    maze) printf '%s\n' "maze maze-free-cells" "maze maze-graze-corners" "maze maze-wall-neighbours" ;;
    gallery)
      printf '%s\n' "gallery gallery-graze-rod" "gallery gallery-graze-fan" "gallery gallery-wall-slot" ;;
    map) printf '%s\n' "map maze-free-cells" "map maze-wall-neighbours" ;;
    body)
      printf '%s\n' \
        'office office-graze-column {"body": {"type": "sphere", "radius": 0.2}}' \
        'office office-graze-door {"body": {"type": "box", "size": [0.3, 0.2, 0.4]}, "options": {"clearance_m": 0.05}}' ;;
    limits)
      printf '%s\n' \
        'office office-free-turn {"options": {"limits": {"turn_rate_deg_per_s": 30, "retime": true}}}' \
        'office office-graze-slalom {"options": {"limits": {"speed_m_per_s": 1, "retime": true}}}' \
        'office office-graze-railing {"options": {"objective": "safest", "clearance_profile": true}}' ;;
    infeasible) printf '%s\n' "office office-impossible-safe" "office office-impossible-shaft" ;;
    partial)
      printf '%s\n' \
        'office office-graze-lamp {"options": {"max_inserted_keyframes": 0}}' \
        'gallery gallery-graze-cube {"options": {"method": "keyframe_insertion"}}' \
        'office office-wall-rooms {"options": {"limits": {"speed_m_per_s": 0.01}}}' ;;
    invalid)
      printf '%s\n' \
        'office office-graze-door {"options": {"clearance_m": 40}}' \
        'office office-graze-chair {"options": {"repair_keyframes": true, "clearance_m": 0.3}}' ;;
    live)  # of a daemon that records, with the changes of the scene in between: `change_live`
      printf '%s\n' "maze maze-free-cells" "maze maze-free-cells" "maze maze-free-cells" "maze maze-free-cells" ;;
  esac
}

# Changes the scene before the request of this number: a crate comes into the way, moves, and goes.
change_live() {
  case $1 in
    1) "$camway" scene add maze crate --box 0.5,2,0.5 --position 1.1,1,2 ;;
    2) "$camway" scene move maze crate --position 4,1,7.1 ;;
    3) "$camway" scene remove maze crate ;;
  esac
}

all_sessions() { printf '%s\n' office maze gallery map body limits infeasible partial invalid live; }

# Prints the file of a session: a recording of a daemon has its scenes, so it is a pack.
file_of() { printf '%s\n' "$2/$1.$([[ $1 == live ]] && echo camway-session || echo lcmlog)"; }

# Writes a request with other members than its file has.
write_request() {
  python3 - "$root/scenes/requests/$1.json" "$2" "$kDeadline_s" >"$3" <<'PYTHON'
import json
import sys

request = json.load(open(sys.argv[1]))
changes = json.loads(sys.argv[2] or "{}")
options = {**request.get("options", {}), **changes.pop("options", {})}
del request["scene"]
if "body" in changes:
    request.pop("camera")
json.dump({**request, **changes, "options": options}, sys.stdout)
PYTHON
}

# Copies the events of planning, and of a recording those about scenes: a log has a heartbeat of the daemon
# each second. Folders of this machine, which a recording names among its settings, become as many signs.
# keep_planning LOG KEPT [FOLDER...]
keep_planning() {
  python3 - "$@" <<'PYTHON'
import struct
import sys

log = open(sys.argv[1], "rb").read()
kept = b""
at = 0
while at < len(log):
    channel_bytes, data_bytes = struct.unpack_from(">ii", log, at + 20)
    end = at + 28 + channel_bytes + data_bytes
    wanted = (b"CAMWAY_PLAN_REQUEST", b"CAMWAY_PLAN_RESPONSE", b"CAMWAY_SESSION")
    if log[at + 28 : at + 28 + channel_bytes].startswith(wanted):
        kept += log[at:end]
    at = end
for folder in map(str.encode, sys.argv[3:]):
    kept = kept.replace(folder, b"_" * len(folder))
open(sys.argv[2], "wb").write(kept)
PYTHON
}

# Waits until a command succeeds, 30 s at most.
eventually() {
  local i
  for ((i = 0; i < 300; ++i)); do
    "$@" && return
    sleep 0.1
  done
  return 1
}

# ask_all SESSION LOG: sends the requests of a session to the running daemon.
ask_all() {
  local session=$1 log=$2 scene file changes number=0
  while read -r scene file changes; do
    [[ $session != live ]] || change_live "$number" >/dev/null || fail "$session: the scene cannot be changed"
    number=$((number + 1))
    write_request "$file" "$changes" "$log.json"
    # A negative answer is an answer.
    "$camway" plan --daemon "$scene" --request "$log.json" --response "$log.response" >/dev/null 2>"$log.said" || true
    [[ -s $log.response ]] || fail "$session: $file: $(cat "$log.said")"
    rm -f "$log.response"
  done < <(requests_of "$session")
}

# record_session SESSION LOG: records the requests of a session from the running daemon.
record_session() {
  local session=$1 log=$2
  lcm-logger --quiet --force --flush-interval=50 "$log.all" &
  local logger=$!
  eventually grep -qs CAMWAY_STATUS "$log.all" || fail "lcm-logger does not hear the daemon"
  ask_all "$session" "$log"
  sleep 0.3  # the logger writes all messages
  kill "$logger" || true
  wait "$logger" || true
  keep_planning "$log.all" "$log"
}

# record_live PACK: records from a daemon with --record.
record_live() {
  local pack=$1 recorded log
  recorded=$(mktemp -d -p "$folder")
  "$camwayd" --scene "maze=$root/scenes/maze.obj" --record "$recorded" --log-level warn \
    --max-deadline-s "$kDeadline_s" --deadline-s "$kDeadline_s" &
  local daemon=$!
  eventually "$camway" status >/dev/null 2>&1 || fail "the daemon does not start"
  ask_all live "$pack"
  kill "$daemon" || true
  wait "$daemon" || true
  log=$(ls "$recorded"/*.lcmlog)
  keep_planning "$log" "$recorded/live" "$recorded" "$root"
  mv "$recorded/live" "$recorded/live.lcmlog" && rm "$log"
  "$camway" pack "$recorded" -o "$pack" >/dev/null
}

# update_session SESSION FOLDER: records anew, and replaces the session if it changed.
update_session() {
  local session=$1 new old code=0
  new=$(file_of "$session" "$2")
  old=$(file_of "$session" "$sessions")
  [[ $session == live ]] || record_session "$session" "$new"
  if [[ -s $old ]]; then
    "$camway" replay --baseline "$old" --against "$new" --no-timing "${kTolerances[@]}" \
      --fail-on better,worse,different,regressed,not_compared >"$new.table" || code=$?
  else
    code=new
    "$camway" replay --baseline "$new" --against "$new" --no-timing >"$new.table"
  fi
  if [[ $code == 0 ]]; then
    say "$session: the same; the file stays as it is"
    return
  fi
  cat "$new.table"
  cp "$new" "$old"
  say "$session: $([[ $code == new ]] && echo "is new" || echo "replaced"), $(stat -c %s "$old") bytes"
}

# Runs in a network namespace.
update_all() {
  local session
  folder=$(mktemp -d)  # not local: the trap runs outside of this function
  trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
  if [[ ! -s $sessions/maze.bt ]]; then
    "$camwayd" --scene "maze=$root/scenes/maze.obj,occupancy=0.25" --log-level warn &
    eventually "$camway" scene export maze --to "$sessions/maze.bt" >/dev/null 2>&1 ||
      fail "the map cannot be exported"
    kill $! || true
    wait $! || true
  fi
  mapfile -t scenes < <(scene_flags)
  # One daemon serves at a time.
  [[ " ${wanted[*]} " != *" live "* ]] || record_live "$(file_of live "$folder")"
  "$camwayd" "${scenes[@]}" --log-level warn --max-deadline-s "$kDeadline_s" --deadline-s "$kDeadline_s" &
  eventually "$camway" status >/dev/null 2>&1 || fail "the daemon does not start"
  for session in "${wanted[@]}"; do update_session "$session" "$folder"; done
}

check_all() {
  local session code worst=0 output
  for session in "${wanted[@]}"; do
    code=0
    # Those of the recording count.
    scenes=()
    [[ $session == live ]] || mapfile -t scenes < <(scene_flags)
    output=$("$camway" replay "$(file_of "$session" "$sessions")" ${scenes[@]+"${scenes[@]}"} "${kTolerances[@]}" --threads 2 \
      --least-deadline-s "$kDeadline_s" --no-timing --fail-on better,worse,different,regressed,not_compared 2>&1) ||
      code=$?
    say "$session: $(tail -n 1 <<<"$output")"
    [[ $code == 0 ]] && continue
    printf '%s\n' "$output"
    if [[ $code == 3 && $worst == 0 ]]; then worst=3; elif [[ $code != 3 ]]; then worst=1; fi
  done
  [[ $worst == 0 ]] || say "if the change is wanted: tools/scripts/golden_sessions.sh --update, and commit scenes/sessions"
  exit $worst
}

((${#wanted[@]} > 0)) || mapfile -t wanted < <(all_sessions)
for session in "${wanted[@]}"; do
  [[ -n $(requests_of "$session") ]] || { say "$session: is no session; they are: $(all_sessions | paste -sd ' ')" >&2 && exit 2; }
done
say_binary
$update || check_all
mkdir -p "$sessions"
[[ -n ${CAMWAY_NETNS:-} ]] ||
  exec "$root/tools/scripts/netns.sh" "${BASH_SOURCE[0]}" --update ${bin:+--bin "$bin"} "${wanted[@]}"
update_all
