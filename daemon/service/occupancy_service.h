// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>

#include "daemon/service/core.h"

namespace camway::service {

/// Answers batches of occupancy queries. The loop thread calls it; workers ask the map. Nothing is
/// cached: the map never changes under a revision and asking it again costs little, so a repeated
/// request gets the same lists.
class OccupancyService {
 public:
  explicit OccupancyService(Core& core) : core_(core) {}

  /// A message on the occupancy request channel. Throws only for want of memory.
  void on_message(std::span<const std::uint8_t> message);

 private:
  void on_malformed(std::span<const std::uint8_t> message, std::string_view reason);
  void on_request(const std::shared_ptr<const occupancy_request_t>& request);
  void refuse(const occupancy_request_t& request, Refusal why);
  void send(occupancy_response_t answer);

  Core& core_;
};

}  // namespace camway::service
