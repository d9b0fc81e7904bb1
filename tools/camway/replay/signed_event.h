// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/record/event_log.h"
#include "lcmtypes/wire/auth/message_auth.h"

namespace camway::tools {

/// Replaces a recorded envelope by its payload. Returns nothing on success; otherwise leaves the
/// event as it is and returns the reason. With `keys`, the signature must be valid; without, only
/// an envelope that cannot be read is refused. The age of a recording does not matter.
std::optional<wire::Distrust> open_event(const wire::MessageKeys* keys, record::LogEvent& event);

}  // namespace camway::tools
