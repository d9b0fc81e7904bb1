// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/messages/convert.h"
#include "daemon/planning/request.h"
#include "daemon/planning/result.h"
#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/replay/event_log.h"

namespace camway::tools {

/// What the daemon answered when the log was recorded.
struct RecordedAnswer {
  std::string status;  ///< as on the wire: "ok", ..., "overloaded", "malformed"
  /// Nothing for an answer that is no result of planning: overloaded, malformed, or unreadable.
  std::optional<planning::PlanResult> result;
  std::string scene_digest;  ///< what it was computed on; may be empty
};

/// A request of a log with its answer. Sent repeatedly under one id it stands here once.
struct RecordedRequest {
  service::RequestIds ids;
  std::string scene;
  /// Nothing if it asks for what this version does not know; then `error` says what.
  std::optional<planning::PlanRequest> request;
  std::string error;
  std::optional<RecordedAnswer> answer;
  std::size_t sent = 0;  ///< how often it came whole
};

/// The planning of a log, requests in the order in which they first came whole.
struct Session {
  LogSummary log;
  std::vector<RecordedRequest> requests;
  std::uint64_t malformed = 0;  ///< messages on our channels that are not of our types
  /// Of these, messages with another fingerprint: recorded with another version of the wire types.
  std::uint64_t other_version = 0;
  std::uint64_t distrusted = 0;  ///< messages whose signature is missing or not good
  std::uint64_t incomplete = 0;  ///< messages of which a page is missing
  std::uint64_t conflicts = 0;  ///< requests whose id was used before for another request; left out
  std::uint64_t unasked = 0;    ///< answers to requests that are not in the log
};

/// Reads what `log` holds of planning on channels with `prefix`, putting pages together. Of several
/// answers to one request the first that is a result of planning counts. With `keys` only messages
/// that were signed with one of them count; without, all do, and signatures are not looked at.
Session read_session(const std::filesystem::path& log, const std::string& prefix,
                     const wire::MessageKeys* keys = nullptr);

}  // namespace camway::tools
