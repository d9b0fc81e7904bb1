// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/messages/plan.h"
#include "daemon/planning/request/request.h"
#include "lcmtypes/wire/auth/message_keys.h"
#include "tools/camway/replay/event_log.h"

namespace camway::tools {

/// The answer of the daemon in the log.
struct RecordedAnswer {
  std::string status;  ///< as on the wire: "ok", ..., "overloaded", "malformed"
  /// The whole answer if it is a result of planning: not overloaded or malformed, and with a path
  /// that is one.
  std::optional<plan_response_t> result;
  std::string scene_digest;  ///< digest of the scene of the answer; may be empty
};

/// A request of a log with its answer. Repetitions under one id are one request.
struct RecordedRequest {
  messages::RequestIds ids;
  std::string scene;
  /// Unset if the request has something that this version does not know, which `error` names.
  std::optional<planning::PlanRequest> request;
  std::string error;
  std::optional<RecordedAnswer> answer;
  std::size_t sent = 0;  ///< number of times that it came completely
  /// Time at which it first came completely, from the first event of the log. The times of a log
  /// are not trusted: it may be any number. [Units: seconds]
  double received_s = 0.0;
  /// Digest of the request without its ids and its time of sending.
  std::string content_digest;
};

/// The planning requests of a log, in the order in which they first came completely.
struct Session {
  LogSummary log;
  std::int64_t begin_utime = 0;  ///< time of the first event, microseconds since 1970
  std::vector<RecordedRequest> requests;
  std::uint64_t malformed = 0;  ///< messages on Camway's channels that cannot be read
  /// Malformed messages with another fingerprint: recorded with other versions of the types.
  std::uint64_t other_version = 0;
  std::uint64_t distrusted = 0;  ///< messages whose signature is missing or wrong
  std::uint64_t incomplete = 0;  ///< requests or answers with a missing page
  std::uint64_t conflicts = 0;   ///< requests left out, since another request has the same id
  std::uint64_t unasked = 0;     ///< answers to requests that are not in the log
  std::uint64_t unwanted = 0;    ///< requests that a selection removed (`select`)
};

/// Reads the planning messages of `log` on channels with `prefix` and joins their pages. If a
/// request has several answers, the first that is a result of planning counts. With `keys`, only
/// messages that are signed with one of them count; without, signatures are ignored.
Session read_session(const std::filesystem::path& log, const std::string& prefix,
                     const wire::MessageKeys* keys = nullptr);

}  // namespace camway::tools
