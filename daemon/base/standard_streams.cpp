// SPDX-License-Identifier: MIT
#include "daemon/base/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

namespace camway::base {

bool occupy_closed_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) != -1) continue;
    // Open in the direction opposite to the stream's, so that lost output is still noticed. open()
    // takes the lowest free number, which is this stream's, since those below are open.
    const int mode = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (open("/dev/null", mode) != stream) return false;
  }
  return true;
}

}  // namespace camway::base
