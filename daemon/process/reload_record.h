// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include <camway/status_t.hpp>

namespace camway::process {

/// Outcome of the reloads of the configuration, for the status.
/// Thread-safe.
class ReloadRecord {
 public:
  /// Records a failed reload. `utime`: microseconds since 1970. Keeps the beginning of a long
  /// reason.
  void failed(std::int64_t utime, std::string_view reason);
  /// Records a reload that was done, so that the daemon runs with its configuration.
  void succeeded();

  /// Writes the members of `status` about reloads.
  void add_to(status_t& status) const;

 private:
  mutable std::mutex mutex_;  ///< guards all below
  std::int64_t failures_ = 0;
  std::int64_t last_utime_ = 0;  ///< time of the last failure
  std::string last_reason_;
  bool has_failed_ = false;  ///< whether the last reload failed
};

}  // namespace camway::process
