// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <memory>
#include <string>
#include <vector>

#include "tools/camway/load/load_tally.h"

namespace camway::tools {

/// The scene here that answers are compared with.
struct LoadScene {
  std::string name;
  std::string digest;
};

struct LoadOptions {
  std::string url;  ///< LCM network; empty: as the client's default
  std::string prefix = "CAMWAY";
  std::shared_ptr<const Authentication> authentication;  ///< null: nothing is signed
  int clients = 8;
  double seconds = 10.0;      ///< no request is begun later
  std::int64_t requests = 0;  ///< of all clients together; 0: as many as the time allows
  int daemon_pid = 0;         ///< of the process whose memory is watched; 0: none
};

/// Why there can be no run.
struct LoadFault {
  Status status = Status::kOk;
  std::string error;  ///< empty exactly when `status` is kOk
};

/// Whether a daemon answers and holds that very scene: with another one every answer would be
/// called wrong, and nobody would know why.
LoadFault fault_of_daemon(Client& client, const LoadScene& scene);

struct LoadResult {
  std::string error;                 ///< why there was no run; empty if there was one
  Status status = Status::kInvalid;  ///< of that error
  LoadTally tally;
  double elapsed_s = 0.0;
  std::vector<MemorySample> memory;
};

/// Lets `clients` clients, each on a thread of its own, ask the questions in turn, each as soon as
/// the one before is answered, until time or requests are used up.
LoadResult run_load(const LoadScene& scene, const std::vector<LoadQuestion>& questions,
                    const LoadOptions& options);

}  // namespace camway::tools
