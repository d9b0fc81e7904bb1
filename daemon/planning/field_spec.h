// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace camway::planning {

/// The numbers that a member of a request may hold. Never NaN.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool excludes_least = false;
  bool excludes_most = false;
  bool excludes_infinity = false;

  [[nodiscard]] bool any() const { return least > -std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool holds(double value) const;
};

inline constexpr Range kAboveZero{.least = 0.0, .excludes_least = true};

/// A member of a request. The tables `visit_options` and its like consist of these: what reads,
/// writes, checks or describes requests follows them.
struct FieldSpec {
  std::string_view name;  ///< in paths (`FieldSpelling`): "turn_rate"
  /// In the structs here, on the wire and in the client; empty: `name`. "turn_rate_rad_per_s"
  std::string_view wire = {};
  std::string_view file = {};  ///< in request files; empty: `name`. "turn_rate_deg"
  std::string_view unit = {};  ///< for messages about a value
  Range range = {};
  std::string_view unset = {};  ///< default, where the initial value of the member does not tell it
  std::string_view help = {};   ///< meaning, as a cell of a Markdown table

  [[nodiscard]] constexpr std::string_view wire_name() const { return wire.empty() ? name : wire; }
  [[nodiscard]] constexpr std::string_view file_name() const { return file.empty() ? name : file; }
  /// Angles are degrees in files, and radians in memory.
  [[nodiscard]] constexpr bool is_angle() const { return file_name().ends_with("_deg"); }
  /// Whether messages about a value say degrees: of angles that have a largest one.
  [[nodiscard]] bool is_told_in_degrees() const;
  /// The range, e.g. "at least 0 and below 1", "from 1e-06 to 1e+06", "between 0 and 180 degrees".
  [[nodiscard]] std::string range_text() const;
};

}  // namespace camway::planning
