// SPDX-License-Identifier: MIT
#include "daemon/service/log/limited_log.h"

#include <utility>

namespace camway::service {

void LimitedLog::write(std::string_view event, LogFields facts, Clock::time_point now) {
  if (!log_->writes(level_)) return;
  tell_left_out(now);
  if (!bucket_.take(now)) {
    ++left_out_;
    return;
  }
  log_->write(level_, event, facts);
}

void LimitedLog::tell_left_out(Clock::time_point now) {
  if (left_out_ == 0 || now < tell_at_ || !bucket_.take(now)) return;
  tell_at_ = now + kTellEvery;
  const std::int64_t lines = std::exchange(left_out_, 0);
  log_->write(level_, "lines left out", {{"kind", kind_}, {"lines", lines}});
}

LimitedLogs::LimitedLogs(const std::shared_ptr<Log>& log, const LimitedLog::Limits& limits)
    : answers(log, LogLevel::kInfo, "answers", limits),
      occupancy(log, LogLevel::kInfo, "occupancy", limits),
      scenes(log, LogLevel::kInfo, "scenes", limits),
      watches(log, LogLevel::kInfo, "watches", limits),
      malformed(log, LogLevel::kWarn, "malformed", limits),
      refused(log, LogLevel::kWarn, "refused", limits),
      trouble(log, LogLevel::kWarn, "trouble", limits) {}

void LimitedLogs::tell_left_out(LimitedLog::Clock::time_point now) {
  for (LimitedLog* const kind :
       {&answers, &occupancy, &scenes, &watches, &malformed, &refused, &trouble}) {
    kind->tell_left_out(now);
  }
}

}  // namespace camway::service
