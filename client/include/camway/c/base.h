// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_BASE_H
#define CAMWAY_C_BASE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The version of this interface. Programs run with any library of the same major version and the
/// same or a higher minor version. The library's name has the major version: libcamway_c.so.1.
#define CAMWAY_ABI_MAJOR 1
#define CAMWAY_ABI_MINOR 0
#define CAMWAY_ABI_VERSION (CAMWAY_ABI_MAJOR * 1000 + CAMWAY_ABI_MINOR)

/// Returns CAMWAY_ABI_VERSION of the library that the program runs with.
int32_t camway_abi_version(void);

/// Returns the version of Camway that the library is of, such as "0.1.0".
const char* camway_version(void);

/// The outcome of a call. The daemon sets the values below 100, the client those below 200, and
/// this interface the others.
typedef int32_t camway_status;
enum {
  CAMWAY_OK = 0,
  CAMWAY_PARTIAL = 1,     ///< a path that still collides, or is free but breaks a motion limit
  CAMWAY_INFEASIBLE = 2,  ///< no path exists, which is proved
  CAMWAY_TIMEOUT = 3,     ///< the daemon's deadline came first; there may be a path that collides
  CAMWAY_INVALID = 4,     ///< the request is wrong; the error names the part at fault
  CAMWAY_UNKNOWN_SCENE = 5,   ///< the daemon holds no scene of this name
  CAMWAY_INTERNAL_ERROR = 6,  ///< a fault of the daemon, or of this library
  CAMWAY_OVERLOADED = 7,      ///< the daemon's queue stayed full until the call's deadline
  CAMWAY_MALFORMED = 8,       ///< client and daemon do not match
  CAMWAY_NO_MAP = 9,          ///< the scene was loaded without an occupancy map
  CAMWAY_CANCELLED = 10,      ///< the caller cancelled the request
  CAMWAY_LIMIT = 11,          ///< the request would exceed a limit of the daemon
  CAMWAY_STOPPING = 12,       ///< the daemon stopped before it changed anything
  CAMWAY_OLD_SCENE = 13,      ///< the daemon's scene is older than `least_revision`

  CAMWAY_NO_DAEMON = 100,         ///< no answer came, and no daemon was heard
  CAMWAY_NO_ANSWER = 101,         ///< a daemon was heard, but its answer did not come completely
  CAMWAY_NETWORK_UNUSABLE = 102,  ///< LCM cannot be opened or cannot send
  CAMWAY_BAD_ANSWER = 103,        ///< the answer cannot be read: client and daemon do not match
  CAMWAY_BUSY = 104,              ///< a call that waits was made in a handler of the same client

  CAMWAY_BAD_ARGUMENT = 200,  ///< NULL, a handle that is not live, or a struct without its size
  CAMWAY_OUT_OF_MEMORY = 201,
  CAMWAY_NOT_READY = 202  ///< the answer did not come within the time that the caller waits
};

/// Returns the name of a status, such as "ok" or "no_daemon"; "unknown" for any other number.
const char* camway_status_name(camway_status status);

/// Returns why the last call of this thread that did not return CAMWAY_OK failed, and the remedy;
/// "" if there was none. The text is good until the next such call of the thread.
const char* camway_last_error(void);

/// Returns the number of handles of this process that are not freed, for tests of programs.
int64_t camway_num_handles(void);

/// A position and an orientation.
typedef struct camway_pose {
  double position_m[3];
  double orientation_wxyz[4];  ///< unit quaternion; all zero for none
} camway_pose;

#ifdef __cplusplus
}
#endif

#endif
