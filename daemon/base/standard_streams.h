// SPDX-License-Identifier: MIT
#pragma once

namespace camway::base {

/// Opens /dev/null on those of the descriptors 0, 1 and 2 that are closed, so that no file or
/// socket that the program opens later gets one of these numbers and receives output meant for
/// standard output or standard error. Descriptor 0 is opened for writing only, and 1 and 2 for
/// reading only. So reading from standard input and writing to standard output or standard error
/// still fail with EBADF. Call it first in `main`, before anything opens a file and before other
/// threads exist. Returns false if /dev/null cannot be opened; then a descriptor may still be
/// closed.
[[nodiscard]] bool occupy_closed_standard_streams();

}  // namespace camway::base
