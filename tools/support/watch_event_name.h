// SPDX-License-Identifier: MIT
#pragma once

#include <camway/watch.h>

namespace camway::tools {

/// Returns the name of an event, such as "broken".
const char* name_of(WatchEvent::Kind kind);

}  // namespace camway::tools
