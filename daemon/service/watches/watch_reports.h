// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <camway/watch_report_t.hpp>

#include "daemon/collision/interval.h"
#include "daemon/service/core/core.h"

namespace camway::service {

/// Reports states of a client's paths, as many to a message as fit.
/// Not thread-safe: for the loop thread.
class WatchReports {
 public:
  /// Largest number of intervals of a path. The last one extends to the end of all that follow.
  static constexpr std::size_t kMostIntervals = 32;

  /// `request_id`: id of the message that is answered; 0 for none.
  WatchReports(Core& core, std::string client_id, std::int64_t request_id);

  void add(const path_state_t& state,
           const std::vector<collision::CollisionInterval>& collisions = {});
  /// Adds the reason why a path is refused.
  void explain(std::string_view message);
  /// Sends the rest. An answer is sent even if it is empty.
  void finish();

 private:
  void send();

  Core& core_;
  watch_report_t report_;
  bool is_owed_;
};

}  // namespace camway::service
