// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tools/camway/replay/compare/verdict.h"

namespace camway::tools {

/// A mark of a plot.
struct PlotMark {
  double x = 0.0;
  double y = 0.0;
  Verdict verdict = Verdict::kSame;
  std::string label;  ///< for people; may hold anything
};

/// Returns a plot of a quantity now over the same quantity then, with the line where both are equal
/// and linear axes from 0, as an element `svg` of a page. Marks have the class `v-` and the name of
/// their verdict. Leaves out marks that are not finite; empty if none remains.
std::string then_now_plot(const std::string& title, const std::vector<PlotMark>& marks);

/// Returns a plot of a quantity over the number of the request, with a logarithmic axis for the
/// quantity. Quantities of 0 are on the lower rim, infinite ones on the upper rim. Empty if there
/// are no marks.
std::string by_request_plot(const std::string& title, const std::vector<PlotMark>& marks);

/// Returns `text` as it may stand in HTML, in elements and in quoted attributes; control characters
/// are replaced.
std::string in_html(const std::string& text);

}  // namespace camway::tools
