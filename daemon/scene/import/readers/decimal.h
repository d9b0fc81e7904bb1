// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

/// The readers of OBJ, OFF, PLY and STL. They run in `camway-import` on untrusted files. They use a
/// count only after checking that the file has its bytes, do not recurse, and need memory in
/// proportion to the file's size.
///
/// Why our own: assimp keeps coordinates in single precision (3 cm at 1e6 m). Of Debian's other
/// readers none reads all four formats in doubles within limits: tinyobjloader reads OBJ alone, its
/// packaged build in single precision and its parser of decimals not correctly rounded; OpenMesh
/// keeps no faces that are not manifold; CGAL's stream readers allocate what a header promises and
/// stop at the first face they reject; all but tinyobjloader follow the locale.
namespace camway::scene::mesh_readers {

/// Returns the double nearest to a decimal, in any locale; NaN if `token` is not exactly one
/// number. Returns infinity beyond the largest double, and 0 below the smallest one. Accepts "nan"
/// and "inf".
double parse_decimal(std::string_view token);

/// Returns a whole number with or without a sign; nothing if `token` is not exactly one.
std::optional<std::int64_t> parse_integer(std::string_view token);

}  // namespace camway::scene::mesh_readers
