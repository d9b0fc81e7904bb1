// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace camway::scene {

/// How an import process ended.
struct ImportProcessResult {
  enum class End {
    kFinished,     ///< `output` holds what it wrote, a mesh or a refusal
    kOutOfMemory,  ///< it needed more than the limit
    kOutOfTime,    ///< wall clock or processor time; it was killed
    kStopped,      ///< a stop was asked for; it was killed
    kCrashed,      ///< a signal ended it; `detail` names it
    kNotStarted,   ///< `detail` says why
  };
  End end = End::kNotStarted;
  std::vector<std::byte> output;
  std::string detail;
};

/// Runs `camway-import` on `file` and waits for it. The program is looked for beside the running
/// executable, then in the absolute directories of PATH. The process gets nothing but the file's
/// name: no standard streams, no descriptor of ours, no environment, default signals; it dies with
/// us, and confines itself before it looks at the file (`import_confinement.h`).
/// A stop ends it within milliseconds.
/// May be called from any thread: nothing of this process runs in the child but exec.
ImportProcessResult run_import_process(const std::filesystem::path& file,
                                       std::size_t memory_limit_bytes, double time_limit_s,
                                       const std::stop_token& stop = {});

}  // namespace camway::scene
