// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Logs in the format of lcm-logger. Format of an event: the word 0xEDA1DA01, number and time (8
/// bytes each), lengths of channel and data (4 bytes each), all big-endian, then channel and data.
namespace camway::record {

/// A message of a log.
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

using VisitEvent = std::function<void(LogEvent&&)>;
/// Whether the messages of a channel are wanted.
using WantsChannel = std::function<bool(std::string_view channel)>;

/// Reads a log from its beginning and calls `visit` for each event of a channel that is wanted, up
/// to the first damaged event. The messages of other channels are passed over: the memory in use
/// does not depend on the log.
///
/// LCM's own reader is not used, because it trusts the lengths in the file: a damaged one makes it
/// allocate up to 4 GB. This reader checks every length against the remaining bytes.
LogSummary read_event_log(const std::filesystem::path& file, const WantsChannel& wants,
                          const VisitEvent& visit);
/// Visits the events of all channels.
LogSummary read_event_log(const std::filesystem::path& file, const VisitEvent& visit);

/// Appends an event to the bytes of a log.
void append_event(std::int64_t number, std::int64_t utime, std::string_view channel,
                  std::span<const std::uint8_t> data, std::vector<std::uint8_t>& log);

}  // namespace camway::record
