// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "daemon/scene/import/record/record_layout.h"

/// The common part of the programs that read scene files. They are started by `import_mesh` alone, as
/// PROGRAM FILE MEMORY_BYTES CPU_SECONDS, and write a record to `kOutputFd`.
namespace camway::scene::import_process {

/// Writes a record, with the counts of its header. Returns the exit code.
int write_record(import_record::Record& record);

/// Writes a record that says why the file cannot be read. Returns the exit code.
int refuse(std::string reason);

/// Checks the arguments, limits the process, calls `prepare`, confines the process
/// (`import_confinement.h`), calls `import` with the name of the file, and ends the process with
/// the code that it returns. `prepare` is for what confinement forbids, and sees no byte of the
/// file. Exceptions of `import` become refusals.
[[noreturn]] int run(int argc, char** argv, const std::function<void()>& prepare,
                     const std::function<int(const std::string&)>& import);

}  // namespace camway::scene::import_process
