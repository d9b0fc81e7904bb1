// SPDX-License-Identifier: MIT
#include "client/status_wire.h"

#include <camway/status_t.hpp>

#include "client/scene_wire.h"
#include "lcmtypes/wire_check.h"

namespace camway {
namespace {

DaemonStatus from_wire(const status_t& wire) {
  DaemonStatus status;
  status.status = Status::kOk;
  status.version = wire.version;
  status.uptime_s = wire.uptime_s;
  status.num_workers = wire.num_workers;
  status.queued_requests = wire.queued_requests;
  status.running_requests = wire.running_requests;
  status.answered_requests = wire.answered_requests;
  status.repeated_requests = wire.repeated_requests;
  status.overloaded_requests = wire.overloaded_requests;
  status.malformed_messages = wire.malformed_messages;
  status.watched_paths = wire.watched_paths;
  status.broken_paths = wire.broken_paths;
  status.total_scenes = wire.total_scenes;
  for (const scene_info_t& scene : wire.scenes) status.scenes.push_back(from_wire(scene));
  return status;
}

}  // namespace

std::optional<DaemonStatus> read_status(std::span<const std::uint8_t> bytes) {
  const wire::Decoded<status_t> decoded = wire::decode<status_t>(bytes);
  if (!decoded.message) return std::nullopt;
  return from_wire(*decoded.message);
}

}  // namespace camway
