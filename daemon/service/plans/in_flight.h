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
#include "daemon/service/transport/answer_pages.h"

namespace camway::service {

/// The plan requests that wait or are being planned, with what is needed to cancel them and to
/// report their progress.
/// Not thread-safe.
class InFlight {
 public:
  using Clock = std::chrono::steady_clock;

  /// Shortest period of progress reports.
  static constexpr std::chrono::milliseconds kLeastPeriod{100};

  /// Adds a request. Returns its deadline, `deadline_s` from now. `cancel` makes the deadline
  /// strike at once. Planning reports its progress to the deadline. `progress_period_s` is the
  /// period of progress reports; none if it is not above 0.
  base::Deadline begin(const RequestKey& key, double deadline_s, double progress_period_s);

  /// Tells planning to stop. Returns false if no such request is in flight.
  bool cancel(const RequestKey& key);
  [[nodiscard]] bool cancelled(const RequestKey& key) const;

  void end(const RequestKey& key);

  /// Returns the progress reports that are due by `now`, complete except for `requests_ahead`.
  std::vector<plan_progress_t> take_due(Clock::time_point now);
  /// Returns the time of the next report; the end of time if none is wanted.
  [[nodiscard]] Clock::time_point next_due() const;

 private:
  struct Flight {
    base::Deadline deadline;
    double deadline_s;
    std::stop_source stop;
    std::shared_ptr<base::Progress> progress;
    Clock::duration period;
    std::optional<Clock::time_point> due;
  };

  [[nodiscard]] static plan_progress_t progress_of(const RequestKey& key, const Flight& flight);

  std::map<RequestKey, Flight> flights_;
  std::set<std::pair<Clock::time_point, RequestKey>> due_;
};

}  // namespace camway::service
