#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Makes the files that embedded_files.S puts into the program, and parts.json: which packages are in them. Does
# nothing if what they are made of has not changed. The packages of package-lock.json are installed once for each
# content of the lock, which needs the network; without it there is a warning, and a page that names the
# missing part.
#
#   make_page.sh FOLDER OUT      FOLDER: for a copy of the sources, and their packages
#   make_page.sh --without OUT   the page that says what is missing
set -euo pipefail

here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
readonly here
readonly page=$here/..
readonly folder=$1
readonly out=$2

# The sources by name, those of this folder first.
sources() {
  cd "$page"
  find embed src test -type f | LC_ALL=C sort
  printf '%s\n' .npmrc build.mjs index.html package-lock.json package.json page.css tsconfig.json
}

# Puts files into OUT, and leaves those that are equal as they are, so that nothing is built again for them.
deliver() {
  mkdir -p "$out"
  local file
  for file in index.html page.js page.css index.html.gz page.js.gz page.css.gz policy.txt \
    report.js report_policy.txt parts.json; do
    cmp -s "$1/$file" "$out/$file" || cp "$1/$file" "$out/$file"
  done
}

make_without() {
  local made
  made=$(mktemp -d)
  cp "$here/without.html" "$made/index.html"
  gzip -9 -n -c "$made/index.html" >"$made/index.html.gz"
  touch "$made"/{page.js,page.css,page.js.gz,page.css.gz,policy.txt,report.js,report_policy.txt}
  echo '[]' >"$made/parts.json"
  deliver "$made"
  rm -r "$made"
  rm -f "$out/stamp"
}

install_packages() {
  local lock
  lock=$(cd "$page" && cat package.json package-lock.json .npmrc | sha256sum)
  [[ -f $folder/installed && $(<"$folder/installed") == "$lock" ]] && return
  rm -rf "$folder"
  mkdir -p "$folder"
  (cd "$page" && cp package.json package-lock.json .npmrc "$folder")
  local said
  if ! said=$(npm ci --prefix "$folder" --ignore-scripts --prefer-offline --fetch-retries 1 \
    --fetch-retry-mintimeout 1000 2>&1); then
    printf '%s\n' "$said" >&2
    return 1
  fi
  printf '%s\n' "$lock" >"$folder/installed"
}

if [[ $folder == --without ]]; then
  make_without
  exit
fi

stamp=$(cd "$page" && sources | xargs -d '\n' sha256sum)
[[ -f $out/stamp && $(<"$out/stamp") == "$stamp" ]] && exit 0

if ! install_packages; then
  echo "warning: camway view has no page: npm could not install its packages. The next build tries again." >&2
  make_without
  exit
fi
rm -rf "$folder/src" "$folder/test" "$folder/made"
(cd "$page" && cp -r src test build.mjs index.html page.css tsconfig.json "$folder")
(cd "$folder" && node build.mjs "$folder/made" && node "$here/pack.mjs" "$folder/made") >"$folder/build.log" 2>&1 ||
  { cat "$folder/build.log" >&2; exit 1; }
deliver "$folder/made"
printf '%s\n' "$stamp" >"$out/stamp"
