// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace camway::tools {

/// A column of numbers, and how many of its unit are a metre, a second or a radian.
struct CsvColumn {
  std::size_t index = 0;
  double units = 1.0;
};

/// The columns of a table of poses.
struct PoseColumns {
  char separator = ',';
  std::size_t line = 0;   ///< that of the names, from 1
  std::size_t count = 0;  ///< of all columns
  std::array<CsvColumn, 3> position{};
  std::array<CsvColumn, 4> orientation{};  ///< w, x, y, z
  CsvColumn time;
  bool has_time_unit = false;
  std::optional<CsvColumn> fov_x;
  std::optional<CsvColumn> fov_y;
  std::string unclear_fov;  ///< a column that does not say which angle of view it has
  bool is_euroc = false;
};

/// Splits a line at `separator`. Blanks and quotes about a field are removed; what is quoted is not
/// split.
std::vector<std::string_view> csv_fields(std::string_view line, char separator);

/// Reads the line that names the columns, after blank lines and remarks, and removes it and those
/// before it from `text`. Fails with the line and the columns that are missing, or have a unit that
/// is not known.
base::Result<PoseColumns> take_pose_columns(std::string_view& text);

}  // namespace camway::tools
