// SPDX-License-Identifier: MIT
#include "daemon/planning/request/field_spec.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace camway::planning {

bool Range::holds(double value) const {
  if (excludes_infinity && std::isinf(value)) return false;
  const bool is_above = excludes_least ? value > least : value >= least;
  return is_above && (excludes_most ? value < most : value <= most);
}

bool FieldSpec::is_told_in_degrees() const { return is_angle() && std::isfinite(range.most); }

std::string FieldSpec::range_text() const {
  const double scale = is_told_in_degrees() ? 180.0 / std::numbers::pi : 1.0;
  const double least = range.least * scale;
  const double most = range.most * scale;
  const bool is_closed = !range.excludes_least && !range.excludes_most;
  if (std::isfinite(most) && is_closed) {
    return is_angle() ? fmt::format("between {:g} and {:g} degrees", least, most)
                      : fmt::format("from {:g} to {:g}", least, most);
  }
  std::string text = fmt::format("{} {:g}", range.excludes_least ? "above" : "at least", least);
  if (std::isfinite(most)) {
    text += fmt::format(" and {} {:g}", range.excludes_most ? "below" : "at most", most);
  }
  if (is_told_in_degrees()) text += " degrees";
  return range.excludes_infinity ? text + " and finite" : text;
}

}  // namespace camway::planning
