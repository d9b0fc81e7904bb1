#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Makes a release of the commit that is checked out: a tarball of the sources, the Debian packages that are
# built of it, a bill of materials, and checksums. The same commit gives the same bytes in every folder, on
# machines with the same Debian packages.
#
#   tools/scripts/release.sh [--out DIR] [--build DIR] [--check]
#
#   --out DIR    where the files go [out/release]
#   --build DIR  where sources are unpacked and built; removed before and after [a new folder in /tmp]
#   --check      then builds all again elsewhere, without a cache of the compiler, and compares; runs lintian;
#                and installs, uses and purges the packages in a fresh Debian (as root, over the network)
set -euo pipefail
cd "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../.."
readonly kName=release
readonly kMostPrograms_kB=15000
readonly kDebian=bookworm  # whose packages the programs are linked with
# shellcheck source=tools/scripts/steps.sh
source tools/scripts/steps.sh

out=out/release
folder=""
is_check=false
while (($# > 0)); do
  case $1 in
    --out) out=$2; shift ;;
    --build) folder=$2; shift ;;
    --check) is_check=true ;;
    *) sed -n '/^# Makes/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0" >&2; exit 2 ;;
  esac
  shift
done

version=$(sed -n 's/^project(camway VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
readonly version
# Times, order and modes of files must not depend on settings of the user.
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH TZ=UTC LC_ALL=C.UTF-8
umask 022

pack_sources() {
  [[ -z $(git status --porcelain --untracked-files=no) ]] || say "what is not committed is left out"
  mkdir -p "$out"
  rm -f "$out"/*
  git -c tar.umask=0022 archive --format=tar --prefix="camway-$version/" HEAD | gzip -9 -n \
    >"$out/camway-$version.tar.gz"
}

# quietly LOG COMMAND...: shows the output of the command only if it fails.
quietly() {
  local log=$1
  shift
  "$@" >"$log" 2>&1 || { cat "$log"; return 1; }
}

has_page() {
  [[ $(<build/release/tools/view/page/embed/made/parts.json) != '[]' ]] || { say "the page was not built"; return 1; }
}

# build_packages FOLDER OUT: builds the tarball, which tests that it is complete. `step` turns `set -e` off, so each
# command is tested.
build_packages() {
  local sources=$1/camway-$version to packed
  mkdir -p "$1" "$2"
  to=$(realpath "$2")
  tar -x -z -f "$out/camway-$version.tar.gz" -C "$1" && mkdir -p "$sources/build" || return
  (
    cd "$sources" &&
      quietly build/configure.log cmake --preset release -DCAMWAY_TESTS=OFF -DCMAKE_INSTALL_PREFIX=/usr &&
      CCACHE_BASEDIR=$PWD cmake --build --preset release --parallel "$(build_jobs)" | count_in_tenths &&
      has_page &&
      quietly build/cpack.log cpack --config build/release/CPackConfig.cmake -B build/packages
  ) || return
  mv "$sources"/build/packages/*.deb "$to" || return
  packed=$(echo "$to"/camway_*.deb)
  dpkg-deb --fsys-tarfile "$packed" | tar -x -O ./usr/share/doc/camway/sbom.spdx.json >"$to/camway-$version.spdx.json"
}

write_checksums() {
  (cd "$out" && sha256sum -- *.tar.gz *.deb *.json >SHA256SUMS && cat SHA256SUMS)
}

# Prints the space that packages take, in kB. Fails if the tools, the daemon and their formats take too much.
print_sizes() {
  local file installed programs=0
  for file in "$out"/*.deb; do
    installed=$(dpkg-deb --field "$file" Installed-Size)
    printf '%8s kB installed, %8s kB packed  %s\n' "$installed" "$(($(stat -c %s "$file") / 1000))" "$(basename "$file")"
    case $(basename "$file") in
      camway_* | camwayd_* | camway-formats_*) programs=$((programs + installed)) ;;
    esac
  done
  printf '%8s kB installed by camway, camwayd and camway-formats, at most %s\n' "$programs" "$kMostPrograms_kB"
  ((programs <= kMostPrograms_kB))
}

build_again() {
  local again
  again=$(mktemp -d)
  CCACHE_DISABLE=1 build_packages "$again/elsewhere" "$again/out" || return
  grep -v '\.tar\.gz$' "$out/SHA256SUMS" >"$again/sums"
  (cd "$again/out" && sha256sum -c "$again/sums") || return
  rm -rf "$again"
}

# Checks Debian's rules, but for the maintainer's address and the bug that an upload closes.
run_lintian() {
  lintian --no-cfg --fail-on error "$out"/*.deb
}

install_in_fresh_debian() {
  local work
  work=$(mktemp -d)
  quietly "$work/log" debootstrap --variant=minbase "$kDebian" "$work/debian" || return
  tests/build/packages_test.sh --packages "$out" --work "$work/test" --root "$work/debian" --apt || return
  rm -rf "$work"
}

give_verdict_at_exit
made=""
if [[ -z $folder ]]; then
  made=$(mktemp -d)
  folder=$made/build
fi
step "Sources" pack_sources
rm -rf "$folder"
step "Build and packages" build_packages "$folder" "$out"
rm -rf "$folder" "${made:-$folder}"
step "Checksums" write_checksums
step "Sizes" print_sizes
if $is_check; then
  step "The same bytes in another folder" build_again
  step "lintian" run_lintian
  step "A fresh Debian" install_in_fresh_debian
fi
