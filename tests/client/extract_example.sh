#!/bin/sh
# SPDX-License-Identifier: MIT
# Prints the example in the documentation of a header ($1) as a program: the lines of doc comments
# that are indented as code.
set -eu
echo '#include <iostream>'
echo '#include <camway/client.h>'
echo 'int main() {'
sed -n 's|^///     ||p' "$1"
echo '}'
