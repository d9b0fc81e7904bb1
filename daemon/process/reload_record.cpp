// SPDX-License-Identifier: MIT
#include "daemon/process/reload_record.h"

#include "daemon/process/status_text.h"
#include "lcmtypes/wire/layout.h"

namespace camway::process {
void ReloadRecord::failed(std::int64_t utime, std::string_view reason) {
  const std::lock_guard lock(mutex_);
  ++failures_;
  last_utime_ = utime;
  last_reason_ = beginning_of(reason, wire::kMaxReloadFaultBytes);
  has_failed_ = true;
}

void ReloadRecord::succeeded() {
  const std::lock_guard lock(mutex_);
  has_failed_ = false;
}

void ReloadRecord::add_to(status_t& status) const {
  const std::lock_guard lock(mutex_);
  status.failed_reloads = failures_;
  status.failed_reload_utime = last_utime_;
  status.failed_reload = last_reason_;
  status.reload_failed = has_failed_ ? 1 : 0;
}

}  // namespace camway::process
