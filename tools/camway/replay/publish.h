// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/replay/published_session.h"

namespace camway::tools {

struct PublishOptions {
  std::string url;  ///< LCM network; empty: LCM_DEFAULT_URL of the environment, else LCM's default
  std::string prefix = "CAMWAY";
  double speed = 1.0;   ///< relative to the recording; 0: as fast as the daemon's socket accepts
  double wait_s = 5.0;  ///< time to wait for answers after the last request
  /// Whether to send each request when the one before is answered, or after `wait_s`; then `speed`
  /// does not count.
  bool lockstep = false;
  /// Number of times to send all, each time with new ids. [Limit: 1 <= value]
  int times = 1;
  /// The planning requests to send, and nothing else; all messages if unset.
  std::optional<RequestKeys> wanted = {};
};

/// Sends the requests for planning and for occupancy of `log`, and its changes of scenes, to a
/// running daemon, with the recorded pauses, and counts the answers by status. All ids are new to
/// the daemon, which would repeat its answers to the recorded ones, and `least_revision` is 0;
/// else the requests are as recorded. Returns kNoDaemon if none was heard, and kNegative if a
/// planning request is not answered or a change is not made. Recorded signatures are stale, so
/// requests are taken out of their envelopes. With `keys`, only requests with a valid signature are
/// sent, signed anew.
ExitCode publish_log(const std::filesystem::path& log, const PublishOptions& options,
                     std::shared_ptr<const wire::MessageKeys> keys);

}  // namespace camway::tools
