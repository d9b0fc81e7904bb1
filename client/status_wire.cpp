// SPDX-License-Identifier: MIT
#include "client/status_wire.h"

#include <algorithm>
#include <iterator>

#include <camway/status_t.hpp>

#include "lcmtypes/wire_check.h"

namespace camway {
namespace {

SceneInfo from_wire(const scene_info_t& wire) {
  SceneInfo scene;
  scene.name = wire.name;
  scene.revision = wire.revision;
  scene.digest = wire.digest;
  scene.num_triangles = wire.num_triangles;
  std::copy(std::begin(wire.bounds_min_m), std::end(wire.bounds_min_m), scene.bounds_min_m.begin());
  std::copy(std::begin(wire.bounds_max_m), std::end(wire.bounds_max_m), scene.bounds_max_m.begin());
  scene.occupancy_resolution_m = wire.occupancy_resolution_m;
  return scene;
}

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
