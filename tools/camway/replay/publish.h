// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/common/commands.h"

namespace camway::tools {

struct PublishOptions {
  std::string
      url;  ///< of the LCM network; empty: the environment's LCM_DEFAULT_URL, else LCM's own
  std::string prefix = "CAMWAY";
  double speed = 1.0;   ///< of the recording; 0: as fast as the daemon's socket takes it
  double wait_s = 5.0;  ///< how long to wait for answers after the last request
};

/// Sends the requests of `log` (planning and occupancy) to a running daemon, byte for byte and in
/// the rhythm in which they came, and counts how many planning requests are answered. A negative
/// exit code if not all are. Signed ones are stale by now: they are taken out of their envelopes,
/// and, with `keys`, checked and signed anew; nothing else is sent then.
ExitCode publish_log(const std::filesystem::path& log, const PublishOptions& options,
                     std::shared_ptr<const wire::MessageKeys> keys);

}  // namespace camway::tools
