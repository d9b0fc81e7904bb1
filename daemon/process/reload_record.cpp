// SPDX-License-Identifier: MIT
#include "daemon/process/reload_record.h"

#include "lcmtypes/wire/layout.h"

namespace camway::process {
namespace {

/// Returns the beginning of UTF-8 `text`, cut between characters.
std::string beginning_of(std::string_view text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return std::string(text);
  std::size_t size = most_bytes;
  const auto is_within_character = [&] {
    return (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U;
  };
  while (size > 0 && is_within_character()) --size;
  return std::string(text.substr(0, size));
}

}  // namespace

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
