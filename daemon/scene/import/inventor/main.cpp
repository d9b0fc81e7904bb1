// SPDX-License-Identifier: MIT

/// camway-import-inventor FILE MEMORY_BYTES CPU_SECONDS: reads an Open Inventor or VRML scene and
/// writes the record of `record_layout.h` to file descriptor 3. Started by `import_mesh` only. The
/// only program that sees Coin; apart from `camway-import`, whose formats need not wait until Coin
/// has started.

#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/inventor/coin_library.h"
#include "daemon/scene/import/inventor/import_inventor_file.h"

int main(int argc, char** argv) {
  namespace inventor = camway::scene::inventor;
  camway::scene::import_process::run(argc, argv, inventor::start_coin,
                                     inventor::import_inventor_file);
}
