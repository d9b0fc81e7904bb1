// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::surfaces {

/// More do not fit into the memory of the import process, by default.
inline constexpr std::uint64_t kMostPatchTriangles = 100'000'000;

/// Whether files with this extension (".bpt", in any case) are read as Bezier patches.
bool is_bezier_extension(std::string_view extension);

/// Reads a file of bicubic Bezier patches, the format of the Utah teapot: the number of patches, a
/// line of 16 one-based indices for each, the number of points, a line of three coordinates for
/// each. Commas and blanks separate numbers, empty lines do not count. Each patch is an object,
/// `patch_1` and so on.
///
/// Triangles are within `kRelativeTolerance` of half the diagonal of the control points in use
/// (`nurbs_surface.h`), and the record has the bound that was reached. Patches whose boundaries
/// have the same four control points, in either order, share the points of that boundary to the
/// bit, so they do not gape. Patches that meet in another way gape by twice the bound at most. An
/// edge whose four control points are one point has no triangles.
///
/// Accepts any bytes. Returns a record as in `record_layout.h` without the header's counts, or the
/// reason why the file cannot be read, with the line. A file that comes to more than `most`
/// triangles is refused.
base::Result<import_record::Record> read_bezier_patches(std::string_view text,
                                                        std::uint64_t most = kMostPatchTriangles);

}  // namespace camway::scene::surfaces
