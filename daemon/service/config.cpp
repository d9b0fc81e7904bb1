// SPDX-License-Identifier: MIT
#include "daemon/service/config.h"

#include <utility>

#include "lcmtypes/channels.h"

namespace camway::service {

std::string ServiceConfig::fault() const {
  if (!wire::is_prefix(prefix)) {
    return "prefix '" + prefix + "' is not of 1 to " + std::to_string(wire::kMaxPrefixLength) +
           " letters, digits, '_' and '-'";
  }
  if (workers < 1 || workers > kMaxWorkers) {
    return "workers: " + std::to_string(workers) + " is not within 1 to " +
           std::to_string(kMaxWorkers);
  }
  if (scene_workers < 1 || scene_workers > kMaxWorkers) {
    return "scene workers: " + std::to_string(scene_workers) + " is not within 1 to " +
           std::to_string(kMaxWorkers);
  }
  for (const auto& [name, value] :
       {std::pair{"queue", queue.jobs}, std::pair{"client queue", queue.jobs_of_a_client}}) {
    if (value < 1 || value > kMaxQueueCapacity) {
      return std::string(name) + ": " + std::to_string(value) + " is not within 1 to " +
             std::to_string(kMaxQueueCapacity);
    }
  }
  if (!(deadline.default_s > 0.0) || !(deadline.default_s <= deadline.max_s)) {
    return "deadline: the default must be above 0 and at most the maximum";
  }
  if (subscription_capacity < 1) return "subscription capacity: must be at least 1";
  if (heartbeat_period.count() < 1) return "heartbeat period: must be at least 1 ms";
  if (drain_limit.count() < 0) return "drain limit: must not be negative";
  return {};
}

}  // namespace camway::service
