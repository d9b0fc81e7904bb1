// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway {

/// How a call ended. Values below 100 are the daemon's, as on the wire; the others arise here.
enum class Status {
  kOk = 0,
  kPartial = 1,        ///< a path, but one that still collides where `remaining` says
  kInfeasible = 2,     ///< no path exists, and that was proved
  kTimeout = 3,        ///< planning hit the request's deadline; the best path so far is there
  kInvalid = 4,        ///< the request is wrong; the text says which part of it
  kUnknownScene = 5,   ///< the daemon holds no scene of this name
  kInternalError = 6,  ///< the daemon's fault
  kOverloaded = 7,     ///< the daemon's queue stayed full until the call's deadline
  kMalformed = 8,      ///< the daemon could not read the request: client and daemon do not match
  kNoMap = 9,          ///< the scene was loaded without an occupancy map
  kCancelled = 10,     ///< as the caller asked
  kLimit = 11,         ///< it would break a limit of the daemon's, which the text names
  kStopping = 12,      ///< the daemon ended before it changed anything, and no other was heard

  kNoDaemon = 100,         ///< nobody answered, and no daemon was heard
  kNoAnswer = 101,         ///< a daemon was heard, but its answer did not come, or not all of it
  kNetworkUnusable = 102,  ///< LCM cannot be opened or cannot send
  kBadAnswer = 103,        ///< an answer came that makes no sense: client and daemon do not match
  kBusy = 104,             ///< a handler of the client called what waits for the client
};

/// E.g. "ok", "unknown_scene", "no_daemon"; "unknown" for a number that is none of the above.
std::string to_string(Status status);

}  // namespace camway
