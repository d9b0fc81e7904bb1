// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace camway::tools {

/// A message of a log that lcm-logger recorded.
struct LogEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;  ///< time of receipt, microseconds since 1970
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// The part of a log that could be read.
struct LogSummary {
  std::uint64_t events = 0;      ///< number of valid events before any damage
  std::uint64_t bytes_used = 0;  ///< bytes of the file up to the end of the last valid event
  std::uint64_t bytes = 0;       ///< size of the file
  /// Damage of the log: names the file, the event and the offset at which reading stopped. Empty
  /// for a log without damage.
  std::string damage;
};

/// Largest message in a log. LCM cannot send a larger one.
inline constexpr std::uint64_t kMaxLogDataBytes = std::uint64_t{1} << 28;

/// Reads a log from its beginning and calls `visit` for each event, up to the first damaged one.
///
/// Format of an event: the word 0xEDA1DA01, number and time (8 bytes each), lengths of channel and
/// data (4 bytes each), all big-endian, then channel and data. LCM's own reader is not used,
/// because it trusts the lengths in the file: a damaged one makes it allocate up to 4 GB. This
/// reader checks every length against the remaining bytes.
LogSummary read_event_log(const std::filesystem::path& file,
                          const std::function<void(LogEvent&&)>& visit);

}  // namespace camway::tools
