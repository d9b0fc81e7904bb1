// SPDX-License-Identifier: MIT
#include "tools/camway/session/report/session_mcap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "daemon/messages/plan.h"
#include "tools/cameras/files/mcap_file.h"
#include "tools/cameras/formats/foxglove.h"
#include "tools/cameras/path_samples.h"
#include "tools/camway/session/report/answer_columns.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using foxglove::Json;

constexpr double kPosesPerSecond = 24.0;
/// Later times do not fit into 63 bits of nanoseconds.
constexpr double kLatestTime_s = 9.2e9;

enum SessionChannel : std::size_t { kRequested, kPath, kKeyframes, kLog, kAnswers };

/// A message, before all are sorted by time.
struct TimedMessage {
  std::uint64_t time_ns = 0;
  std::size_t channel = 0;
  std::string json;
};

Json answers_schema() {
  Json members;
  for (const std::string_view name : answer_column_names())
    members[std::string(name)] = Json::object();
  return foxglove::schema_of("camway.Answer", "A request and its answer", members);
}

std::vector<McapChannel> session_channels() {
  const std::string poses = foxglove::poses_schema().dump();
  return {{"/camway/requested", "foxglove.PosesInFrame", poses, {}},
          {"/camway/path", "foxglove.PosesInFrame", poses, {}},
          {"/camway/keyframes", "foxglove.PosesInFrame", poses, {}},
          {"/camway/log", "foxglove.Log", foxglove::log_schema().dump(), {}},
          {"/camway/answers", "camway.Answer", answers_schema().dump(), {}}};
}

/// The times of a log may be any numbers.
std::uint64_t time_ns(const Session& session, double since_begin_s) {
  const double begin_s = static_cast<double>(session.begin_utime) * 1e-6;
  const bool is_date = begin_s >= 0.0 && begin_s + since_begin_s < kLatestTime_s;
  const bool is_time = since_begin_s >= 0.0 && since_begin_s < kLatestTime_s;
  const std::uint64_t begin_ns =
      is_date ? static_cast<std::uint64_t>(session.begin_utime) * 1000 : 0;
  return begin_ns + (is_time ? static_cast<std::uint64_t>(std::llround(since_begin_s * 1e9)) : 0);
}

std::vector<motion::Pose> poses_along(const motion::Path& path) {
  const double frames = frame_count(path, kPosesPerSecond);
  const double rate = frames <= kMostSessionPoses
                          ? kPosesPerSecond
                          : kPosesPerSecond * (kMostSessionPoses - 1) / frames;
  std::vector<motion::Pose> poses;
  for (const TrackKey& key : frames_of(path, rate).keys) poses.push_back(key.pose_W);
  return poses;
}

std::vector<motion::Pose> poses_of(const std::vector<keyframe_t>& keyframes) {
  std::vector<motion::Pose> poses;
  for (const keyframe_t& keyframe : keyframes) {
    const double* const q = keyframe.orientation_wxyz;
    poses.push_back({{keyframe.position_m[0], keyframe.position_m[1], keyframe.position_m[2]},
                     geometry::Quat(q[0], q[1], q[2], q[3])});
  }
  return poses;
}

foxglove::LogLevel level_of(const RecordedAnswer& answer) {
  if (answer.status == "ok") return foxglove::LogLevel::kInfo;
  const bool is_warning = answer.status == "partial" || answer.status == "timeout" ||
                          answer.status == "cancelled" || answer.status == "infeasible";
  return is_warning ? foxglove::LogLevel::kWarning : foxglove::LogLevel::kError;
}

std::string columns_message(const RecordedRequest& request, std::uint64_t at_ns) {
  Json json{{"timestamp", foxglove::timestamp(at_ns)}};
  for (AnswerColumn& column : answer_columns(request)) {
    json[std::string(column.name)] = std::move(column.value);
  }
  return json_text(json);
}

void add_answer(const RecordedRequest& request, std::uint64_t at_ns,
                std::vector<TimedMessage>& messages) {
  const RecordedAnswer& answer = *request.answer;
  messages.push_back({at_ns, kAnswers, columns_message(request, at_ns)});
  const std::string sentence = answer.result ? answer.result->message : "";
  messages.push_back({at_ns, kLog,
                      foxglove::log_message(level_of(answer),
                                            fmt::format("{} {}: {}{}{}", request.ids.client_id,
                                                        request.ids.request_id, answer.status,
                                                        sentence.empty() ? "" : ": ", sentence),
                                            request.scene, at_ns)});
  if (!answer.result || answer.result->segments.empty()) return;
  const auto path = messages::path_of(answer.result->segments);
  if (!path) return;
  messages.push_back({at_ns, kPath, foxglove::poses_message(poses_along(*path), at_ns)});
  messages.push_back(
      {at_ns, kKeyframes, foxglove::poses_message(poses_of(answer.result->keyframes), at_ns)});
}

}  // namespace

std::string session_mcap(const Session& session) {
  std::vector<TimedMessage> messages;
  for (const RecordedRequest& request : session.requests) {
    if (request.request) {
      const std::uint64_t at_ns = time_ns(session, request.received_s);
      std::vector<motion::Pose> poses;
      for (const auto& keyframe : request.request->keyframes) poses.push_back(keyframe.pose);
      messages.push_back({at_ns, kRequested, foxglove::poses_message(poses, at_ns)});
    }
    if (request.answer) {
      add_answer(request, time_ns(session, request.answer->received_s), messages);
    }
  }
  std::ranges::stable_sort(messages, {}, &TimedMessage::time_ns);
  McapFile file(session_channels());
  for (const TimedMessage& message : messages) {
    file.add(message.channel, message.time_ns, message.json);
  }
  return file.finish();
}

}  // namespace camway::tools
