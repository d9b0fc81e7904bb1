// SPDX-License-Identifier: MIT
#pragma once

#include <camway/occupancy.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>

namespace camway {

/// Returns the fault of a batch that cannot be sent, or nothing.
std::optional<std::string> fault_in_form(const OccupancyBatch& batch);

/// Returns the requests of a batch, in its order, each of at most `wire::kMaxMessageBytes`. The
/// caller sets the request ids. An empty batch makes one request, whose answer says whether there
/// is a map. Requires a batch without `fault_in_form`.
std::vector<occupancy_request_t> to_requests(const OccupancyBatch& batch,
                                             const std::string& client_id);

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

/// Appends the answers of `response` to `answer`. Returns the fault of a response that does not
/// answer `request`, or nothing.
std::optional<std::string> append(const occupancy_request_t& request,
                                  const occupancy_response_t& response, OccupancyAnswer& answer);

}  // namespace camway
