// SPDX-License-Identifier: MIT
#pragma once

namespace camway {

/// Calls a handler of the user, if there is one. Exceptions are ignored: they must not end the
/// thread, and nothing could report them.
template <class Handler, class... Arguments>
void call_handler(const Handler& handler, const Arguments&... arguments) {
  if (!handler) return;
  try {
    handler(arguments...);
  } catch (...) {
  }
}

}  // namespace camway
