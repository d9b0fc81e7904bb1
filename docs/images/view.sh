#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Makes the pictures of docs/view.md anew, with the built camway, in Chromium: docs/images/view-*.png.
set -euo pipefail
cd "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../.."
ctest --preset dev --tests-regex '^(npm.install|browser.pictures)$' --output-on-failure
cp build/dev/tests/tools/view/browser/pictures/view-*.png docs/images
