// SPDX-License-Identifier: MIT
#pragma once

#include <camway/occupancy.h>

#include <optional>
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

/// Appends the answers of `response` to `answer`. Returns the fault of a response that does not
/// answer `request`, or nothing.
std::optional<std::string> append(const occupancy_request_t& request,
                                  const occupancy_response_t& response, OccupancyAnswer& answer);

}  // namespace camway
