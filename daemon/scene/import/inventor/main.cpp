// SPDX-License-Identifier: MIT

/// camway-import-inventor FILE MEMORY_BYTES CPU_SECONDS: reads an Open Inventor or VRML scene and
/// writes the record of `record_layout.h` to file descriptor 3. Started by `import_mesh` only. The
/// only program that sees Coin; apart from `camway-import`, whose formats need not wait until Coin
/// has started.

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "daemon/scene/import/common/import_process_main.h"
#include "daemon/scene/import/common/included_files.h"
#include "daemon/scene/import/common/mapped_file.h"
#include "daemon/scene/import/inventor/coin_library.h"
#include "daemon/scene/import/inventor/inventor_reader.h"

namespace {

namespace import_process = camway::scene::import_process;
namespace inventor = camway::scene::inventor;

int import_file(const std::string& file) {
  const import_process::MappedFile mapped(file);
  if (!mapped.is_open()) {
    // The file is there and not empty, so what is missing is address space.
    return errno == ENOMEM ? camway::scene::import_record::kExitOutOfMemory
                           : import_process::refuse("cannot be opened");
  }
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::canonical(file, error).parent_path();
  camway::base::Result<camway::scene::import_record::Record> read =
      inventor::read_inventor(mapped.bytes(), {folder.string(), camway::scene::files_below(file)});
  if (!read) return import_process::refuse(std::move(read.error));
  return import_process::write_record(*read);
}

}  // namespace

int main(int argc, char** argv) {
  import_process::run(argc, argv, inventor::start_coin, import_file);
}
