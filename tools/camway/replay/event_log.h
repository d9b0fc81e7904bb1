// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace camway::tools {

/// One message of a log that lcm-logger recorded.
struct LogEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;  ///< when it came, microseconds since 1970
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// How far a log could be read.
struct LogSummary {
  std::uint64_t events = 0;      ///< good ones, all before the damage if there is any
  std::uint64_t bytes_used = 0;  ///< of the file, up to the end of the last good event
  std::uint64_t bytes = 0;       ///< size of the file
  /// Empty for a log that is good to its end. Names the file, and the event and offset where
  /// reading stopped.
  std::string damage;
};

/// Largest message that a log may hold: LCM cannot send a larger one.
inline constexpr std::uint64_t kMaxLogDataBytes = std::uint64_t{1} << 28;

/// Reads the log `file` from its beginning and calls `visit` for each event, up to the first that
/// is cut off or not one. Written here since LCM's own reader trusts the lengths in the file: a
/// damaged one makes it allocate up to 4 GB. Here every length is checked against the bytes that
/// are left. A log: per event the word 0xEDA1DA01, number and time (8 bytes each), length of
/// channel and data (4 bytes each), all big-endian, then channel and data.
LogSummary read_event_log(const std::filesystem::path& file,
                          const std::function<void(LogEvent&&)>& visit);

}  // namespace camway::tools
