// SPDX-License-Identifier: MIT
#include <camway/status.h>

namespace camway {

std::string to_string(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kPartial:
      return "partial";
    case Status::kInfeasible:
      return "infeasible";
    case Status::kTimeout:
      return "timeout";
    case Status::kInvalid:
      return "invalid";
    case Status::kUnknownScene:
      return "unknown_scene";
    case Status::kInternalError:
      return "internal_error";
    case Status::kOverloaded:
      return "overloaded";
    case Status::kMalformed:
      return "malformed";
    case Status::kNoMap:
      return "no_map";
    case Status::kCancelled:
      return "cancelled";
    case Status::kLimit:
      return "limit";
    case Status::kStopping:
      return "stopping";
    case Status::kOldScene:
      return "old_scene";
    case Status::kNoDaemon:
      return "no_daemon";
    case Status::kNoAnswer:
      return "no_answer";
    case Status::kNetworkUnusable:
      return "network_unusable";
    case Status::kBadAnswer:
      return "bad_answer";
    case Status::kBusy:
      return "busy";
  }
  return "unknown";
}

}  // namespace camway
