// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::point_readers {

/// Reads points as text, one on each line: three or more columns between blanks, tabs, commas or
/// semicolons. What follows `#` or `//` is a remark. The first line may be a header of names; if it
/// names x, y and z, their columns count, else the first three. Other columns are not looked at. A
/// line with too few columns, or where a coordinate is no number, is refused by its number.
base::Result<import_record::Record> read_xyz(std::string_view bytes);

}  // namespace camway::scene::point_readers
