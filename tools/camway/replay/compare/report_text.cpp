// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>

#include "daemon/planning/stages/sentences.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/replay/compare/report.h"

namespace camway::tools {
namespace {

using planning::counted;

/// The verdicts that a summary names, from the best to the worst.
constexpr std::array kBestToWorst{Verdict::kSame, Verdict::kBetter, Verdict::kDifferent,
                                  Verdict::kWorse, Verdict::kRegressed};

std::string in_capitals(std::string_view word) {
  std::string capitals;
  for (const char c : word) {
    capitals += c == '_' ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return capitals;
}

/// Returns both values as one cell, such as "2 -> 3", or one value if they are equal.
std::string change(const std::string& then, const std::string& now) {
  return then == now ? now : then + " -> " + now;
}
std::string change(const ThenAndNow& values, const char* form) {
  const auto text = [&](const std::optional<double>& value) {
    return value ? fmt::format(fmt::runtime(form), *value) : "-";
  };
  return change(text(values.then), text(values.now));
}

std::string number_or_dash(const std::optional<double>& value, const char* form) {
  return value ? fmt::format(fmt::runtime(form), *value) : "-";
}

/// Adds "3 messages left out: malformed"; nothing for a count of 0.
void add_note(std::vector<std::string>& notes, const std::string& whose, std::uint64_t count,
              std::string_view noun, std::string_view rest) {
  if (count > 0) notes.push_back(fmt::format("{}{} {}", whose, counted(count, noun), rest));
}

}  // namespace

std::vector<std::string> notes_of(const Session& session, const std::string& whose) {
  std::vector<std::string> notes;
  std::uint64_t repeated = 0;
  for (const RecordedRequest& request : session.requests) repeated += request.sent - 1;
  const auto add = [&](std::uint64_t count, std::string_view noun, std::string_view rest) {
    add_note(notes, whose, count, noun, rest);
  };
  add(repeated, "repetition", "of requests, which count once each");
  add(session.conflicts, "request", "left out: the id was used before for another one");
  add(session.incomplete, "message", "left out: a page is missing");
  add(session.malformed - session.other_version, "message", "left out: malformed");
  add(session.other_version, "message",
      "left out: of another version of the wire types than this camway's");
  add(session.distrusted, "message", "left out: the signature is missing or not good");
  add(session.unasked, "answer", "to requests that are not in the log");
  add(session.damaged_events, "event", "about the recorded session left out: not to be read");
  for (const std::string& each : session.left_out) {
    notes.push_back(fmt::format("{}left out of the pack: {}", whose, each));
  }
  for (const record::Omission& omission : session.omissions) {
    // As doubles the difference cannot overflow.
    const double seconds =
        (static_cast<double>(omission.to_utime) - static_cast<double>(omission.from_utime)) * 1e-6;
    notes.push_back(fmt::format("{}the recording lacks {} and {} of scenes, within {:.1f} s: {}",
                                whose, counted(omission.messages, "message"),
                                counted(omission.changes, "change"), seconds,
                                wire::printable(omission.reason)));
  }
  if (!session.log.damage.empty()) {
    notes.push_back(fmt::format("{}the log is damaged: {} {} used, {} of {} bytes", whose,
                                counted(session.log.events, "good event"),
                                session.log.events == 1 ? "was" : "were", session.log.bytes_used,
                                session.log.bytes));
  }
  return notes;
}

std::vector<std::string> all_notes(const ReportHead& head,
                                   const std::vector<ComparedRequest>& compared) {
  std::vector<std::string> notes = head.notes;
  const auto changed =
      static_cast<std::size_t>(std::ranges::count(compared, true, &ComparedRequest::scene_changed));
  const std::string_view verb = changed == 1 ? "was" : "were";
  add_note(notes, {}, changed, "answer",
           fmt::format("{} computed on other triangles than the scene has now", verb));
  return notes;
}

std::string summary_line(const std::vector<ComparedRequest>& compared) {
  std::string worst = "NOTHING TO COMPARE";
  std::string counts;
  for (const Verdict verdict : kBestToWorst) {
    const std::size_t found = count(compared, verdict);
    if (found > 0) worst = in_capitals(base::name_of(verdict));
    counts += fmt::format("{} {}, ", found, base::name_of(verdict));
  }
  return fmt::format("verdict: {}: {}: {}{} not compared", worst,
                     counted(compared.size(), "request"), counts,
                     count(compared, Verdict::kNotCompared));
}

std::string text_row(const Row& row, Times times) {
  std::string line =
      fmt::format("{:<24} {:>16} {:<12} {:<20} {:>9} {:>10} {:>10} {:>18}", row.client, row.request,
                  wire::printable(row.scene), change(row.status_then, row.status_now),
                  change(row.inserted, "{:.0f}"), number_or_dash(row.path_m, "{:.3g}"),
                  number_or_dash(row.shift_deg, "{:.3g}"), change(row.clearance_m, "{:.4g}"));
  if (times == Times::kShown) {
    line += fmt::format(" {:>11} {:>9}", number_or_dash(row.total_ms.then, "{:.1f}"),
                        number_or_dash(row.total_ms.now, "{:.1f}"));
  }
  const bool is_calm = row.verdict == Verdict::kSame || row.verdict == Verdict::kNotCompared;
  std::string verdict = in_capitals(base::name_of(row.verdict));
  if (is_calm) verdict = row.verdict == Verdict::kSame ? "same" : "not compared";
  line += "  " + verdict;
  if (!row.explanation.empty()) line += ": " + wire::printable(row.explanation);
  return line + '\n';
}

std::string text_report(const ReportHead& head, const std::vector<ComparedRequest>& compared) {
  std::string out =
      fmt::format("{:<24} {:>16} {:<12} {:<20} {:>9} {:>10} {:>10} {:>18}", "client", "request",
                  "scene", "status", "inserted", "path_m", "shift_deg", "clearance_m");
  if (head.times == Times::kShown) out += fmt::format(" {:>11} {:>9}", "recorded_ms", "now_ms");
  out += "  verdict\n";
  for (const ComparedRequest& each : compared) out += text_row(row_of(each), head.times);
  for (const std::string& note : all_notes(head, compared)) {
    out += "note: " + wire::printable(note) + '\n';
  }
  return out + summary_line(compared) + '\n';
}

}  // namespace camway::tools
