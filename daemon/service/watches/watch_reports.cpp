// SPDX-License-Identifier: MIT
#include "daemon/service/watches/watch_reports.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "daemon/messages/text.h"
#include "lcmtypes/wire/check.h"

namespace camway::service {
namespace {

std::vector<broken_interval_t> intervals_of(
    std::int64_t request_id, const std::vector<collision::CollisionInterval>& collisions) {
  std::vector<broken_interval_t> intervals(
      std::min(collisions.size(), WatchReports::kMostIntervals));
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    intervals[i].request_id = request_id;
    intervals[i].t_begin_s = collisions[i].t_begin_s;
    intervals[i].t_end_s = collisions[i].t_end_s;
  }
  if (!intervals.empty()) intervals.back().t_end_s = collisions.back().t_end_s;
  return intervals;
}

}  // namespace

WatchReports::WatchReports(Core& core, std::string client_id, std::int64_t request_id)
    : core_(core), report_{}, is_owed_(request_id != 0) {
  report_.client_id = std::move(client_id);
  report_.request_id = request_id;
}

void WatchReports::add(const path_state_t& state,
                       const std::vector<collision::CollisionInterval>& collisions) {
  const std::vector<broken_interval_t> more = intervals_of(state.request_id, collisions);
  const std::size_t size = static_cast<std::size_t>(report_.getEncodedSize()) +
                           static_cast<std::size_t>(state._getEncodedSizeNoHash()) +
                           more.size() * sizeof(broken_interval_t) + wire::kMaxTextBytes;
  if (size > wire::kMaxMessageBytes) send();
  report_.paths.push_back(state);
  report_.num_paths = static_cast<std::int32_t>(report_.paths.size());
  report_.intervals.insert(report_.intervals.end(), more.begin(), more.end());
  report_.num_intervals = static_cast<std::int32_t>(report_.intervals.size());
}

void WatchReports::explain(std::string_view message) {
  report_.message = messages::clipped(message, wire::kMaxTextBytes);
}

void WatchReports::finish() {
  if (is_owed_ || report_.num_paths > 0) send();
}

void WatchReports::send() {
  report_.utime = utime_now();
  report_.daemon_start = core_.start;
  core_.outbox.add(core_.channels.watch_report(report_.client_id), one_page(wire::encode(report_)));
  report_.message.clear();
  report_.paths.clear();
  report_.num_paths = 0;
  report_.intervals.clear();
  report_.num_intervals = 0;
  is_owed_ = false;
}

}  // namespace camway::service
