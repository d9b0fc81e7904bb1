// SPDX-License-Identifier: MIT
#include "daemon/planning/request/field_spec.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace camway::planning {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

std::string_view unit_name(AngleUnit angles) {
  return angles == AngleUnit::kDegrees ? " degrees" : " rad";
}

}  // namespace

bool Range::holds(double value) const {
  if (excludes_infinity && std::isinf(value)) return false;
  const bool is_above = excludes_least ? value > least : value >= least;
  return is_above && (excludes_most ? value < most : value <= most);
}

bool FieldSpec::is_plain_angle() const { return is_angle() && std::isfinite(range.most); }

std::string FieldSpec::value_text(double value, AngleUnit angles) const {
  const bool is_scaled = is_angle() && angles == AngleUnit::kDegrees;
  // Fewer digits than a double has, so that a number of degrees is the one that was written.
  std::string text =
      is_scaled ? fmt::format("{:.12g}", value * kDegreesPerRadian) : fmt::format("{}", value);
  if (is_plain_angle()) text += unit_name(angles);
  if (!unit.empty()) text += fmt::format(" {}", unit);
  return text;
}

std::string FieldSpec::range_text(AngleUnit angles) const {
  const double scale = is_plain_angle() && angles == AngleUnit::kDegrees ? kDegreesPerRadian : 1.0;
  const double least = range.least * scale;
  const double most = range.most * scale;
  const bool is_closed = !range.excludes_least && !range.excludes_most;
  if (std::isfinite(most) && is_closed) {
    return is_angle() ? fmt::format("between {:g} and {:g}{}", least, most, unit_name(angles))
                      : fmt::format("from {:g} to {:g}", least, most);
  }
  std::string text = fmt::format("{} {:g}", range.excludes_least ? "above" : "at least", least);
  if (std::isfinite(most)) {
    text += fmt::format(" and {} {:g}", range.excludes_most ? "below" : "at most", most);
  }
  if (is_plain_angle()) text += unit_name(angles);
  return range.excludes_infinity ? text + " and finite" : text;
}

}  // namespace camway::planning
