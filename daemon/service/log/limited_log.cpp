// SPDX-License-Identifier: MIT
#include "daemon/service/log/limited_log.h"

#include <utility>

namespace camway::service {

bool LimitedLog::write(std::string_view event, LogFields fields, Clock::time_point now) {
  if (!log_->writes(level_)) return false;
  report_suppressed(now);
  if (!bucket_.take(now)) {
    ++suppressed_;
    return false;
  }
  log_->write(level_, event, fields);
  return true;
}

void LimitedLog::report_suppressed(Clock::time_point now) {
  if (suppressed_ == 0 || now < report_at_ || !bucket_.take(now)) return;
  report_at_ = now + kReportPeriod;
  const std::int64_t lines = std::exchange(suppressed_, 0);
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

void LimitedLogs::report_suppressed(LimitedLog::Clock::time_point now) {
  for (LimitedLog* const kind :
       {&answers, &occupancy, &scenes, &watches, &malformed, &refused, &trouble}) {
    kind->report_suppressed(now);
  }
}

}  // namespace camway::service
