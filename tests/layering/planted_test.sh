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
  mkdir -p "$tree/$(dirname "$1")" "$tree/docs/design"
  cp "$map" "$tree/docs/design/rooms.md"
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

allowed daemon/motion/path/a.cpp '"daemon/motion/path/b.h"'
allowed daemon/motion/path/a.cpp '"daemon/geometry/types.h"'
allowed daemon/planning/a.cpp '"daemon/geometry/types.h"'  # by way of others
allowed daemon/planning/a.cpp '<vector>'
allowed daemon/scene/snapshot/a.cpp '"daemon/scene/mesh/mesh.h"'
allowed daemon/scene/import/child/a.cpp '"daemon/scene/import/readers/decimal.h"'
allowed daemon/motion/path/below/a.cpp '"daemon/geometry/types.h"'  # the row of the folder above
allowed daemon/service/a.cpp '<lcm/lcm.h>'
allowed daemon/messages/a.cpp '<camway/plan_request_t.hpp>'
allowed daemon/service/a.cpp '"lcmtypes/wire/channels.h"'
allowed daemon/service/log/log.cpp '<spdlog/spdlog.h>'
allowed daemon/process/main.cpp '"daemon/service/service.h"'
allowed daemon/scene/mirror/a.cpp '<octomap/OcTree.h>'
allowed daemon/scene/import/child/a.cpp '<assimp/scene.h>'
allowed daemon/scene/import/inventor/a.cpp '<Inventor/SoDB.h>'
allowed daemon/scene/import/cad/a.cpp '<BRep_Tool.hxx>'
allowed client/messages/a.cpp '"lcmtypes/wire/channels.h"'
allowed client/engine/a.cpp '<camway/client.h>'
allowed tools/camway/a.cpp '"daemon/messages/plan.h"'
allowed tests/scene/a.cpp '<octomap/OcTree.h>'
allowed lcmtypes/wire/auth/message_keys.cpp '<sodium.h>'
allowed daemon/http/server.cpp '<boost/beast/http/read.hpp>'

forbidden daemon/geometry/a.cpp '"daemon/motion/path/b.h"'
forbidden daemon/scene/import/child/a.cpp '<Inventor/SoDB.h>'
forbidden daemon/scene/import/inventor/a.cpp '<BRep_Tool.hxx>'
forbidden daemon/motion/path/a.cpp '"daemon/motion/spline/b.h"'
forbidden daemon/motion/path/a.h '"daemon/scene/mesh/mesh.h"'
forbidden daemon/scene/index/a.cpp '"daemon/motion/path/b.h"'
# Between the rooms of one folder, upwards and sideways.
forbidden daemon/scene/mesh/a.cpp '"daemon/scene/snapshot/snapshot.h"'
forbidden daemon/scene/import/a.cpp '"daemon/scene/import/readers/decimal.h"'
forbidden daemon/scene/field/a.cpp '"daemon/scene/index/scene_index.h"'
forbidden daemon/correction/search/a.cpp '"daemon/correction/ladder/ladder.h"'
forbidden daemon/service/transport/a.cpp '"daemon/service/core/core.h"'
forbidden daemon/service/scenes/a.cpp '"daemon/service/plans/plan_service.h"'
forbidden daemon/service/core/a.cpp '"daemon/service/service.h"'
forbidden daemon/service/a.cpp '"daemon/process/settings/daemon_options.h"'
forbidden client/messages/a.cpp '"client/engine/lcm_connection.h"'
forbidden client/include/camway/a.h '"client/messages/text.h"'
forbidden tools/json/a.cpp '"client/engine/lcm_connection.h"'
forbidden daemon/collision/a.cpp '"daemon/planning/plan.h"'
forbidden daemon/planning/a.cpp '"daemon/service/core/core.h"'
forbidden daemon/planning/a.cpp '"tools/json/json_request.h"'
forbidden daemon/service/a.cpp '"tests/support/scenes.h"'
forbidden daemon/service/a.cpp '"client/engine/lcm_connection.h"'
forbidden daemon/planning/a.cpp '<lcm/lcm-cpp.hpp>'
forbidden daemon/planning/a.cpp '"lcmtypes/wire/channels.h"'
forbidden daemon/planning/a.cpp '<camway/plan_request_t.hpp>'
forbidden client/messages/a.cpp '"lcmtypes/wire/auth/message_auth.h"'
forbidden daemon/collision/a.cpp '<octomap/OcTree.h>'
forbidden daemon/scene/snapshot/a.cpp '<octomap/OcTree.h>'
forbidden daemon/scene/import/a.cpp '<assimp/scene.h>'
forbidden tools/a.cpp '<assimp/scene.h>'
forbidden daemon/scene/index/a.cpp '<embree3/rtcore.h>'
forbidden daemon/service/a.cpp '<sodium.h>'
forbidden client/a.cpp '<sodium.h>'
forbidden daemon/service/a.cpp '<boost/asio/post.hpp>'
forbidden daemon/geometry/a.cpp '<spdlog/spdlog.h>'
forbidden daemon/service/log/a.cpp '  <spdlog/spdlog.h>'
forbidden tests/service/a.cpp '<spdlog/spdlog.h>'
forbidden client/a.cpp '"daemon/planning/plan.h"'
forbidden lcmtypes/wire/a.cpp '"daemon/geometry/types.h"'

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
fails_with 1 daemon/motion/path/a.cpp '"daemon/extra/a.h"'
fails_with 2 python/a.cpp '<vector>'
map=/dev/null
fails_with 2 daemon/motion/path/a.cpp '<vector>'

[[ $failures -eq 0 ]] || exit 1
echo "all planted includes were judged rightly"
