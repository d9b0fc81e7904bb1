// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace camway::testing {

/// A program of the import process, whose library is loaded once for many files.
struct ForkedReader {
  std::function<void()> prepare;                   ///< called once, before the first file
  std::function<int(const std::string&)> import;   ///< as in `import_process::run`
  std::function<int(const std::string&)> cameras;  ///< the same for cameras; may be null
};

/// Reads each file that standard input names, one in a line, as the daemon does: in a process that
/// is confined and limited alike, and with the answer checked by the same code. Writes a line for
/// each to standard output: `read`, `refused`, `limited` (by memory or time), `fallen` (the process
/// died) or `broken` (its answer is no record), a tab, and what was said. A line that begins with
/// `cameras ` reads cameras. A fork takes a hundredth of the time that starting the program takes,
/// which links large libraries. Returns the exit code.
int serve_forked(const ForkedReader& reader);

}  // namespace camway::testing
