// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "lcmtypes/wire/auth/message_auth.h"
#include "tools/camway/replay/event_log.h"

namespace camway::tools {

/// Puts the message that a recorded envelope holds in its place. With `keys` an event whose
/// signature is not good, or that has none, is left as it is, and why is returned; without them
/// only an envelope that is broken. Its age does not count: recordings are old.
std::optional<wire::Distrust> open_event(const wire::MessageKeys* keys, LogEvent& event);

}  // namespace camway::tools
