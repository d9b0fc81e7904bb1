// SPDX-License-Identifier: MIT
#include "daemon/service/status.h"

#include <algorithm>

#include "daemon/scene/occupancy_mirror.h"
#include "daemon/service/version.h"
#include "daemon/service/wire_convert.h"

namespace camway::service {
namespace {

scene_info_t info_of(const scene::Snapshot& snapshot) {
  scene_info_t info{};
  info.name = clipped(snapshot.name, wire::kMaxSceneNameBytes);
  info.revision = static_cast<std::int64_t>(snapshot.revision);
  info.digest = clipped(snapshot.digest, wire::kMaxDigestBytes);
  info.num_triangles = static_cast<std::int64_t>(snapshot.index.size());
  if (!snapshot.index.bounds().isEmpty()) {
    std::copy_n(snapshot.index.bounds().min().data(), 3, info.bounds_min_m);
    std::copy_n(snapshot.index.bounds().max().data(), 3, info.bounds_max_m);
  }
  if (snapshot.occupancy) info.occupancy_resolution_m = snapshot.occupancy->resolution_m();
  return info;
}

}  // namespace

status_t make_status(const Core& core, std::chrono::duration<double> uptime) {
  status_t status{};
  status.utime = utime_now();
  status.version = kVersion;
  status.uptime_s = uptime.count();
  status.num_workers = core.workers.workers();
  status.queued_requests = static_cast<std::int32_t>(core.workers.queued());
  status.running_requests = static_cast<std::int32_t>(core.workers.running());
  status.answered_requests = core.counters.answered;
  status.repeated_requests = core.counters.repeated;
  status.overloaded_requests = core.counters.overloaded;
  status.malformed_messages = core.counters.malformed;

  const std::vector<std::shared_ptr<const scene::Snapshot>> scenes = core.scenes.list();
  status.total_scenes = static_cast<std::int32_t>(scenes.size());
  std::size_t size = static_cast<std::size_t>(status.getEncodedSize());
  for (const std::shared_ptr<const scene::Snapshot>& snapshot : scenes) {
    scene_info_t info = info_of(*snapshot);
    size += static_cast<std::size_t>(info._getEncodedSizeNoHash());
    if (size > wire::kMaxMessageBytes) break;
    status.scenes.push_back(std::move(info));
  }
  status.num_scenes = static_cast<std::int32_t>(status.scenes.size());
  return status;
}

}  // namespace camway::service
