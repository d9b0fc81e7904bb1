// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace camway::scene {

/// The result of an import process.
struct ImportProcessResult {
  enum class End {
    kFinished,     ///< `output` holds a record: a mesh or a refusal
    kOutOfMemory,  ///< the process needed more than the limit
    kOutOfTime,    ///< killed at its limit of wall clock or processor time
    kStopped,      ///< killed because a stop was requested
    kCrashed,      ///< ended by a signal or an unknown exit code, which `detail` names
    kNotStarted,   ///< `detail` says why
  };
  End end = End::kNotStarted;
  std::vector<std::byte> output;  ///< the record; meaningful only for `kFinished`
  std::string detail;             ///< only for `kCrashed` and `kNotStarted`
};

/// The content that the import process reads.
enum class ImportTask { kMesh, kCameras };

/// Has `run_import_process` look for its programs in `folder` first. For libraries within programs
/// of others, such as an interpreter, beside which there is none. Thread-safe.
void set_import_program_folder(std::filesystem::path folder);

/// Runs `camway-import`, for Open Inventor and VRML `camway-import-inventor`, or for STEP and IGES
/// `camway-import-cad`, on `file` and waits for it. Looks for the program in the folder of
/// `set_import_program_folder`, beside the running executable, then in the absolute directories of
/// PATH. The process inherits nothing: no standard streams, no descriptors but that of its output,
/// no environment, default signals. It is killed when this process ends, and confines itself before
/// it opens the file (`import_confinement.h`). A stop ends it within milliseconds.
///
/// `time_limit_s` applies to the wall clock, and, rounded up to seconds plus one, to the processor
/// time; it is clamped to [0, 1e6]. `memory_limit_bytes`: limit of the address space and of the
/// output.
///
/// Thread-safe: no code of this process runs in the child before exec.
ImportProcessResult run_import_process(const std::filesystem::path& file,
                                       std::size_t memory_limit_bytes, double time_limit_s,
                                       const std::stop_token& stop = {},
                                       ImportTask task = ImportTask::kMesh);

}  // namespace camway::scene
