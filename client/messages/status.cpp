// SPDX-License-Identifier: MIT
#include "client/messages/status.h"

#include <algorithm>

#include <camway/status_t.hpp>

#include "client/messages/convert.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/latency_buckets.h"

namespace camway {
void convert(const latency_t& wire, Latency& mine) {
  convert_common(wire, mine);
  mine.buckets.resize(std::min(wire.buckets.size(), wire::kLatencyBuckets));
}

void convert(const status_t& wire, DaemonStatus& mine) {
  static_assert(wire::lacks_only<status_t, DaemonStatus>({"utime"}));
  convert_common(wire, mine);
  mine.status = Status::kOk;
  mine.failed_reload = wire::printable(wire.failed_reload);
  mine.recording_folder = wire::printable(wire.recording_folder);
  mine.recording_trouble = wire::printable(wire.recording_trouble);
  mine.role = wire::printable(wire.role);
  for (FleetPlanner& planner : mine.planners) {
    for (std::string* text : {&planner.id, &planner.host, &planner.version}) {
      *text = wire::printable(std::move(*text));
    }
  }
}

std::optional<DaemonStatus> read_status(std::span<const std::uint8_t> bytes) {
  const wire::Decoded<status_t> decoded = wire::decode<status_t>(bytes);
  if (!decoded.message) return std::nullopt;
  DaemonStatus status;
  convert(*decoded.message, status);
  return status;
}

}  // namespace camway
