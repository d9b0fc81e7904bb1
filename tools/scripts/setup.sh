#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs the Debian packages that building and testing need, and only those that are missing.
# Silent and quick when nothing is. ./check and ./demo call it first.
#
#   tools/scripts/setup.sh            install what is missing (as root, or with sudo)
#   tools/scripts/setup.sh --blender  and Blender, which the tests of its add-on use if it is there
#   tools/scripts/setup.sh --list     print the packages
set -euo pipefail

kPackages=(
  # to build
  g++ cmake ninja-build ccache git pkg-config python3
  # the wire
  liblcm-dev liblcm-bin
  # what confines the process that reads scene files
  libseccomp-dev
  # geometry, scenes, the occupancy map
  libeigen3-dev liboctomap-dev libassimp-dev libboost-dev libxxhash-dev
  # compressed clouds of points
  liblzf-dev
  # scenes of Open Inventor and VRML; the build works without
  libcoin-dev zlib1g-dev
  # scenes of STEP and IGES, whose libraries are linked with TBB; the build works without
  libocct-data-exchange-dev libtbb-dev
  # logs, flags, JSON, configuration files, pictures
  libspdlog-dev libfmt-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libcairo2-dev
  # meshes for the page of camway view
  libmeshoptimizer-dev
  # signed messages, digests of what is kept
  libsodium-dev
  # scenes that outlive the daemon
  libsqlite3-dev
  # packs of recorded sessions
  libarchive-dev
  # messages between daemons, and the log that they share; the certificates of their connections
  libnats-dev libssl-dev
  # to pack Camway: finds the libraries that a package depends on; and makes the user of the daemon
  dpkg-dev file adduser
  # tests of the manual and of the completions
  man-db groff-base zsh fish
  # the package for Python, which the build works without, and the check of its types
  python3-dev python3-numpy pybind11-dev mypy
  # tests
  libgtest-dev libgmock-dev
  # the server of the messages, and certificates for it
  nats-server openssl
  # the private network namespace, and one that loses packets
  iproute2 util-linux iptables
  # examples of docs/http.md
  curl
  # the page of camway view in a browser
  chromium-headless-shell
)

# Readers of other projects, with which tests compare written files. Node.js of another source is kept.
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  kPackages+=(nodejs npm)
fi

# 163 packages, 70 MB to fetch and 600 MB on the disk: not for everyone.
readonly kBlenderPackages=(blender python3-numpy)

say() { printf 'setup: %s\n' "$*" >&2; }

missing_packages() {
  local installed
  installed=$(dpkg-query --show --showformat '${Package} ${db:Status-Status}\n' "${kPackages[@]}" \
    2>/dev/null | sed -n 's/ installed$//p') || true
  comm -13 <(sort -u <<<"$installed") <(printf '%s\n' "${kPackages[@]}" | sort)
}

choose_root_command() {
  if [[ $EUID -eq 0 ]]; then
    as_root=()
  elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
    as_root=(sudo)
  else
    say "these packages are missing, and installing them needs root or sudo without a password:"
    say "  apt-get install --no-install-recommends $*"
    exit 1
  fi
}

apt() {
  # 300 s: a machine that has just started often holds the lock for its own updates.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 \
    -o Acquire::Retries=3 "$@" </dev/null
}

install() {
  apt install --yes --no-install-recommends "$@"
}

# Debian starts a service at its installation. Tests start servers of their own, on the loopback.
stop_service_of_nats() {
  [[ " $* " == *" nats-server "* ]] && command -v systemctl >/dev/null || return 0
  "${as_root[@]}" systemctl disable --now nats-server.service >/dev/null 2>&1 || true
}

main() {
  if [[ ${1:-} == --list ]]; then
    printf '%s\n' "${kPackages[@]}"
    return
  fi
  if ! command -v dpkg-query >/dev/null; then
    say "this is not Debian: install the counterparts of these yourself: ${kPackages[*]}"
    return
  fi
  [[ ${1:-} != --blender ]] || kPackages+=("${kBlenderPackages[@]}")
  local missing
  mapfile -t missing < <(missing_packages)
  [[ ${#missing[@]} -eq 0 ]] && return

  choose_root_command "${missing[@]}"
  say "installing ${missing[*]}"
  # Fresh images come without package lists, old ones with stale lists; a good list needs no update.
  if ! install "${missing[@]}"; then
    say "that failed; updating the package lists and trying once more"
    if ! apt update || ! install "${missing[@]}"; then
      say "could not install: ${missing[*]}"
      say "apt-get's message is above. Is there a network, and does /etc/apt/sources.list name a mirror?"
      exit 1
    fi
  fi
  stop_service_of_nats "${missing[@]}"
}

main "$@"
