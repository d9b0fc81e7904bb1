#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs the packages of package-lock.json into a folder, once for each content of the lock. It needs the
# network, so it runs before the tests that use the packages, and outside of their network namespaces.
#
#   install.sh FOLDER      exit code 77: not run, as node, npm or the network is missing
set -euo pipefail

readonly kNotRun=77
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
readonly here
readonly folder=$1
readonly stamp=$folder/installed

for program in node npm; do
  command -v "$program" >/dev/null || { echo "not run: node or npm is missing"; exit $kNotRun; }
done

content=$(cat "$here"/package.json "$here"/package-lock.json "$here"/.npmrc | sha256sum)
[[ -f $stamp && $(<"$stamp") == "$content" ]] && exit 0

rm -rf "$folder"
mkdir -p "$folder"
cp "$here"/package.json "$here"/package-lock.json "$here"/.npmrc "$folder"
if ! said=$(npm ci --prefix "$folder" --ignore-scripts 2>&1); then
  printf '%s\n' "$said"
  if grep -qE 'ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ENETUNREACH|EHOSTUNREACH|ETIMEDOUT' <<<"$said"; then
    echo "not run: npm reaches no registry"
    exit $kNotRun
  fi
  exit 1
fi
printf '%s\n' "$content" >"$stamp"
