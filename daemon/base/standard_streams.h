// SPDX-License-Identifier: MIT
#pragma once

namespace camway::base {

/// Opens /dev/null on each of the descriptors 0, 1 and 2 that is closed. Otherwise a file or socket
/// that the program opens later could get such a number, and receive standard output or standard
/// error. Descriptor 0 is opened for writing only, and 1 and 2 for reading only. So reading from
/// standard input and writing to standard output or standard error still fail with EBADF.
///
/// Returns false if /dev/null cannot be opened; then a descriptor may still be closed. Requires
/// that the program has opened no file yet and has no other threads: `main` calls it first.
[[nodiscard]] bool occupy_closed_standard_streams();

}  // namespace camway::base
