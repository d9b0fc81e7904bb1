// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace camway::planning {

/// The interval of numbers that a member of a request may have. NaN is in no range.
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

/// Returns whether a name in files is that of an angle, an angular rate or an angular acceleration:
/// in degrees in files, in radians in memory.
constexpr bool is_angle(std::string_view file_name) {
  const std::size_t at = file_name.find("_deg");
  if (at == std::string_view::npos) return false;
  const std::string_view rest = file_name.substr(at + std::string_view("_deg").size());
  return rest.empty() || rest.starts_with("_per_");
}

/// The unit of angles in a message: degrees for files, radians for the wire.
enum class AngleUnit { kDegrees, kRadians };

template <class T, class Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

/// Describes a member of a request. The functions `visit_table` are tables of these descriptions.
/// The code that reads, writes, checks or documents requests follows the tables.
struct FieldSpec {
  std::string_view name;  ///< name in paths (`FieldSpelling`): "turn_rate"
  /// Name in structs, on the wire and in the client, if not `name`: "turn_rate_rad_per_s".
  std::string_view wire = {};
  std::string_view file = {};      ///< name in request files, if not `name`: "turn_rate_deg_per_s"
  std::string_view old_file = {};  ///< old name in request files, which is still read
  std::string_view unit = {};      ///< unit in messages about a value
  Range range = {};
  bool is_needed = false;  ///< a request file has to have the member if it has the struct
  /// Text of the default in documents, if it is not the initial value of the member.
  std::string_view unset = {};
  std::string_view help = {};  ///< meaning, as a cell of a Markdown table
  bool has_section = false;    ///< whether the page of requests explains it in a section

  [[nodiscard]] constexpr std::string_view wire_name() const { return wire.empty() ? name : wire; }
  [[nodiscard]] constexpr std::string_view file_name() const { return file.empty() ? name : file; }
  [[nodiscard]] constexpr bool is_angle() const { return planning::is_angle(file_name()); }
  /// Returns the range in words: "at least 0 and below 1", "from 1e-06 to 1e+06", "between 0 and
  /// 180 degrees".
  [[nodiscard]] std::string range_text(AngleUnit angles = AngleUnit::kDegrees) const;
  /// Returns a value in words: "-1", "200 degrees". An angle is in radians.
  [[nodiscard]] std::string value_text(double value, AngleUnit angles) const;

 private:
  /// Whether it is an angle itself. Rates have their unit in their name, and no largest value.
  [[nodiscard]] bool is_plain_angle() const;
};

}  // namespace camway::planning
