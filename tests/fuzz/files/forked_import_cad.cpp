// SPDX-License-Identifier: MIT

/// forked_import_cad: `camway-import-cad` for many files; see forked_reader.h.

#include "daemon/scene/import/cad/cad_library.h"
#include "daemon/scene/import/cad/import_cad_file.h"
#include "tests/fuzz/files/forked_reader.h"

int main() {
  namespace cad = camway::scene::cad;
  return camway::testing::serve_forked({cad::start_cad, cad::import_cad_file, {}});
}
