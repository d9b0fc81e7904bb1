// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

/// The readers of OBJ, OFF, PLY and STL. They run in `camway-import` on files that nobody vouches
/// for: no count is believed before the bytes are there, nothing recurses, memory is
/// bounded by the file's size.
///
/// Why our own: assimp keeps coordinates in single precision (3 cm at 1e6 m). Of Debian's other
/// readers none does all four formats in doubles within limits: tinyobjloader reads OBJ alone, its
/// packaged build in single precision and its parser of decimals not correctly rounded; OpenMesh
/// keeps no faces that are not manifold; CGAL's stream readers allocate what a header promises and
/// stop at the first face they do not like; all but tinyobjloader follow the locale.
namespace camway::scene::mesh_readers {

/// The double nearest to a decimal, whatever the locale; NaN if `token` is anything else than one
/// number. Beyond the largest double: infinity; below the smallest: 0. "nan" and "inf" are read.
double parse_decimal(std::string_view token);

/// A whole number, with or without sign, and nothing else.
std::optional<std::int64_t> parse_integer(std::string_view token);

}  // namespace camway::scene::mesh_readers
