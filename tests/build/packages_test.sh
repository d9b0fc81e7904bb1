#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Packs a build, installs the packages in a root folder that is thrown away, uses them, purges them, and
# compares the remaining files with those that were there before.
#
#   packages_test.sh --build DIR --work DIR [--root DIR --apt] [--packages DIR]
#
# The root is an overlay of this machine's, or of DIR. Exit code 77: this is not Debian, namespaces or overlays
# are not allowed here, or this is not root, so that a daemon could not become its user.
set -euo pipefail
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
readonly here
readonly repository=$here/../..
root=/
way=""
packages=""
inside=false
while (($# > 0)); do
  case $1 in
    --build) build=$(realpath "$2"); shift ;;
    --work) mkdir -p "$2"; work=$(realpath "$2"); shift ;;
    --root) root=$(realpath "$2"); shift ;;
    --packages) packages=$(realpath "$2"); shift ;;
    --apt) way=--apt ;;
    --inside) inside=true ;;
    *) sed -n '/^# Packs/,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0" >&2; exit 2 ;;
  esac
  shift
done

pack() {
  # gzip packs a development build in a third of the time of xz.
  cpack --config "$build/CPackConfig.cmake" -B "$work/packed" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip \
    >"$work/cpack.log" 2>&1 || { cat "$work/cpack.log"; exit 1; }
  mv "$work"/packed/*.deb "$work/shared/packages"
  rm -rf "$work/packed"
}

prepare() {
  rm -rf "$work"
  mkdir -p "$work/shared/packages"
  if [[ -n $packages ]]; then cp "$packages"/*.deb "$work/shared/packages"; else pack; fi
  cp -r "$here/packages" "$work/shared/user"
  cp -r "$repository/scenes/requests" "$work/shared/requests"
  cp "$here/packages/in_root.sh" "$here/packages/check_sbom.py" "$work/shared"
}

# Files that an installation changes though no package has them: the books of dpkg, and what is computed from
# all packages.
is_bookkeeping() {
  case $1 in
    ./var/lib/dpkg/* | ./var/lib/apt/* | ./var/lib/systemd/deb-systemd-helper* | ./var/log/*) return 0 ;;
    ./var/cache/* | ./etc/ld.so.cache | ./etc/*- | ./etc/.pwd.lock | ./run/* | ./mnt/*) return 0 ;;
  esac
  return 1
}

# The overlay holds the files that changed, after the purge.
compare() {
  local file differing=()
  cd "$layer/upper"
  while IFS= read -r -d '' file; do
    is_bookkeeping "$file" && continue
    cmp -s "$file" "$root/$file" || differing+=("$file")
  done < <(find . -not -type d -print0)
  ((${#differing[@]} == 0)) && return
  printf 'packages: a purge leaves, or has changed: %s\n' "${differing[@]}" >&2
  exit 1
}

run_inside() {
  layer=$work/layer
  mkdir -p "$layer"
  mount -t tmpfs tmpfs "$layer"
  mkdir "$layer"/{upper,made,root}
  mount -t overlay overlay -o "lowerdir=$root,upperdir=$layer/upper,workdir=$layer/made" "$layer/root" || exit 77
  for folder in proc dev sys; do
    mount --rbind /$folder "$layer/root/$folder" || exit 77
  done
  mount -t tmpfs tmpfs "$layer/root/tmp"
  mkdir -p "$layer/root/mnt/camway"
  mount --bind "$work/shared" "$layer/root/mnt/camway"
  if [[ $way == --apt ]]; then cat /etc/resolv.conf >"$layer/root/etc/resolv.conf" 2>/dev/null || true; fi
  chroot "$layer/root" /bin/bash /mnt/camway/in_root.sh /mnt/camway $way || exit 1
  [[ $way == --apt ]] || compare
}

if ! $inside; then
  if ! command -v dpkg-shlibdeps >/dev/null || ! command -v file >/dev/null; then
    echo "not run: this needs dpkg-dev and file" >&2
    exit 77
  fi
  if [[ $EUID -ne 0 ]] || ! unshare --mount true 2>/dev/null; then
    echo "not run: this needs root and namespaces of mounts" >&2
    exit 77
  fi
  prepare
  options=(--work "$work" --root "$root" ${way:+--apt} --inside)
  exec unshare --mount --propagation private "$0" "${options[@]}"
fi
run_inside
