// SPDX-License-Identifier: MIT
#include "daemon/service/status.h"

#include "daemon/service/scene_work.h"
#include "daemon/service/version.h"

namespace camway::service {
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
  status.watched_paths = core.counters.watched_paths;
  status.broken_paths = core.counters.broken_paths;

  const std::vector<std::shared_ptr<const scene::Snapshot>> scenes = core.scenes.list();
  status.total_scenes = static_cast<std::int32_t>(scenes.size());
  std::size_t size = static_cast<std::size_t>(status.getEncodedSize());
  for (const std::shared_ptr<const scene::Snapshot>& snapshot : scenes) {
    scene_info_t info = scene_info_of(*snapshot);
    size += static_cast<std::size_t>(info._getEncodedSizeNoHash());
    if (size > wire::kMaxMessageBytes) break;
    status.scenes.push_back(std::move(info));
  }
  status.num_scenes = static_cast<std::int32_t>(status.scenes.size());
  return status;
}

}  // namespace camway::service
