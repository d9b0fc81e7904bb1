// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::service {

/// Describes the build of this program, for `--version` and the log, e.g.
/// "0.1.0 (commit 1a2b3c4d5e6f, GNU 12.2.0, RelWithDebInfo, sanitizer address,undefined)". The
/// commit ends in "-dirty" where files were changed after it, and is "unknown" without a
/// repository.
std::string version_text();

}  // namespace camway::service
