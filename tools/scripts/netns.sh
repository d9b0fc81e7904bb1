#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Runs a command in a private network namespace: a loopback that carries multicast, and nothing else.
#
#   tools/scripts/netns.sh COMMAND [ARGUMENT...]      exit code: the command's
#
# LCM speaks UDP multicast, which laptops, containers and CI machines often do not route. In here it
# always works, nothing leaves the machine, and two runs side by side never hear each other.
# Needs neither root nor set-up where unprivileged user namespaces are allowed; the command then
# sees itself as root of its own namespace, but its files stay those of the caller.
#
# Where namespaces are forbidden it says so and runs the command on the network as it is, on a UDP
# port of its own, so that parallel runs still do not mix.
#
# The command finds in its environment:
#   LCM_DEFAULT_URL   what LCM programs use unless told otherwise (ttl 0: stay on this host)
#   CAMWAY_NETNS      "private" in a namespace of its own, "shared" on the machine's network
set -euo pipefail

readonly kGroup=239.255.76.67
readonly kPort=7667
export PATH="$PATH:/usr/local/sbin:/usr/sbin:/sbin"  # `ip` lives there; ordinary users lack it

say() { printf 'netns: %s\n' "$*" >&2; }

find_ip() {
  if command -v ip >/dev/null; then
    echo ip
  elif command -v busybox >/dev/null && busybox --list | grep -qx ip; then
    echo "busybox ip"
  else
    return 1
  fi
}

# Runs inside the new namespace. Both commands are needed: lo comes without the multicast flag, and
# without a route the kernel refuses to send to a group.
bring_up_loopback() {
  local ip
  ip=$(find_ip)
  $ip link set lo up
  $ip link set lo multicast on
  $ip route add 224.0.0.0/4 dev lo
}

run_on_shared_network() {
  say "$1; the command runs on the machine's own network"
  local ip
  if ip=$(find_ip) && ! $ip route get "$kGroup" >/dev/null 2>&1; then
    say "there is no multicast route either, so LCM will not work; as root: ip link set lo up;" \
      "ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo"
  fi
  shift
  export CAMWAY_NETNS=shared
  export LCM_DEFAULT_URL="udpm://$kGroup:$((kPort + 1 + $$ % 20000))?ttl=0"
  exec "$@"
}

if [[ $# -eq 0 || $1 == --help || $1 == -h ]]; then
  sed -n '/^# Runs a command/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"
  [[ $# -gt 0 ]]
  exit
fi

self=$(realpath "${BASH_SOURCE[0]}")
if [[ $1 == --inside ]]; then
  shift
  bring_up_loopback
  [[ $1 == --probe ]] && exit 0
  export CAMWAY_NETNS=private
  export LCM_DEFAULT_URL="udpm://$kGroup:$kPort?ttl=0"
  exec "$@"
fi

command -v unshare >/dev/null || run_on_shared_network "unshare (package util-linux) is missing" "$@"
find_ip >/dev/null || run_on_shared_network "ip (package iproute2) is missing" "$@"

# A probe, not a test of the user id: root in a container may lack the right, and an ordinary user
# may have it. The probe sets up the loopback too, for some sandboxes allow only the first half.
for namespace in "--net" "--map-root-user --net"; do
  # shellcheck disable=SC2086
  if unshare $namespace -- "$self" --inside --probe >/dev/null 2>&1; then
    # shellcheck disable=SC2086
    exec unshare $namespace -- "$self" --inside "$@"
  fi
done
run_on_shared_network "network namespaces are not allowed here" "$@"
