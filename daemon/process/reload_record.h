// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include <camway/status_t.hpp>

namespace camway::service {

/// What became of reloads of the configuration, for those who ask how the daemon is. From any
/// thread.
class ReloadRecord {
 public:
  /// A reload failed at `utime`, microseconds since 1970. Of a long reason the beginning is kept.
  void failed(std::int64_t utime, std::string_view reason);
  /// A reload was done: what serves is what the configuration says.
  void succeeded();

  /// Writes the fields of reloads.
  void add_to(status_t& status) const;

 private:
  mutable std::mutex mutex_;  ///< guards all below
  std::int64_t failures_ = 0;
  std::int64_t last_utime_ = 0;  ///< of the last failure
  std::string last_reason_;
  bool has_failed_ = false;  ///< the last reload
};

}  // namespace camway::service
