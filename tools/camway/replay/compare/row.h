// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/camway/replay/compare/comparison.h"

namespace camway::tools {

/// A quantity in both answers; nothing where an answer does not have it.
struct ThenAndNow {
  std::optional<double> then, now;
};

/// The facts of a compared request that reports show. Texts of the log may hold anything.
struct Row {
  std::string client;
  std::int64_t request = 0;
  std::string scene;
  std::string status_then = "-", status_now = "-";
  Verdict verdict = Verdict::kNotCompared;
  /// The reason of the verdict, and the first difference; empty for the same bits.
  std::string explanation;
  std::optional<double> path_m, shift_deg;  ///< nothing where nothing was compared
  ThenAndNow inserted;                      ///< number of inserted keyframes
  ThenAndNow clearance_m;                   ///< proved; nothing where nothing was proved
  ThenAndNow length_m, deviation_m;
  ThenAndNow mean_shift_deg;  ///< from the path as interpolated; nothing where it is not told
  ThenAndNow total_ms;        ///< time of planning
};

Row row_of(const ComparedRequest& compared);

/// Returns "first differs in the correction: corrections[1].kind move -> go_round"; empty for the
/// same bits.
std::string divergence_text(const Difference& difference);

}  // namespace camway::tools
