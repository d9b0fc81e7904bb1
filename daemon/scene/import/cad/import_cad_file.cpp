// SPDX-License-Identifier: MIT
#include "daemon/scene/import/cad/import_cad_file.h"

#include <new>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/scene/import/cad/cad_reader.h"
#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/record/cad_names.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::cad {

int import_cad_file(const std::string& file) {
  try {
    base::Result<import_record::Record> read = read_cad(file, is_iges_name(file));
    if (!read) return import_process::refuse(std::move(read.error));
    return import_process::write_record(*read);
  } catch (const std::bad_alloc&) {
    return import_record::kExitOutOfMemory;
  }
}

}  // namespace camway::scene::cad
