// SPDX-License-Identifier: MIT
#include "daemon/service/warnings.h"

namespace camway::service {

void Warnings::warn(std::string_view text, Clock::time_point now) {
  ++total_;
  if (total_ > 1 && now < next_line_) {
    ++left_out_;
    return;
  }
  if (left_out_ > 0) {
    log_->warn("{} ({} more like this since the last line)", text, left_out_);
  } else {
    log_->warn("{}", text);
  }
  left_out_ = 0;
  next_line_ = now + period_;
}

}  // namespace camway::service
