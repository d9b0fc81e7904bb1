// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tools/camway/common/commands.h"
#include "tools/camway/replay/compare/comparison.h"
#include "tools/camway/replay/compare/pictures.h"
#include "tools/camway/replay/compare/report.h"
#include "tools/camway/replay/compare/report_page.h"

namespace camway::tools {

/// The files that a report is written to; an empty name means none.
struct ReportFiles {
  std::string json;
  std::string html;
  PageOptions page;
};

/// Returns why a report could not be written; empty if it could. Asked before long work. It must
/// not replace one of the `inputs`.
std::string why_unwritable(const ReportFiles& files, const std::vector<std::string>& inputs);

/// Prints the table, writes the files, and prints what the page lacks. Returns an error that names
/// the file; empty on success.
std::string write_reports(const ReportHead& head, const std::vector<ComparedRequest>& compared,
                          const SceneOf& scene_of, const ReportFiles& files);

/// Returns the exit code of a comparison: negative if a request has a verdict that fails; invalid
/// input if a log or a scene in it is damaged, or nothing could be compared.
ExitCode code_of(const std::vector<ComparedRequest>& compared, const Failing& failing,
                 bool is_damaged);

}  // namespace camway::tools
