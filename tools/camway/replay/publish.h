// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/common/commands.h"

namespace camway::tools {

struct PublishOptions {
  std::string url;  ///< LCM network; empty: LCM_DEFAULT_URL of the environment, else LCM's default
  std::string prefix = "CAMWAY";
  double speed = 1.0;   ///< relative to the recording; 0: as fast as the daemon's socket accepts
  double wait_s = 5.0;  ///< time to wait for answers after the last request
  /// Whether to send each request when the one before is answered, or after `wait_s`; then `speed`
  /// does not count.
  bool lockstep = false;
  /// Number of times to send all. From the second time on requests have new ids, because a daemon
  /// has the answers to the old ones. [Limit: 1 <= value]
  int times = 1;
  /// Clients and ids of the planning requests to send, and no occupancy requests; all if unset.
  std::optional<std::set<std::pair<std::string, std::int64_t>>> wanted = {};
};

/// Sends the planning and occupancy requests of `log` to a running daemon, the first time with the
/// same bytes, with the recorded pauses, and counts the planning requests that are answered.
/// Returns kNegative unless all are. Recorded signatures are stale, so requests are taken out of
/// their envelopes. With `keys`, only requests with a valid signature are sent, signed anew.
ExitCode publish_log(const std::filesystem::path& log, const PublishOptions& options,
                     std::shared_ptr<const wire::MessageKeys> keys);

}  // namespace camway::tools
