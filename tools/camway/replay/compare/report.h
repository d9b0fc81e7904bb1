// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/camway/replay/compare/comparison.h"
#include "tools/camway/replay/compare/row.h"

namespace camway::tools {

enum class Times { kShown, kHidden };

/// The parts of a report beside the compared requests.
struct ReportHead {
  std::string title;              ///< of pages: the names of the log or logs
  std::string then = "recorded";  ///< names of the two sides, for people
  std::string now = "now";
  Times times = Times::kShown;
  std::vector<std::string> notes = {};  ///< sentences about messages that were left out
  Thresholds thresholds = {};
};

/// A picture of a compared request for a page.
struct RequestPicture {
  std::size_t index = 0;  ///< of the compared request
  std::string svg;        ///< an SVG document
};

/// Returns the notes about a session: messages that were left out, damage, repetitions. `whose`, if
/// not empty, begins each note.
std::vector<std::string> notes_of(const Session& session, const std::string& whose = {});

/// Returns the notes of a report: those of `head`, and one on scenes that have changed.
std::vector<std::string> all_notes(const ReportHead& head,
                                   const std::vector<ComparedRequest>& compared);

/// Returns the worst verdict in capitals, the number of requests and those of each verdict.
std::string summary_line(const std::vector<ComparedRequest>& compared);

/// Returns a table with a line for each request, the notes, and the summary.
std::string text_report(const ReportHead& head, const std::vector<ComparedRequest>& compared);

/// Returns the line of one request in that table.
std::string text_row(const Row& row, Times times);

/// Returns the report as JSON; docs/replay.md has the schema.
std::string json_report(const ReportHead& head, const std::vector<ComparedRequest>& compared);

/// The parts of a page beside its table and plots.
struct PageParts {
  std::vector<RequestPicture> pictures = {};
  std::set<std::size_t> reviews = {};  ///< indices of the requests that can be shown in 3D
  std::string review_elements = {};    ///< HTML that holds these reviews (`view::ReviewShelf`)
  /// Script of the page and its policy (`view::PageFiles`); empty: the page has no script.
  std::string_view script = {}, policy = {};
  std::vector<std::string> notes = {};  ///< sentences about the pictures
};

/// Returns the report as a page of HTML that is one file and asks nobody. Texts of the log are
/// escaped, pictures are shown as images, which run no scripts, and reviews in frames, which the
/// policy of the page binds, too.
std::string html_report(const ReportHead& head, const std::vector<ComparedRequest>& compared,
                        const PageParts& parts);

}  // namespace camway::tools
