// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include <camway/plan_progress_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/messages/answer_pages.h"

namespace camway::service {

/// The plan requests that wait or are being planned: who may call them off, and who wants to hear
/// how far they are. For one thread at a time.
class InFlight {
 public:
  using Clock = std::chrono::steady_clock;

  /// More often than this nobody is told.
  static constexpr std::chrono::milliseconds kLeastPeriod{100};

  /// From now on the request is in flight. Its deadline, `deadline_s` from now, hears of `cancel`
  /// and hands on how far planning is. `progress_period_s` is how often to say so; not above 0:
  /// never.
  collision::Deadline begin(const RequestKey& key, double deadline_s, double progress_period_s);

  /// Tells planning to stop; false if no such request is in flight.
  bool cancel(const RequestKey& key);
  [[nodiscard]] bool cancelled(const RequestKey& key) const;

  void end(const RequestKey& key);

  /// How far those are who want to be told by now, all but `requests_ahead`.
  std::vector<plan_progress_t> take_due(Clock::time_point now);
  /// When `take_due` has something next; the end of time if nobody wants to be told.
  [[nodiscard]] Clock::time_point next_due() const;

 private:
  struct Flight {
    collision::Deadline deadline;
    double deadline_s;
    std::stop_source stop;
    std::shared_ptr<collision::Progress> progress;
    Clock::duration period;
    std::optional<Clock::time_point> due;
  };

  [[nodiscard]] static plan_progress_t progress_of(const RequestKey& key, const Flight& flight);

  std::map<RequestKey, Flight> flights_;
  std::set<std::pair<Clock::time_point, RequestKey>> due_;
};

}  // namespace camway::service
