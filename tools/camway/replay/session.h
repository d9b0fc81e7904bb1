// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/messages/plan.h"
#include "daemon/planning/request/request.h"
#include "daemon/record/event_log.h"
#include "daemon/record/session_events.h"
#include "lcmtypes/wire/auth/message_keys.h"

namespace camway::tools {

/// The answer of the daemon in the log.
struct RecordedAnswer {
  std::string status;  ///< as on the wire: "ok", ..., "overloaded", "malformed"
  /// The whole answer if it is a result of planning: not overloaded or malformed, and with a path
  /// that is one.
  std::optional<plan_response_t> result;
  std::string scene_digest;          ///< digest of the scene of the answer; may be empty
  double received_s = 0.0;           ///< as of the request
  std::uint64_t scene_revision = 0;  ///< revision of that scene; 0 if there is none
  /// Recording in which it stands (`record::FileBegin::recording`); empty for a plain log.
  std::string recording;
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

/// A change of a scene in a recording.
struct RecordedUpdate {
  std::string recording;  ///< as in `RecordedAnswer`
  record::SceneUpdate change;
};

/// The planning requests of a log, in the order in which they first came completely.
struct Session {
  record::LogSummary log;
  std::int64_t begin_utime = 0;  ///< time of the first event that is read, microseconds since 1970
  std::vector<RecordedRequest> requests;
  std::uint64_t malformed = 0;  ///< messages on Camway's channels that cannot be read
  /// Malformed messages with another fingerprint: recorded with other versions of the types.
  std::uint64_t other_version = 0;
  std::uint64_t distrusted = 0;  ///< messages whose signature is missing or wrong
  std::uint64_t incomplete = 0;  ///< requests or answers with a missing page
  std::uint64_t conflicts = 0;   ///< requests left out, since another request has the same id
  std::uint64_t unasked = 0;     ///< answers to requests that are not in the log
  std::uint64_t unwanted = 0;    ///< requests that a selection removed (`select`)

  // The next members are of recordings of a daemon. A plain log has none of this.
  std::vector<record::FileBegin> parts;
  std::vector<RecordedUpdate> updates;      ///< changes of scenes, in their order
  std::vector<record::Omission> omissions;  ///< those with one reason are summed up
  std::uint64_t damaged_events = 0;         ///< events of the session that cannot be read

  /// Changes of scenes that clients asked for, and that the log tells of by messages alone.
  std::uint64_t scene_requests = 0;
  /// The digest of each scene in the first answer that names one, of all requests: a selection
  /// (`select`) does not change the scenes with which a log begins.
  std::map<std::string, std::string> first_digests;

  /// Sentences of `camway pack` about what it left out, if the session was packed.
  std::vector<std::string> left_out;

  [[nodiscard]] bool is_damaged() const { return !log.damage.empty() || damaged_events > 0; }
};

/// Reads the planning messages of `log` on channels with `prefix` and joins their pages. If a
/// request has several answers, the first that is a result of planning counts. With `keys`, only
/// messages that are signed with one of them count; without, signatures are ignored.
/// Other channels are passed over, so they cost no memory and little time.
Session read_session(const std::filesystem::path& log, const std::string& prefix,
                     const wire::MessageKeys* keys = nullptr);
/// Reads the logs one after the other, as if they were one.
Session read_session(const std::vector<std::filesystem::path>& logs, const std::string& prefix,
                     const wire::MessageKeys* keys = nullptr);

}  // namespace camway::tools
