// SPDX-License-Identifier: MIT
#include "daemon/service/plans/in_flight.h"

#include <algorithm>

#include "daemon/messages/progress.h"
#include "daemon/service/core/core.h"

namespace camway::service {
namespace {

/// A longer period is as good as none, and would overflow the clock.
constexpr double kLongestPeriod_s = 1e6;

}  // namespace

base::Deadline InFlight::begin(const RequestKey& key, double deadline_s, double progress_period_s) {
  const std::stop_source stop;
  auto progress = std::make_shared<base::Progress>();
  Flight flight{base::Deadline::after_s(deadline_s).watched(stop.get_token(), progress),
                deadline_s,
                stop,
                progress,
                {},
                {}};
  if (progress_period_s > 0.0) {
    flight.period = std::max<Clock::duration>(
        kLeastPeriod, std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                          std::min(progress_period_s, kLongestPeriod_s))));
    flight.due = Clock::now() + flight.period;
    due_.emplace(*flight.due, key);
  }
  return flights_.insert_or_assign(key, std::move(flight)).first->second.deadline;
}

bool InFlight::cancel(const RequestKey& key) {
  const auto position = flights_.find(key);
  if (position == flights_.end()) return false;
  position->second.stop.request_stop();
  return true;
}

bool InFlight::cancelled(const RequestKey& key) const {
  const auto position = flights_.find(key);
  return position != flights_.end() && position->second.stop.stop_requested();
}

void InFlight::end(const RequestKey& key) {
  const auto position = flights_.find(key);
  if (position == flights_.end()) return;
  if (position->second.due) due_.erase({*position->second.due, key});
  flights_.erase(position);
}

std::vector<plan_progress_t> InFlight::take_due(Clock::time_point now) {
  std::vector<plan_progress_t> messages;
  while (next_due() <= now) {
    const RequestKey key = due_.begin()->second;
    due_.erase(due_.begin());
    Flight& flight = flights_.at(key);
    messages.push_back(progress_of(key, flight));
    flight.due = now + flight.period;
    due_.emplace(*flight.due, key);
  }
  return messages;
}

InFlight::Clock::time_point InFlight::next_due() const {
  return due_.empty() ? Clock::time_point::max() : due_.begin()->first;
}

plan_progress_t InFlight::progress_of(const RequestKey& key, const Flight& flight) {
  plan_progress_t message{};
  message.client_id = key.client_id;
  message.request_id = key.request_id;
  message.utime = utime_now();
  message.stage = messages::wire_stage(flight.progress->stage);
  message.num_collisions = flight.progress->collisions;
  message.num_corrected = flight.progress->corrected;
  message.since_receipt_s = 1e-3 * flight.deadline.elapsed_ms();
  message.deadline_s = flight.deadline_s;
  return message;
}

}  // namespace camway::service
