#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs Camway's packages in the root folder that this runs in, uses each as its user does, and purges
# them. packages_test.sh starts it in a root that is thrown away.
#
#   in_root.sh FOLDER [--apt]    FOLDER: holds packages/*.deb, user/ (a project) and requests/*.json
#
# With --apt the packages that they depend on are installed, too; else they must be there.
set -euo pipefail
cd "$1"
readonly way=${2:-}
readonly user=_camwayd
export LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=$PWD/home
unset CAMWAY_CACHE_DIR MANPATH
mkdir -p home

fail() { printf 'packages: %s\n' "$*" >&2; exit 1; }
step() { printf '== %s\n' "$*"; }

names=()
for file in packages/*.deb; do
  names+=("$(dpkg-deb --field "$file" Package)")
done
has() { [[ " ${names[*]} " == *" $1 "* ]]; }

# What `apt search` shows of each package tells which is which.
check_synopses() {
  local file distinct
  distinct=$(for file in packages/*.deb; do dpkg-deb --field "$file" Description | sed -n 1p; done | sort -u | wc -l)
  ((distinct == ${#names[@]})) || fail "packages share their synopsis"
}
check_synopses

install_packages() {
  step "install ${names[*]}"
  # Images for containers leave out pages and documents.
  local all="--path-include=/usr/share/*"
  if [[ $way == --apt ]]; then
    # Users have more than the packages need: a compiler, a build system, a reader of pages.
    {
      apt-get -qq -y install --no-install-recommends g++ make cmake pkg-config man-db python3
      apt-get -qq -y install --no-install-recommends -o DPkg::Options::="$all" ./packages/*.deb
    } >apt.log 2>&1 || { cat apt.log >&2; exit 1; }
  else
    dpkg "$all" --install packages/*.deb >dpkg.log 2>&1 || { cat dpkg.log >&2; exit 1; }
  fi
  dpkg --verify "${names[@]}"
}

use_tools() {
  step "use camway"
  camway --version
  camway plan --scene /usr/share/camway/scenes/office.obj --request requests/office-graze-column.json \
    --response answer.json --no-cache
  grep -q '"status": *"ok"' answer.json || fail "the path is not ok"
  [[ -s /usr/share/doc/camway/copyright && -s /usr/share/doc/camway/changelog.Debian.gz ]] ||
    fail "copyright or changelog is missing"
  python3 -B check_sbom.py /usr/share/doc/camway/sbom.spdx.json
}

show_manual() {
  if ! command -v man >/dev/null || ! command -v groff >/dev/null; then
    echo "no man here: its pages are not shown"
    return
  fi
  step "show the manual"
  local page said
  for page in "1 camway" "1 camway-plan" "1 camway-scene" "8 camwayd" "5 camwayd.toml" "8 camway-import"; do
    # shellcheck disable=SC2086
    said=$(man --warnings $page 2>&1 >shown.txt </dev/null) || fail "man $page: $said"
    [[ -z $said && $(wc -l <shown.txt) -ge 10 ]] || fail "man $page: $said"
  done
}

complete_words() {
  step "complete words"
  local offered
  offered=$(bash --norc -c 'source /usr/share/bash-completion/completions/camway
    COMP_WORDS=(camway sc); COMP_CWORD=1; _camway_complete; echo "${COMPREPLY[@]}"')
  [[ $offered == scene ]] || fail "bash completes 'camway sc' by '$offered'"
}

# Starts the daemon as the unit does, but without systemd.
start_daemon() {
  step "start the daemon as $user"
  getent passwd "$user" >/dev/null || fail "there is no user $user"
  [[ -z $(find /etc/systemd/system -name 'camwayd*' 2>/dev/null) ]] || fail "the package enables the daemon"
  # systemd makes these folders for CacheDirectory= and StateDirectory=.
  install -d -o "$user" -g "$user" -m 700 /var/cache/camway /var/lib/camway
  local command unit
  unit=$(find /lib/systemd /usr/lib/systemd -name camwayd.service | head -1)
  command=$(sed -n 's/^ExecStart="\(.*\)" /\1 /p' "$unit")
  [[ $command == "/usr/bin/camwayd --config /etc/camway/camwayd.toml" ]] || fail "the unit starts '$command'"
  # shellcheck disable=SC2086
  CAMWAY_CACHE_DIR=/var/cache/camway setpriv --reuid "$user" --regid "$user" --clear-groups \
    $command --state /var/lib/camway 2>daemon.log &
  daemon=$!
  local i
  for ((i = 0; i < 300; i++)); do
    ! camway status >status.txt 2>&1 || return 0
    kill -0 $daemon 2>/dev/null || break
    sleep 0.1
  done
  cat daemon.log status.txt >&2
  fail "the daemon does not answer"
}

stop_daemon() {
  kill -TERM $daemon
  wait $daemon || fail "the daemon ends with code $?"
  [[ -n $(find /var/cache/camway -type f) ]] || fail "the daemon kept no prepared scene"
}

compile_client() {
  command -v c++ >/dev/null || { echo "no compiler here: no client is compiled"; return; }
  step "compile a client by CMake and by pkg-config"
  if ! { cmake -S user -B by_cmake && cmake --build by_cmake; } >cmake.log 2>&1; then
    cat cmake.log >&2
    exit 1
  fi
  by_cmake/user
  if pkg-config --exists camway-client; then
    # shellcheck disable=SC2046
    c++ -std=c++17 user/user.cpp -o by_pkg_config $(pkg-config --cflags --libs camway-client)
    ./by_pkg_config
    readelf -d by_pkg_config | grep -q 'libcamway\.so\.0' || fail "it does not use the shared library"
  fi
  lcm-gen --version >/dev/null 2>&1 || return 0
  lcm-gen --python --ppath types /usr/share/camway/lcmtypes/*.lcm
}

remove_and_purge() {
  step "remove, then purge"
  dpkg --remove "${names[@]}" >>dpkg.log 2>&1
  [[ -e /etc/camway/camwayd.toml ]] || fail "removing takes the configuration"
  [[ ! -e /usr/bin/camway ]] || fail "camway is still there"
  local kept
  mapfile -t kept < <(dpkg-query --show --showformat '${db:Status-Abbrev} ${Package}\n' "${names[@]}" 2>/dev/null |
    sed -n 's/^rc *//p')
  [[ " ${kept[*]} " == *" camwayd "* ]] || fail "dpkg forgot the configuration of camwayd"
  dpkg --purge "${kept[@]}" >>dpkg.log 2>&1
  ! grep -E '^dpkg: warning' dpkg.log || fail "dpkg warns"
  ! getent passwd "$user" >/dev/null || fail "the user $user is still there"
  local left
  left=$(find /etc /usr /var \( -path /var/lib/dpkg -o -path /var/log \) -prune -o -iname '*camway*' -newer start -print |
    head)
  [[ -z $left ]] || fail "a purge leaves $left"
}

touch start
install_packages
use_tools
show_manual
complete_words
if has camwayd; then
  start_daemon
  has libcamway-client-dev && compile_client
  if has python3-camway; then
    step "import the Python package"
    (cd / && python3 -B -c 'import camway; print(camway.__file__)')
  fi
  stop_daemon
fi
remove_and_purge
