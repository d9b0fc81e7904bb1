// SPDX-License-Identifier: MIT
#include "client/engine/occupancy_collector.h"

#include <utility>

#include "lcmtypes/wire/check.h"

namespace camway {

OccupancyCollector::OccupancyCollector(std::string client_id, std::int64_t request_id)
    : client_id_(std::move(client_id)), request_id_(request_id) {}

OccupancyCollector::Taken OccupancyCollector::take(std::span<const std::uint8_t> bytes) {
  wire::Decoded<occupancy_response_t> decoded = wire::decode<occupancy_response_t>(bytes);
  if (!decoded.message) {
    fault_ = decoded.fault.text("occupancy_response_t");
    return Taken::kBad;
  }
  if (decoded.message->client_id != client_id_ || decoded.message->request_id != request_id_) {
    return Taken::kForeign;
  }
  response_ = std::move(*decoded.message);
  return Taken::kNew;
}

}  // namespace camway
