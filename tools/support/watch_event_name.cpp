// SPDX-License-Identifier: MIT
#include "tools/support/watch_event_name.h"

namespace camway::tools {

const char* name_of(WatchEvent::Kind kind) {
  switch (kind) {
    case WatchEvent::Kind::kAnswer:
      return "answer";
    case WatchEvent::Kind::kBroken:
      return "broken";
    case WatchEvent::Kind::kFree:
      return "free";
    case WatchEvent::Kind::kLost:
      return "lost";
    case WatchEvent::Kind::kWatched:
      return "watched";
    case WatchEvent::Kind::kBetter:
      return "better";
    case WatchEvent::Kind::kWithdrawn:
      return "withdrawn";
    case WatchEvent::Kind::kRestarted:
      return "restarted";
    case WatchEvent::Kind::kEnded:
      return "ended";
  }
  return "unknown";
}

}  // namespace camway::tools
