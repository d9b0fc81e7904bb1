// SPDX-License-Identifier: MIT
#include "daemon/record/trouble_log.h"

namespace camway::record {

void TroubleLog::failed(std::string_view reason, Clock::time_point now) {
  failed_at_ = now;
  set_reason(reason.empty() ? "unknown" : reason);
  ++failures_;
  if (!is_trouble_) {
    is_trouble_ = true;
    log_->warn("not all is recorded", {{"reason", reason}});
  } else if (now - told_at_ >= times_.reminder) {
    log_->warn("still not all is recorded", {{"reason", reason},
                                             {"failures", failures_},
                                             {"messages", messages_},
                                             {"changes", changes_}});
  } else {
    return;
  }
  told_at_ = now;
}

void TroubleLog::lost(std::uint64_t messages, std::uint64_t changes) {
  messages_ += messages;
  changes_ += changes;
}

void TroubleLog::succeeded(Clock::time_point now) {
  if (!is_trouble_ || now - failed_at_ < times_.calm) return;
  log_->info("the recording goes on",
             {{"failures", failures_}, {"messages", messages_}, {"changes", changes_}});
  is_trouble_ = false;
  set_reason("");
  failures_ = messages_ = changes_ = 0;
}

void TroubleLog::finish() {
  if (!is_trouble_) return;
  log_->warn("not all was recorded",
             {{"failures", failures_}, {"messages", messages_}, {"changes", changes_}});
  is_trouble_ = false;
}

void TroubleLog::set_reason(std::string_view reason) {
  const std::lock_guard lock(mutex_);
  reason_ = reason;
}

}  // namespace camway::record
