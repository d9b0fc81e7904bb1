// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "tools/camway/load/load_tally.h"

namespace camway::tools {

/// The local scene that answers are compared with.
struct LoadScene {
  std::string name;
  std::string digest;
};

struct LoadOptions {
  std::string url;  ///< LCM network; empty: the client's default
  std::string prefix = "CAMWAY";
  std::shared_ptr<const Authentication> authentication;  ///< null: messages are not signed
  int clients = 8;
  double seconds = 10.0;      ///< time after which no request is begun
  std::int64_t requests = 0;  ///< requests of all clients together; 0: as many as time allows
  int daemon_pid = 0;         ///< process whose memory is watched; 0: none
};

using Clients = std::vector<std::unique_ptr<Client>>;
/// Returns `options.clients` clients, or the error of the first one that cannot be used.
base::Result<Clients> make_clients(const LoadOptions& options);

/// The reason why there can be no run.
struct LoadFault {
  Status status = Status::kOk;
  std::string error;  ///< empty exactly when `status` is kOk
};

/// Checks that a daemon answers and holds the same scene. With another scene every answer would
/// count as wrong, without a reason.
LoadFault fault_of_daemon(Client& client, const LoadScene& scene);

struct LoadResult {
  std::string error;                 ///< reason why there was no run; empty if there was one
  Status status = Status::kInvalid;  ///< status of that error
  LoadTally tally;
  double elapsed_s = 0.0;
  std::vector<MemorySample> memory;
  /// Planners of the fleet after the run, and the requests that they can plan at a time; 0 if there
  /// is none.
  int planners = 0;
  int planner_slots = 0;
};

/// Runs `options.clients` clients, each on a thread of its own. Each sends the requests in turn,
/// the next one as soon as the last is answered, until time or requests are used up.
LoadResult run_load(const LoadScene& scene, const std::vector<LoadRequest>& requests,
                    const LoadOptions& options);

}  // namespace camway::tools
