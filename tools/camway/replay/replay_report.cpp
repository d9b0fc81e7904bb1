// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "lcmtypes/wire/channels.h"
#include "tools/camway/replay/replay_run.h"

namespace camway::tools {
namespace {

/// Returns the number of keyframes of a result, or of its message, that have this origin.
template <class Answer, class Origin>
std::string count_of(const Answer& answer, Origin origin) {
  return std::to_string(std::ranges::count_if(
      answer.keyframes, [&](const auto& keyframe) { return keyframe.origin == origin; }));
}

std::string verdict_text(const ReplayedRequest& item) {
  switch (item.verdict) {
    case Verdict::kAgrees:
      return item.difference.what.empty() ? "same" : "within tolerance: " + item.difference.what;
    case Verdict::kDiffers:
      return "DIFFERS: " + item.note;
    case Verdict::kNotCompared:
      break;
  }
  return "not compared: " + item.note;
}

/// Returns recorded and new value as one cell, such as "2 -> 3", or one value if they are equal.
std::string change(const std::string& then, const std::string& now) {
  return then == now ? now : then + " -> " + now;
}

std::string row(const RecordedRequest& recorded, const ReplayedRequest& item, Times times) {
  const plan_response_t* then =
      recorded.answer && recorded.answer->result ? &*recorded.answer->result : nullptr;
  const std::string status(planning::to_string(item.result.status));
  const std::string inserted = count_of(item.result, motion::KeyframeOrigin::kInserted);
  std::string line =
      fmt::format("{:<24} {:>16} {:<12} {:<20} {:>9}", recorded.ids.client_id,
                  recorded.ids.request_id, wire::printable(recorded.scene),
                  change(recorded.answer ? recorded.answer->status : "-", status),
                  then ? change(count_of(*then, keyframe_t::ORIGIN_INSERTED), inserted) : inserted);
  const bool compared = item.verdict != Verdict::kNotCompared;
  line +=
      compared ? fmt::format(" {:>10.3g}", item.difference.path_m) : fmt::format(" {:>10}", "-");
  if (times == Times::kShown) {
    line += then ? fmt::format(" {:>11.1f}", then->total_ms) : fmt::format(" {:>11}", "-");
    line += fmt::format(" {:>9.1f}", item.result.timing.total_ms);
  }
  line += "  " + verdict_text(item);
  if (item.scene_changed) line += " (the scene has other triangles than it had)";
  return line + '\n';
}

void add_note(std::string& out, std::uint64_t count, std::string_view what) {
  if (count > 0) out += fmt::format("note: {} {}\n", count, what);
}

}  // namespace

std::string report(const Session& session, const std::vector<ReplayedRequest>& replayed,
                   Times times) {
  std::string out = fmt::format("{:<24} {:>16} {:<12} {:<20} {:>9} {:>10}", "client", "request",
                                "scene", "status", "inserted", "path_m");
  if (times == Times::kShown) out += fmt::format(" {:>11} {:>9}", "recorded_ms", "now_ms");
  out += "  verdict\n";
  std::uint64_t repeated = 0;
  std::uint64_t changed = 0;
  for (std::size_t i = 0; i < replayed.size(); ++i) {
    out += row(session.requests[i], replayed[i], times);
    repeated += session.requests[i].sent - 1;
    if (replayed[i].scene_changed) ++changed;
  }
  add_note(out, repeated, "repetitions of requests, planned once each");
  add_note(out, session.conflicts, "requests left out: their id was used before for another one");
  add_note(out, session.incomplete, "messages left out: a page is missing");
  add_note(out, session.malformed - session.other_version, "messages left out: malformed");
  add_note(out, session.other_version,
           "messages left out: of another version of the wire types than this camway's");
  add_note(out, session.distrusted, "messages left out: their signature is missing or not good");
  add_note(out, session.unasked, "answers to requests that are not in the log");
  add_note(out, changed, "answers were computed on other triangles than the scene has now");
  if (!session.log.damage.empty()) {
    out += fmt::format("note: the log is damaged: {} good events were used, {} of {} bytes\n",
                       session.log.events, session.log.bytes_used, session.log.bytes);
  }
  const std::size_t differing = count(replayed, Verdict::kDiffers);
  const std::size_t agreeing = count(replayed, Verdict::kAgrees);
  out += fmt::format("verdict: {}: {} requests: {} agree, {} differ, {} not compared\n",
                     differing > 0   ? "DIFFERENT"
                     : agreeing == 0 ? "NOTHING TO COMPARE"
                                     : "SAME",
                     replayed.size(), agreeing, differing, count(replayed, Verdict::kNotCompared));
  return out;
}

}  // namespace camway::tools
