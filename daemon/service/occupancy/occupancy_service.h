// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <span>
#include <stop_token>
#include <string_view>

#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/messages/deadline_limits.h"
#include "daemon/service/core/core.h"
#include "daemon/service/transport/answer_pages.h"

namespace camway::service {

/// Answers batches of occupancy queries. Workers query the mirror; everything else runs on the loop
/// thread. The deadline of a batch counts from its receipt. A batch that is sent again while it
/// waits or is being answered is ignored. One that is sent again later is answered again: answers
/// are not cached, because the mirror of a revision never changes and a query costs little. Not
/// thread-safe: for the loop thread.
class OccupancyService {
 public:
  /// Requires that `core` outlives the service. `deadline`: limits of the deadlines of batches.
  OccupancyService(Core& core, const messages::DeadlineLimits& deadline)
      : core_(core), deadline_(deadline) {}

  /// Handles a message on the occupancy request channel. Throws only if memory runs out.
  void on_message(std::span<const std::uint8_t> message);
  /// Handles a message on the channel that cancels batches. Throws only if memory runs out.
  void on_cancel(std::span<const std::uint8_t> message);

 private:
  using Request = std::shared_ptr<const occupancy_request_t>;
  /// A batch that waits or is being answered.
  struct Flight {
    Request request;
    std::stop_source stop;
  };

  void refuse_malformed(const wire::Sender& sender, std::string_view reason);
  /// `refuse_malformed`, for `Core::read`.
  auto refusing() {
    return [this](const wire::Sender& sender, std::string_view reason) {
      refuse_malformed(sender, reason);
    };
  }
  void on_request(const Request& request);
  void begin(const Request& request, std::shared_ptr<const scene::Snapshot> snapshot);
  void abandon(const Request& request, Refusal why);
  /// Sends the answer to a batch, unless the batch was cancelled.
  void finish(const Request& request, occupancy_response_t answer);
  void send(occupancy_response_t answer);

  Core& core_;
  const messages::DeadlineLimits deadline_;
  std::map<RequestKey, Flight> flights_;
};

}  // namespace camway::service
