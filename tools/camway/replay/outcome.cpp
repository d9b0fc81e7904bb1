// SPDX-License-Identifier: MIT
#include "tools/camway/replay/outcome.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/support/output_file.h"
#include "tools/view/page/embed/embedded_page.h"

namespace camway::tools {

std::string why_unwritable(const ReportFiles& files, const std::vector<std::string>& inputs) {
  for (const std::string& file : {files.json, files.html}) {
    if (file.empty()) continue;
    if (std::string fault = why_unwritable(file, inputs); !fault.empty()) return fault;
  }
  return {};
}

std::string write_reports(const ReportHead& head, const std::vector<ComparedRequest>& compared,
                          const SceneOf& scene_of, const ReportFiles& files) {
  fmt::print("{}", text_report(head, compared));
  std::string fault;
  if (!files.json.empty()) fault = write_file(files.json, json_report(head, compared));
  if (!fault.empty() || files.html.empty()) return fault;
  const ReportPage page = report_page(head, compared, scene_of, files.page, view::embedded_page());
  for (const std::string& omission : page.omissions) {
    fmt::print("note: {}: {}\n", files.html, omission);
  }
  return write_file(files.html, page.html);
}

ExitCode code_of(const std::vector<ComparedRequest>& compared, const Failing& failing,
                 bool is_damaged) {
  if (has_failed(compared, failing)) return ExitCode::kNegative;
  const bool has_any = count(compared, Verdict::kNotCompared) < compared.size();
  const bool is_whole =
      !is_damaged && std::ranges::none_of(compared, &ComparedRequest::scene_is_damaged);
  return !is_whole || !has_any ? ExitCode::kInvalidInput : ExitCode::kSuccess;
}

}  // namespace camway::tools
