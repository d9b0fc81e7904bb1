// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/camway/replay/compare/pictures.h"
#include "tools/camway/replay/compare/report.h"
#include "tools/view/page_files.h"

namespace camway::tools {

/// The requests that a page shows in 3D.
enum class Reviewed { kNone, kDiffering, kAll };

constexpr std::array<std::string_view, 3> names_of(Reviewed) {
  return {"none", "differing", "all"};
}

/// Bytes of a megabyte, as sizes of pages are given and said.
inline constexpr std::size_t kMegabyte = 1'000'000;

struct PageOptions {
  Reviewed reviewed = Reviewed::kDiffering;
  std::size_t pictures = 6;  ///< most floor plans
  /// Most bytes of the page. A table that is larger alone makes the page larger.
  std::size_t most_bytes = 16 * kMegabyte;
};

/// A page, and what it lacks.
struct ReportPage {
  std::string html;
  std::vector<std::string> omissions;  ///< sentences; they are in the page, too
};

/// Returns the report as a page (`html_report`). Requests that differ are shown in 3D and as floor
/// plans, the worst verdicts first, in as far as the page becomes no larger than the options say.
ReportPage report_page(const ReportHead& head, const std::vector<ComparedRequest>& compared,
                       const SceneOf& scene_of, const PageOptions& options,
                       const view::PageFiles& page);

}  // namespace camway::tools
