// SPDX-License-Identifier: MIT

/// camway-import-cad FILE MEMORY_BYTES CPU_SECONDS: reads a STEP or IGES file and writes the record
/// of `record_layout.h` to file descriptor 3. Started by `import_mesh` only. The only program that
/// sees Open CASCADE; apart from `camway-import`, whose formats need not wait until that is loaded.

#include <new>
#include <string>
#include <utility>

#include "daemon/scene/import/cad/cad_library.h"
#include "daemon/scene/import/cad/cad_reader.h"
#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/record/cad_names.h"

namespace {

namespace cad = camway::scene::cad;
namespace import_process = camway::scene::import_process;

int import_file(const std::string& file) {
  try {
    camway::base::Result<camway::scene::import_record::Record> read =
        cad::read_cad(file, camway::scene::is_iges_name(file));
    if (!read) return import_process::refuse(std::move(read.error));
    return import_process::write_record(*read);
  } catch (const std::bad_alloc&) {
    return camway::scene::import_record::kExitOutOfMemory;
  }
}

}  // namespace

int main(int argc, char** argv) { import_process::run(argc, argv, cad::start_cad, import_file); }
