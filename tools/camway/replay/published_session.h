// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/record/event_log.h"
#include "lcmtypes/wire/auth/message_keys.h"

namespace camway::tools {

/// Clients and ids of planning requests.
using RequestKeys = std::set<std::pair<std::string, std::int64_t>>;

/// The file of an upload: its client, size and checksum.
using UploadKey = std::tuple<std::string, std::int64_t, std::int64_t>;

/// The messages of a session that are sent to a daemon again, out of their envelopes.
struct PublishedSession {
  std::vector<record::LogEvent> events;  ///< in the order of the log
  /// Pages of uploads by their number, as indices of `events`.
  std::map<UploadKey, std::map<std::int32_t, std::size_t>> uploads;
  std::uint64_t distrusted = 0;  ///< messages left out: their signature is missing or not good
  /// Changes of scenes that the session tells of, and that no message of `events` asks for.
  std::size_t unsent_changes = 0;
  std::string damage;  ///< why the session could not be read to its end; else empty
};

/// Reads what is sent of a session on channels with `prefix`: requests for planning and for
/// occupancy, and changes of scenes that were made, or whose answer is not in the log, with their
/// uploads. With `wanted`, those planning requests alone. `keys` may be null (`open_event`).
PublishedSession read_published(const std::filesystem::path& log, const std::string& prefix,
                                const std::optional<RequestKeys>& wanted,
                                const wire::MessageKeys* keys);

}  // namespace camway::tools
