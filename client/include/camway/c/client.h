// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_CLIENT_H
#define CAMWAY_C_CLIENT_H

#include <camway/c/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/// A connection to a daemon over LCM, with a thread of its own.
typedef struct camway_client camway_client;

typedef struct camway_client_options {
  uint32_t struct_size;
  int32_t retries;           ///< repetitions without a sign of life after which a call ends; 5
  const char* url;           ///< of the LCM network; NULL: LCM_DEFAULT_URL, or this host alone
  const char* prefix;        ///< first part of channel names, as the daemon's; NULL: "CAMWAY"
  const char* client_id;     ///< differs from that of all others; NULL: random
  double deadline_s;         ///< largest duration of a call; 60
  double change_deadline_s;  ///< for a change of a scene; 0: the daemon's default
  double try_timeout_s;      ///< wait before the first repetition of a request; 0.4
  double max_try_timeout_s;  ///< longest wait before a repetition; 5
  double watch_lease_s;      ///< how long a path stays watched after the client's last message; 30
  const char* key_file;      ///< keys that sign messages, as the daemon's auth.key_file; NULL: none
  double key_window_s;       ///< largest difference of a signed message's time and the clock; 30
} camway_client_options;

/// Sets all members to their defaults. `struct_size` is `sizeof(camway_client_options)`.
camway_status camway_client_options_init(camway_client_options* options, size_t struct_size);

/// Opens the network. Takes up to ten seconds where multicast does not work. NULL for `options`
/// means the defaults. Fails with CAMWAY_INVALID for bad options, CAMWAY_NETWORK_UNUSABLE for no
/// network.
camway_status camway_client_create(const camway_client_options* options, camway_client** client);

/// Ends all pending requests and watches, and waits until no handler runs. Handlers may call it,
/// and must not use the client afterwards. While another thread waits in a call of the client, that
/// call goes on, and the client ends with it.
camway_status camway_client_free(camway_client* client);

/// Returns the id under which the daemon knows the client; NULL if the handle is not live.
const char* camway_client_id(const camway_client* client);

/// The heartbeat of a daemon.
typedef struct camway_daemon_status {
  uint32_t struct_size;  ///< bytes that the library has set
  int32_t num_workers;   ///< requests that can be planned at the same time
  int32_t num_scenes;
  int32_t queued_requests;   ///< requests that wait for a worker
  int32_t running_requests;  ///< requests that are being planned
  int32_t durable;   ///< whether scenes outlive the daemon; if not, a restart forgets changes
  int64_t start_id;  ///< differs after a restart of the daemon
  double uptime_s;
  char version[64];  ///< cut if it is longer
} camway_daemon_status;

/// Waits for the next heartbeat, which comes once a second by default. `struct_size` is
/// `sizeof(camway_daemon_status)`. CAMWAY_NO_DAEMON if none comes within `timeout_s`.
camway_status camway_daemon_status_get(camway_client* client, double timeout_s,
                                       camway_daemon_status* status, size_t struct_size);

#ifdef __cplusplus
}
#endif

#endif
