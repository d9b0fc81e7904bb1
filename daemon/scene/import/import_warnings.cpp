// SPDX-License-Identifier: MIT
#include "daemon/scene/import/import_warnings.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene {
namespace {

std::string metres(double length_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g m", length_m);
  return text.data();
}

}  // namespace

std::string faces_left_out(const ImportReport& report) {
  struct Reason {
    std::uint64_t count;
    std::string_view text;
  };
  const std::array<Reason, 4> reasons = {{
      {report.dropped_nonfinite, "with a coordinate that is no usable number"},
      {report.dropped_bad_index, "with a vertex that does not exist"},
      {report.dropped_freeform, "that are free-form surfaces"},
      {report.degenerate_triangles, "of zero area"},
  }};
  std::string list;
  for (const Reason& reason : reasons) {
    if (reason.count == 0) continue;
    if (!list.empty()) list += ", ";
    list += std::to_string(reason.count) + " " + std::string(reason.text);
  }
  return list;
}

double finest_length_m(double interval_tolerance_m, double clearance_m) {
  return clearance_m > 0.0 ? std::min(interval_tolerance_m, clearance_m) : interval_tolerance_m;
}

std::vector<std::string> import_warnings(const ImportReport& report,
                                         std::optional<double> resolution_m,
                                         std::string_view resolution_name) {
  std::vector<std::string> warnings;
  if (const std::string list = faces_left_out(report); !list.empty()) {
    warnings.push_back("the scene is without faces of its file: " + list);
  }
  if (report.ignored_statements > 0) {
    warnings.push_back("lines of its file that begin with an unknown word, and were not read: " +
                       std::to_string(report.ignored_statements));
  }
  for (const std::string& note : report.notes) {
    if (note.starts_with(import_record::kWarningMark)) {
      warnings.push_back(note.substr(import_record::kWarningMark.size()));
    }
  }
  if (resolution_m && report.rounding_m > *resolution_m) {
    warnings.push_back("the scene's coordinates may be off by " + metres(report.rounding_m) +
                       ", which is more than the " + metres(*resolution_m) + " " +
                       std::string(resolution_name) + ": " +
                       (report.single_precision
                            ? "files of this format are read in single precision"
                            : "doubles are no finer so far from the origin"));
  }
  if (resolution_m && report.surface_error_m > *resolution_m) {
    warnings.push_back("the scene's smooth surfaces are flat facets within " +
                       metres(report.surface_error_m) + ", which is more than the " +
                       metres(*resolution_m) + " " + std::string(resolution_name) +
                       ": paths keep that far from all of the scene");
  }
  return warnings;
}

}  // namespace camway::scene
