// SPDX-License-Identifier: MIT
#include "tools/camway/session/report/session_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "lcmtypes/wire/channels.h"
#include "tools/camway/session/report/answer_columns.h"

namespace camway::tools {
namespace {

/// A text as a field of a table: in quotes where it could end the field.
std::string field(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

using Counts = std::map<std::string, std::size_t>;

/// Most names in a line.
constexpr std::size_t kMostNames = 12;

/// Returns the counts by their names. Of those that are too many for a line, the largest come
/// first, and the number of the others.
std::string counts_line(std::string_view title, const Counts& counts) {
  std::vector<std::pair<std::string, std::size_t>> order(counts.begin(), counts.end());
  if (order.size() > kMostNames) {
    std::ranges::stable_sort(order, std::greater(), [](const auto& each) { return each.second; });
  }
  std::string line = fmt::format("{:<10}", title);
  for (std::size_t i = 0; i < std::min(order.size(), kMostNames); ++i) {
    const auto& [name, count] = order[i];
    line += fmt::format("{} {} {}", i == 0 ? "" : ",", count, wire::printable(name));
  }
  if (order.size() > kMostNames) line += fmt::format(", and {} more", order.size() - kMostNames);
  return line + "\n";
}

void add_count(std::string& text, std::uint64_t count, std::string_view words) {
  if (count > 0) text += fmt::format("left out   {} {}\n", count, words);
}

}  // namespace

std::string session_csv(const Session& session) {
  std::string text;
  for (const std::string_view name : answer_column_names()) {
    text += (text.empty() ? "" : ",") + std::string(name);
  }
  text += "\r\n";
  for (const RecordedRequest& request : session.requests) {
    std::string line;
    for (const AnswerColumn& column : answer_columns(request)) line += "," + field(column.value);
    text += line.substr(1) + "\r\n";
  }
  return text;
}

std::string session_summary(const Session& session) {
  Counts statuses;
  Counts clients;
  Counts scenes;
  double last_s = 0.0;
  for (const RecordedRequest& request : session.requests) {
    ++statuses[request.answer ? request.answer->status : "unanswered"];
    ++clients[request.ids.client_id];
    ++scenes[request.scene];
    last_s = std::max(last_s, request.answer ? request.answer->received_s : request.received_s);
  }
  std::string text =
      fmt::format("events     {}, {} bytes\nrequests   {} in {:.3f} s\n", session.log.events,
                  session.log.bytes_used, session.requests.size(), last_s);
  text += counts_line("statuses", statuses) + counts_line("clients", clients) +
          counts_line("scenes", scenes);
  if (!session.parts.empty()) {
    text += fmt::format("recording  {} files, {} states and changes of scenes, camwayd {}\n",
                        session.parts.size(), session.updates.size(),
                        wire::printable(session.parts.back().version));
  }
  for (const record::Omission& omission : session.omissions) {
    text += fmt::format("lacks      {} messages and {} changes of scenes: {}\n", omission.messages,
                        omission.changes, wire::printable(omission.reason));
  }
  for (const std::string& each : session.left_out) text += "left out   " + each + '\n';
  add_count(text, session.malformed, "messages that cannot be read");
  add_count(text, session.other_version, "of them of another version of the wire types");
  add_count(text, session.distrusted, "messages without a valid signature");
  add_count(text, session.damaged_events, "damaged events of the recording");
  add_count(text, session.incomplete, "requests or answers with a missing page");
  add_count(text, session.conflicts, "requests with the id of another one");
  add_count(text, session.unasked, "answers to requests that are not in the log");
  return text;
}

}  // namespace camway::tools
