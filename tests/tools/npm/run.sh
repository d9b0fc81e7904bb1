#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Runs a test that uses the packages which install.sh has put into a folder.
#
#   run.sh FOLDER TEST      exit code: that of the test; 77: not run, as the packages are not there
set -euo pipefail

if [[ ! -f $1/installed ]]; then
  echo "not run: the packages of npm are not installed (see the test npm.install)"
  exit 77
fi
CAMWAY_NPM=$1 exec node "$2"
