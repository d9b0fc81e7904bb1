#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Tests of the page that need its packages, where the build has installed them.
#
#   page_test.sh PART FOLDER OUT      as make_page.sh; exit code 77: not run, as there are no packages
set -euo pipefail

here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
readonly root=$here/../../../..
readonly embed=$root/tools/view/page/embed
readonly folder=$2
readonly out=$3
scratch=$(mktemp -d)
readonly scratch
trap 'rm -rf "$scratch"' EXIT

fail() { printf '%s\n' "$*"; exit 1; }

needs_packages() {
  [[ -f $folder/installed ]] || { echo "not run: the build could not install the packages of the page"; exit 77; }
}

case $1 in
  types)
    needs_packages
    cd "$folder" && node_modules/.bin/tsc --noEmit
    ;;
  functions)
    needs_packages
    [[ -n $(find "$folder/test" -name "*.test.ts") ]] || { echo "not run: there are no tests of functions"; exit 77; }
    CAMWAY_SOURCE=$root node "$folder/test/run.mjs"
    ;;
  same_bytes)
    needs_packages
    (cd "$folder" && node build.mjs "$scratch/made" && node "$embed/pack.mjs" "$scratch/made") >"$scratch/said"
    for file in "$scratch"/made/*; do
      cmp "$file" "$out/$(basename "$file")" || fail "another build of the page has other bytes"
    done
    ;;
  without_npm)
    # An npm that reaches no registry.
    mkdir "$scratch/bin"
    printf '#!/bin/sh\necho ENOTFOUND\nexit 1\n' >"$scratch/bin/npm"
    chmod +x "$scratch/bin/npm"
    said=$(PATH=$scratch/bin:$PATH "$embed/make_page.sh" "$scratch/packages" "$scratch/out" 2>&1)
    [[ $said == *ENOTFOUND*"warning: camway view has no page"* ]] || fail "no warning: $said"
    grep -q 'built without its page' "$scratch/out/index.html" || fail "the page does not say what is missing"
    [[ -f $scratch/out/page.js && ! -s $scratch/out/page.js ]] || fail "there is a script"
    # The next build tries again; and one that is told to make none makes the same.
    [[ $(PATH=$scratch/bin:$PATH "$embed/make_page.sh" "$scratch/packages" "$scratch/out" 2>&1) == "$said" ]] ||
      fail "the next build does not try again"
    "$embed/make_page.sh" --without "$scratch/other"
    diff -r "$scratch/out" "$scratch/other"
    ;;
  *)
    fail "no part $1"
    ;;
esac
