// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"

/// The readers of clouds of points. They run in `camway-import` on untrusted files. They use a
/// count only after checking that the file has its bytes, do not recurse, and need memory in
/// proportion to the file's size.
///
/// Why our own: PCL would read PCD, but links a hundred libraries and keeps coordinates in single
/// precision; Debian has no reader of LAS (liblas was removed); of both only three numbers of each
/// point are needed.
namespace camway::scene::point_readers {

/// Whether `read_points` reads files with this extension (".pcd", ".xyz", ".las", in any case).
bool is_point_extension(std::string_view extension);

/// Reads a cloud of points of one of these formats, with coordinates in doubles. Accepts any bytes.
/// Memory: 24 bytes for each point beside the file; compressed files may need a hundred times their
/// size. Points that are not finite are kept. Returns a record as in `record_layout.h` without the
/// header's counts, or the reason why the file cannot be read, with its line or byte. Requires
/// `is_point_extension(extension)`.
base::Result<import_record::Record> read_points(std::string_view extension, std::string_view bytes);

/// Returns the number in a text; NaN and infinities in any spelling of C. Nothing if it is none.
std::optional<double> number_in(std::string_view token);

}  // namespace camway::scene::point_readers
