// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/csv_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"

namespace camway::tools {
namespace {

namespace readers = scene::mesh_readers;

struct Unit {
  std::string_view name;
  double units;  ///< of it in the base unit
};
constexpr std::array<Unit, 7> kTimeUnits = {{{"s", 1.0},
                                             {"sec", 1.0},
                                             {"seconds", 1.0},
                                             {"ms", 1e3},
                                             {"us", 1e6},
                                             {"ns", 1e9},
                                             {"nsec", 1e9}}};
constexpr std::array<Unit, 3> kLengthUnits = {{{"m", 1.0}, {"cm", 1e2}, {"mm", 1e3}}};
constexpr std::array<Unit, 2> kAngleUnits = {{{"deg", 180.0 / std::numbers::pi}, {"rad", 1.0}}};

using Names = std::span<const std::string_view>;
constexpr std::array<std::string_view, 6> kTimeNames = {"time",  "t",       "timestamp",
                                                        "stamp", "seconds", "sec"};
/// Not read: which rate would it be?
constexpr std::array<std::string_view, 3> kFrameNames = {"frame", "frames", "framenumber"};
constexpr std::array<std::string_view, 7> kPositionNames = {
    "", "t", "p", "pos", "position", "poseposition", "prsr"};
constexpr std::array<std::string_view, 6> kOrientationNames = {
    "q", "rot", "quat", "orientation", "poseorientation", "qrs"};
constexpr std::string_view kNeeded = "a table has time, x, y, z, qw, qx, qy and qz";

/// "p_RS_R_x [m]", "x_m" and "Pos X" are prsrx in m, x in m, and posx.
struct ColumnName {
  std::string name;  ///< letters and digits only, in lower case
  std::string unit;  ///< empty: not stated
  std::string_view text;
};

std::string lower_letters(std::string_view text) {
  std::string lower;
  for (const char c : text) {
    if (c >= 'A' && c <= 'Z') lower += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) lower += c;
  }
  return lower;
}

bool is_unit(std::string_view word) {
  const auto has = [&](auto& units) {
    return std::ranges::any_of(units, [&](const Unit& each) { return each.name == word; });
  };
  return has(kTimeUnits) || has(kLengthUnits) || has(kAngleUnits);
}

ColumnName name_of(std::string_view text) {
  ColumnName column{"", "", text};
  std::string_view name = text;
  if (const std::size_t open = name.find_first_of("[("); open != std::string_view::npos) {
    const std::string_view rest = name.substr(open + 1);
    column.unit = lower_letters(rest.substr(0, rest.find_first_of("])")));
    name = name.substr(0, open);
  } else if (const std::size_t last = name.rfind('_'); last != std::string_view::npos) {
    const std::string suffix = lower_letters(name.substr(last + 1));
    if (is_unit(suffix)) {
      column.unit = suffix;
      name = name.substr(0, last);
    }
  }
  column.name = lower_letters(name);
  return column;
}

char separator_of(std::string_view line) {
  for (const char separator : {';', '\t'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ',';
}

/// Reads the columns by their names.
class ColumnFinder {
 public:
  explicit ColumnFinder(std::string_view line) : separator_(separator_of(line)) {
    for (const std::string_view field : csv_fields(line, separator_)) {
      names_.push_back(name_of(field));
    }
    while (names_.size() > 1 && names_.back().text.empty()) names_.pop_back();
  }

  /// Requires a call of `fault` after it.
  PoseColumns find() {
    PoseColumns columns;
    columns.separator = separator_;
    columns.count = names_.size();
    columns.time = needed("time", kTimeNames, "", kTimeUnits);
    columns.has_time_unit = has_unit(columns.time);
    for (std::size_t i = 0; i < 3; ++i) {
      columns.position[i] = needed("xyz"[i], kPositionNames, kLengthUnits);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      columns.orientation[i] = needed("wxyz" [i], kOrientationNames, {});
    }
    columns.fov_x = angle("fovx", columns);
    columns.fov_y = angle("fovy", columns);
    angle("fov", columns);
    columns.is_euroc = missing_.empty() && names_[columns.position[0].index].name == "prsrx";
    return columns;
  }

  /// Why the columns are none; empty if they are some.
  [[nodiscard]] std::string fault() const {
    if (!unit_fault_.empty()) return unit_fault_;
    if (missing_.empty()) return "";
    if (std::isfinite(readers::parse_decimal(names_.front().text))) {
      return fmt::format("has numbers, but should name the columns; {}", kNeeded);
    }
    const bool has_frames = missing_.starts_with("time") && column(kFrameNames, "") != nullptr;
    return fmt::format("names no column for {}; {}{}", missing_, kNeeded,
                       has_frames ? ": frames are not read as times, so divide them by their rate, "
                                    "in a column time_s"
                                  : "");
  }
  [[nodiscard]] bool is_complete() const { return missing_.empty(); }

 private:
  const ColumnName* column(Names wanted, std::string_view axis) const {
    const auto found = std::ranges::find_if(names_, [&](const ColumnName& each) {
      return std::ranges::any_of(wanted, [&](std::string_view name) {
        return each.name == std::string(name) + std::string(axis);
      });
    });
    return found == names_.end() ? nullptr : &*found;
  }

  bool has_unit(const CsvColumn& column) const {
    return column.index < names_.size() &&
           (!names_[column.index].unit.empty() || names_[column.index].name.starts_with("sec"));
  }

  CsvColumn needed(char axis, Names names, std::span<const Unit> units) {
    const std::string shown = units.empty() ? "q" : "";
    return needed(shown + axis, names, std::string_view(&axis, 1), units);
  }

  CsvColumn needed(const std::string& shown, Names names, std::string_view axis,
                   std::span<const Unit> units) {
    const ColumnName* const found = column(names, axis);
    if (found == nullptr) {
      missing_ += (missing_.empty() ? "" : ", ") + shown;
      return {names_.size(), 1.0};
    }
    return {static_cast<std::size_t>(found - names_.data()), units_in(*found, units)};
  }

  /// The angle of view of this name. One that does not say its unit, or which of both it is, is
  /// unclear.
  std::optional<CsvColumn> angle(std::string_view name, PoseColumns& columns) {
    const ColumnName* const found = column({&name, 1}, "");
    if (found == nullptr) return std::nullopt;
    if (found->unit.empty() || name == "fov") {
      columns.unclear_fov = found->text;
      return std::nullopt;
    }
    return CsvColumn{static_cast<std::size_t>(found - names_.data()),
                     units_in(*found, kAngleUnits)};
  }

  double units_in(const ColumnName& name, std::span<const Unit> units) {
    if (name.unit.empty() || units.empty()) return 1.0;
    const auto found = std::ranges::find(units, name.unit, &Unit::name);
    if (found != units.end()) return found->units;
    std::string known;
    for (const Unit& each : units) known += (known.empty() ? "" : ", ") + std::string(each.name);
    unit_fault_ = fmt::format("column '{}' has a unit that is not known: {} are", name.text, known);
    return 1.0;
  }

  char separator_;
  std::vector<ColumnName> names_;
  std::string missing_;
  std::string unit_fault_;
};

}  // namespace

std::vector<std::string_view> csv_fields(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= line.size(); ++at) {
    if (at < line.size() && line[at] == '"') is_quoted = !is_quoted;
    if (at < line.size() && (is_quoted || line[at] != separator)) continue;
    std::string_view field = readers::trimmed(line.substr(begin, at - begin));
    if (field.size() > 1 && field.starts_with('"') && field.ends_with('"')) {
      field = readers::trimmed(field.substr(1, field.size() - 2));
    }
    fields.push_back(field);
    begin = at + 1;
  }
  return fields;
}

base::Result<PoseColumns> take_pose_columns(std::string_view& text) {
  text = readers::without_bom(text);
  for (std::size_t line = 1; !text.empty(); ++line) {
    std::string_view content = readers::trimmed(readers::take_line(text));
    if (content.empty()) continue;
    const bool is_remark = content.starts_with('#');
    if (is_remark) content.remove_prefix(1);
    ColumnFinder finder(content);
    PoseColumns columns = finder.find();
    columns.line = line;
    const std::string fault = finder.fault();
    if (is_remark && !finder.is_complete()) continue;
    if (!fault.empty()) return base::Failure{fmt::format("line {} {}", line, fault)};
    return columns;
  }
  return base::Failure{fmt::format("has no line that names columns; {}", kNeeded)};
}

}  // namespace camway::tools
