#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# planted_test.sh CHECK_LAYERS MAP: plants one include at a time into a tree of one file, and sees
# what the check says of it.
set -euo pipefail

check=$1
map=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

# verdict FILE INCLUDE: the check's exit code, its words in $words.
verdict() {
  local tree=$folder/tree
  rm -rf "$tree"
  mkdir -p "$tree/$(dirname "$1")"
  cp "$map" "$tree/ARCHITECTURE.md"
  printf '// A comment that says #include "tools/x.h" is none.\n\n#include %s\n' "$2" >"$tree/$1"
  local code=0
  words=$("$check" "$tree" 2>&1) || code=$?
  return $code
}

allowed() {
  if ! verdict "$1" "$2"; then
    echo "FAILED: $1 may include $2, but: $words"
    failures=$((failures + 1))
  fi
}

forbidden() {
  local code=0
  verdict "$1" "$2" || code=$?
  if [[ $code -ne 1 || $words != "$1:3: "* ]]; then
    echo "FAILED: $1 must not include $2; exit code $code: $words"
    failures=$((failures + 1))
  fi
}

allowed daemon/motion/a.cpp '"daemon/motion/b.h"'
allowed daemon/motion/a.cpp '"daemon/geometry/types.h"'
allowed daemon/planning/a.cpp '"daemon/geometry/types.h"'  # by way of others
allowed daemon/planning/a.cpp '<vector>'
allowed daemon/service/a.cpp '<lcm/lcm.h>'
allowed daemon/service/a.cpp '"lcmtypes/wire/channels.h"'
allowed daemon/service/log/log.cpp '<spdlog/spdlog.h>'
allowed daemon/process/main.cpp '"daemon/process/daemon_run.h"'
allowed daemon/scene/a.cpp '<octomap/OcTree.h>'
allowed daemon/scene/a.cpp '<assimp/scene.h>'
allowed client/a.cpp '"lcmtypes/wire/channels.h"'
allowed tools/camway/a.cpp '"daemon/messages/convert.h"'
allowed tests/scene/a.cpp '<octomap/OcTree.h>'

forbidden daemon/geometry/a.cpp '"daemon/motion/b.h"'
forbidden daemon/motion/a.h '"daemon/scene/mesh/mesh.h"'
forbidden daemon/scene/a.cpp '"daemon/motion/b.h"'
forbidden daemon/collision/a.cpp '"daemon/planning/plan.h"'
forbidden daemon/planning/a.cpp '"daemon/service/core/core.h"'
forbidden daemon/planning/a.cpp '"tools/json/json_io.h"'
forbidden daemon/service/a.cpp '"tests/support/scenes.h"'
forbidden daemon/service/a.cpp '"client/engine/link.h"'
forbidden daemon/planning/a.cpp '<lcm/lcm-cpp.hpp>'
forbidden daemon/planning/a.cpp '"lcmtypes/wire/channels.h"'
forbidden daemon/planning/a.cpp '<camway/plan_request_t.hpp>'
forbidden daemon/collision/a.cpp '<octomap/OcTree.h>'
forbidden tools/a.cpp '<assimp/scene.h>'
forbidden daemon/scene/a.cpp '<embree3/rtcore.h>'
allowed lcmtypes/wire/auth/message_keys.cpp '<sodium.h>'
allowed daemon/process/http_page.cpp '<microhttpd.h>'
forbidden daemon/service/a.cpp '<sodium.h>'
forbidden client/a.cpp '<sodium.h>'
forbidden daemon/service/a.cpp '<microhttpd.h>'
forbidden daemon/geometry/a.cpp '<spdlog/spdlog.h>'
forbidden daemon/service/a.cpp '  <spdlog/spdlog.h>'
forbidden tests/service/a.cpp '<spdlog/spdlog.h>'
forbidden client/a.cpp '"daemon/planning/plan.h"'
forbidden lcmtypes/a.cpp '"daemon/geometry/types.h"'

# A folder that the map does not know, a map that cannot be read, and a tree without sources are no
# success.
fails_with() {
  local code=0
  verdict "$2" "$3" || code=$?
  if [[ $code -ne $1 ]]; then
    echo "FAILED: $2 with $3 gives exit code $code: $words"
    failures=$((failures + 1))
  fi
}
fails_with 1 daemon/extra/a.cpp '<vector>'
fails_with 1 daemon/motion/a.cpp '"daemon/extra/a.h"'
fails_with 2 python/a.cpp '<vector>'
map=/dev/null
fails_with 2 daemon/motion/a.cpp '<vector>'

[[ $failures -eq 0 ]] || exit 1
echo "all planted includes were judged rightly"
