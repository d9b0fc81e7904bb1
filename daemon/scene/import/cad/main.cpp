// SPDX-License-Identifier: MIT

/// camway-import-cad FILE MEMORY_BYTES CPU_SECONDS: reads a STEP or IGES file and writes the record
/// of `record_layout.h` to file descriptor 3. Started by `import_mesh` only. The only program that
/// sees Open CASCADE; apart from `camway-import`, whose formats need not wait until that is loaded.

#include "daemon/scene/import/cad/cad_library.h"
#include "daemon/scene/import/cad/import_cad_file.h"
#include "daemon/scene/import/common/import_process_main.h"

int main(int argc, char** argv) {
  namespace cad = camway::scene::cad;
  camway::scene::import_process::run(argc, argv, cad::start_cad, cad::import_cad_file);
}
