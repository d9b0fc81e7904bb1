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

/// Puts states of a client's paths into reports, as many to a message as fit. For the loop thread.
class WatchReports {
 public:
  /// Of so many intervals of a path, the last reaches to the end of all that follow.
  static constexpr std::size_t kMostIntervals = 32;

  /// `request_id`: of the message that is answered, 0 for none.
  WatchReports(Core& core, std::string client_id, std::int64_t request_id);

  void add(const path_state_t& state,
           const std::vector<collision::CollisionInterval>& collisions = {});
  /// Why a path is refused.
  void explain(std::string_view message);
  /// Sends what is left. An answer is sent even if there is nothing in it.
  void finish();

 private:
  void send();

  Core& core_;
  watch_report_t report_;
  bool is_owed_;
};

}  // namespace camway::service
