// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::point_readers {

/// Reads points of an ASPRS LAS file, 1.0 to 1.4, in any of the point data record formats 0 to 10:
/// X, Y and Z, which are whole numbers, times the scale of the header plus its offset. All points
/// count, whatever their class or flags. Compressed points (LAZ) are refused, and so is a file that
/// is shorter than its header says; the message names the byte.
base::Result<import_record::Record> read_las(std::string_view bytes);

}  // namespace camway::scene::point_readers
