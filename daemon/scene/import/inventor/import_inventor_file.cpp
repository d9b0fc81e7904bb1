// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/import_inventor_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/common/included_files.h"
#include "daemon/scene/import/common/mapped_file.h"
#include "daemon/scene/import/inventor/inventor_reader.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::inventor {

int import_inventor_file(const std::string& file) {
  const import_process::MappedFile mapped(file);
  if (!mapped.is_open()) {
    // The file is there and not empty, so what is missing is address space.
    return errno == ENOMEM ? import_record::kExitOutOfMemory
                           : import_process::refuse("cannot be opened");
  }
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::canonical(file, error).parent_path();
  base::Result<import_record::Record> read = read_inventor(
      mesh_readers::without_bom(mapped.bytes()), {folder.string(), files_below(file)});
  if (!read) return import_process::refuse(std::move(read.error));
  return import_process::write_record(*read);
}

}  // namespace camway::scene::inventor
