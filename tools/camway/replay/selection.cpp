// SPDX-License-Identifier: MIT
#include "tools/camway/replay/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ctime>
#include <initializer_list>
#include <string_view>
#include <system_error>

#include "daemon/messages/text.h"

namespace camway::tools {
namespace {

/// Reads a whole text as a number.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Reads "2026-11-27T08:30:00.250Z" as seconds since 1970.
std::optional<double> clock_time_of(const std::string& text) {
  std::tm parts{};
  const char* rest = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
  if (rest == nullptr || text.empty() || text.back() != 'Z') return std::nullopt;
  const std::string fraction(rest, text.c_str() + text.size() - 1);
  double part_s = 0.0;
  if (!fraction.empty()) {
    const auto value = number_of<double>("0" + fraction);
    if (fraction[0] != '.' || !value) return std::nullopt;
    part_s = *value;
  }
  return static_cast<double>(::timegm(&parts)) + part_s;
}

/// Returns the time after the first event of the log.
double after_begin_s(const LogTime& time, std::int64_t begin_utime) {
  constexpr double kMicroseconds = 1e6;
  if (!time.is_of_the_clock) return time.value_s;
  return time.value_s - static_cast<double>(begin_utime) / kMicroseconds;
}

template <class Value>
bool holds(const std::vector<Value>& wanted, const Value& value) {
  return wanted.empty() || std::ranges::find(wanted, value) != wanted.end();
}

}  // namespace

std::optional<LogTime> log_time_of(const std::string& text) {
  if (const auto clock_s = clock_time_of(text)) return LogTime{*clock_s, true};
  const auto value_s = number_of<double>(text);
  if (!value_s || !std::isfinite(*value_s)) return std::nullopt;
  return LogTime{*value_s, false};
}

std::optional<std::vector<IdRange>> id_ranges_of(const std::string& text) {
  std::vector<IdRange> ranges;
  std::string_view rest = text;
  for (bool is_last = false; !is_last;) {
    const std::size_t comma = rest.find(',');
    is_last = comma == std::string_view::npos;
    const std::string_view item = rest.substr(0, comma);
    if (!is_last) rest.remove_prefix(comma + 1);
    const std::size_t dots = item.find("..");
    const auto first = number_of<std::int64_t>(item.substr(0, dots));
    const auto last =
        dots == std::string_view::npos ? first : number_of<std::int64_t>(item.substr(dots + 2));
    if (!first || !last || *first > *last) return std::nullopt;
    ranges.emplace_back(*first, *last);
  }
  return ranges;
}

bool Selection::is_all() const {
  return !from && !to && clients.empty() && ids.empty() && statuses.empty() && scenes.empty();
}

bool Selection::wants(const RecordedRequest& request, std::int64_t begin_utime) const {
  if (from && request.received_s < after_begin_s(*from, begin_utime)) return false;
  if (to && request.received_s > after_begin_s(*to, begin_utime)) return false;
  const auto holds_id = [&](const IdRange& range) {
    return range.first <= request.ids.request_id && request.ids.request_id <= range.second;
  };
  if (!ids.empty() && std::ranges::none_of(ids, holds_id)) return false;
  const std::string status = request.answer ? request.answer->status : "none";
  return holds(clients, request.ids.client_id) && holds(statuses, status) &&
         holds(scenes, request.scene);
}

bool is_backwards(const Selection& selection, std::int64_t begin_utime) {
  return selection.from && selection.to &&
         after_begin_s(*selection.from, begin_utime) > after_begin_s(*selection.to, begin_utime);
}

std::vector<std::string> words_of(const Selection& selection, std::int64_t begin_utime) {
  std::vector<std::string> words;
  const auto add_time = [&](std::string_view flag, const std::optional<LogTime>& time) {
    if (time) words.push_back(fmt::format("{}={}", flag, after_begin_s(*time, begin_utime)));
  };
  const auto add_list = [&](std::string_view flag, const std::vector<std::string>& values) {
    if (!values.empty()) words.push_back(fmt::format("{}={}", flag, fmt::join(values, ",")));
  };
  add_time("--from", selection.from);
  add_time("--to", selection.to);
  std::vector<std::string> ids;
  for (const auto& [first, last] : selection.ids) ids.push_back(fmt::format("{}..{}", first, last));
  add_list("--id", ids);
  add_list("--client", selection.clients);
  add_list("--status", selection.statuses);
  add_list("--scene-name", selection.scenes);
  return words;
}

std::vector<std::string> status_words() {
  std::vector<std::string> words{"none"};
  for (const std::string_view name : names_of(planning::Status{})) words.emplace_back(name);
  for (const std::int32_t status : std::initializer_list<std::int32_t>{
           plan_response_t::STATUS_OVERLOADED, plan_response_t::STATUS_MALFORMED,
           plan_response_t::STATUS_CANCELLED, plan_response_t::STATUS_LIMIT,
           plan_response_t::STATUS_OLD_SCENE}) {
    words.emplace_back(messages::status_name(status));
  }
  return words;
}

std::size_t select(const Selection& selection, Session& session) {
  return std::erase_if(session.requests, [&](const RecordedRequest& request) {
    return !selection.wants(request, session.begin_utime);
  });
}

}  // namespace camway::tools
