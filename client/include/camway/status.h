// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace camway {

/// A start of the daemon. An answer with another id than those before comes from a daemon that was
/// started anew.
struct DaemonStart {
  std::int64_t id = 0;  ///< 0 without an answer of a daemon
  bool durable =
      false;  ///< whether the scenes outlive the daemon; if not, it has forgotten changes
};

/// The outcome of a call. The daemon sets the values below 100, which are those of the wire; the
/// client sets the others.
enum class Status {
  kOk = 0,
  /// A path that still collides where `remaining` says, or a free path that breaks a motion limit.
  kPartial = 1,
  kInfeasible = 2,  ///< no path exists, and the answer holds the proof
  /// The deadline came first. A plan holds the best path so far, if there is one; a scene is
  /// unchanged.
  kTimeout = 3,
  kInvalid = 4,        ///< the request is wrong; `error` names the part at fault
  kUnknownScene = 5,   ///< the daemon holds no scene of this name
  kInternalError = 6,  ///< a fault of the daemon
  kOverloaded = 7,     ///< the daemon's queue stayed full until the call's deadline
  kMalformed = 8,      ///< the daemon could not read the request: client and daemon do not match
  kNoMap = 9,          ///< the scene was loaded without an occupancy map
  kCancelled = 10,     ///< the caller cancelled the request
  kLimit = 11,         ///< the request would exceed a limit of the daemon, which `error` names
  kStopping = 12,      ///< the daemon stopped before it changed anything; no other daemon was heard
  /// The daemon holds an older revision of the scene than `PlanRequest::least_revision`.
  kOldScene = 13,

  kNoDaemon = 100,         ///< no answer came, and no daemon was heard
  kNoAnswer = 101,         ///< a daemon was heard, but its answer did not come completely
  kNetworkUnusable = 102,  ///< LCM cannot be opened or cannot send
  kBadAnswer = 103,        ///< the answer cannot be read: client and daemon do not match
  kBusy = 104,             ///< a blocking member of a client was called from one of its handlers
};

/// Returns the name of a status, such as "ok", "unknown_scene" or "no_daemon"; "unknown" for any
/// other number.
std::string to_string(Status status);

}  // namespace camway
