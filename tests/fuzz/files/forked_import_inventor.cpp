// SPDX-License-Identifier: MIT

/// forked_import_inventor: `camway-import-inventor` for many files; see forked_reader.h.

#include "daemon/scene/import/inventor/coin_library.h"
#include "daemon/scene/import/inventor/import_inventor_file.h"
#include "tests/fuzz/files/forked_reader.h"

int main() {
  namespace inventor = camway::scene::inventor;
  return camway::testing::serve_forked({inventor::start_coin, inventor::import_inventor_file, {}});
}
