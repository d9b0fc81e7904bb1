// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <camway/occupancy_response_t.hpp>

namespace camway {

/// Collects the answer to one request. Not thread-safe.
class OccupancyCollector {
 public:
  OccupancyCollector(std::string client_id, std::int64_t request_id);

  enum class Taken { kNew, kForeign, kBad };
  Taken take(std::span<const std::uint8_t> bytes);

  const std::optional<occupancy_response_t>& response() const { return response_; }
  const std::string& fault() const { return fault_; }
  void clear() { response_.reset(); }

 private:
  std::string client_id_;
  std::int64_t request_id_;
  std::optional<occupancy_response_t> response_;
  std::string fault_;
};

}  // namespace camway
