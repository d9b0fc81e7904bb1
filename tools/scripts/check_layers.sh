#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Holds every #include against the map in docs/design/rooms.md: a room may include itself, what the column
# "may include" of its row names, and what those may include in turn. A file belongs to the row of the
# nearest folder above it that has one. LCM and the messages generated for it are for the wire; other
# libraries are for one room or one file each; FCL, Embree and CGAL are for tests alone. Needs nothing
# but bash, find and awk.
#
#   tools/scripts/check_layers.sh [ROOT]    ROOT: the tree to look at; this one if left out
#
# Prints FILE:LINE and why for each that is not allowed. Exit code: 0 none, 1 some, 2 nothing could
# be checked.
set -euo pipefail

root=${1:-$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../..}
cd "$root"
readonly kMap=docs/design/rooms.md
[[ -r $kMap ]] || { echo "check_layers: $root has no $kMap" >&2; exit 2; }

mapfile -t sources < <(find daemon client lcmtypes tools tests -type f \
  \( -name '*.h' -o -name '*.hpp' -o -name '*.cpp' -o -name '*.h.in' \) 2>/dev/null | LC_ALL=C sort)
[[ ${#sources[@]} -gt 0 ]] || { echo "check_layers: $root holds no sources" >&2; exit 2; }

LC_ALL=C exec awk '
  # Rows of the map look like: | `daemon/collision/` | what it holds | `motion`, `scene/snapshot` |
  function read_row(line, cells, folder, names, count, i) {
    split(line, cells, "|")
    if (!match(cells[2], /`[a-z_\/]+\/`/)) return
    folder = substr(cells[2], RSTART + 1, RLENGTH - 3)
    known[folder] = 1
    ++rows
    if (cells[4] ~ /everything/) { all[folder] = 1; return }
    count = split(cells[4], names, /[ ,`]+/)
    for (i = 1; i <= count; ++i) {
      if (names[i] != "") allowed[folder, full(names[i])] = 1
    }
  }
  function full(name) { return name ~ /^(lcmtypes|client|tools|tests)(\/|$)/ ? name : "daemon/" name }

  # What may be included may bring in what it may include itself.
  function close_over(a, b, c, changed) {
    do {
      changed = 0
      for (a in known) for (b in known) if ((a, b) in allowed)
        for (c in known) if ((b, c) in allowed && !((a, c) in allowed)) {
          allowed[a, c] = 1
          changed = 1
        }
    } while (changed)
  }

  # The row of the map that a file belongs to: the longest prefix that has one, "" for none.
  function layer_of(path) {
    while (sub(/\/[^\/]*$/, "", path)) if (path in known) return path
    return ""
  }

  function speaks_lcm(layer) {
    return layer ~ /^(daemon\/(messages|service|fleet|process)|client|tools|tests|lcmtypes)(\/|$)/
  }

  function fault(why) {
    printf "%s:%d: %s: %s\n", FILENAME, FNR, $0, why
    ++faults
  }

  FILENAME == map { if (/^\| *`/) read_row($0); next }
  FNR == 1 {
    if (!closed++) close_over()
    here = layer_of(FILENAME)
    if (here == "") { fault("this folder is not in the map of " map); nextfile }
  }
  !/^[ \t]*#[ \t]*include[ \t]*[<"]/ { next }
  {
    ++includes
    file = $0
    sub(/^[^<"]*[<"]/, "", file)
    sub(/[>"].*$/, "", file)
    if (file ~ /^(lcm\/|camway\/([a-z_]+_t\.hpp|(max_bytes|members)\.h)$)/ && !speaks_lcm(here)) {
      fault("LCM is for daemon/messages, daemon/service, daemon/fleet, daemon/process, client and tools")
    } else if (file ~ /^assimp\// && here !~ /^(daemon\/scene\/import\/child|tests)$/) {
      fault("assimp is for daemon/scene/import/child")
    } else if (file ~ /^Inventor\// && here !~ /^(daemon\/scene\/import\/inventor|tests)$/) {
      fault("Coin is for daemon/scene/import/inventor")
    } else if (file == "zlib.h" && here !~ /^(daemon\/gzip|tests)$/) {
      fault("zlib is for daemon/gzip")
    } else if (file ~ /^liblzf\// && here !~ /^(daemon\/scene\/import\/points|tests)$/) {
      fault("LZF is for daemon/scene/import/points")
    } else if (file ~ /^[A-Za-z0-9]+(_[A-Za-z0-9]+)?\.hxx$/ && here !~ /^(daemon\/scene\/import\/cad|tests)$/) {
      fault("Open CASCADE is for daemon/scene/import/cad")
    } else if (file ~ /^octo(map|math)\// &&
               here !~ /^(daemon\/scene\/(voxels|mirror|import\/child)|tests)$/) {
      fault("OctoMap is for daemon/scene/voxels, daemon/scene/mirror and daemon/scene/import/child")
    } else if (file ~ /^(fcl|embree[0-9]*|CGAL)\// && here != "tests") {
      fault("FCL, Embree and CGAL are for tests and benchmarks")
    } else if (file ~ /^sodium/ && here != "tests" &&
               FILENAME !~ /^(lcmtypes\/wire\/auth\/message_keys|daemon\/scene\/log\/blob_id)\.cpp$/) {
      fault("libsodium is for lcmtypes/wire/auth/message_keys.cpp and daemon/scene/log/blob_id.cpp")
    } else if (file == "sqlite3.h" && here !~ /^(daemon\/scene\/log\/sqlite|tests)$/) {
      fault("SQLite is for daemon/scene/log/sqlite")
    } else if (file ~ /^openssl\// && FILENAME != "daemon/nats/security_files.cpp") {
      fault("OpenSSL is for daemon/nats/security_files.cpp")
    } else if (file ~ /^nats\// && here !~ /^(daemon\/nats|tests)$/) {
      fault("NATS is for daemon/nats")
    } else if (file ~ /^boost\/(asio|beast)/ && here !~ /^(daemon\/http|tests)$/) {
      fault("Boost.Asio and Boost.Beast are for daemon/http")
    } else if (file == "meshoptimizer.h" && here !~ /^(tools\/view\/display|tests)$/) {
      fault("meshoptimizer is for tools/view/display")
    } else if (file ~ /^spdlog\// && FILENAME != "daemon/service/log/log.cpp") {
      fault("spdlog is for daemon/service/log/log.cpp")
    } else {
      # The headers of the client are included as users do.
      if (file ~ /^camway\// && file !~ /(_t\.hpp|\/(max_bytes|members)\.h)$/) file = "client/include/" file
      there = layer_of(file)
      if (file ~ /^(daemon|client|lcmtypes|tools|tests)\// && there == "") {
        fault("that folder is not in the map of " map)
      } else if (there != "" && there != here && !(here in all) && !((here, there) in allowed)) {
        fault(here " may not include " there)
      }
    }
  }
  END {
    if (rows < 5 || (!includes && !faults)) {
      printf "check_layers: %d rows of a map in %s, %d includes: nothing checked\n", rows, map,
             includes > "/dev/stderr"
      exit 2
    }
    if (faults) exit 1
    printf "check_layers: %d includes, all as the map in %s allows\n", includes, map
  }
' map="$kMap" "$kMap" "${sources[@]}"
