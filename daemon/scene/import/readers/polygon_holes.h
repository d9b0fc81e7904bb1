// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace camway::scene::mesh_readers {

/// Joins the holes of a polygon to its outline: the ring goes along the outline, over a bridge to a
/// hole, round it, and back over the same bridge. Bridges cut no edge and lie inside the polygon,
/// in exact arithmetic.
///
/// `points` are the corners of the outline, which turns counter-clockwise, and then those of each
/// hole, which may turn either way, up to each of `ends`. Returns the corners of the ring, as
/// indices of `points`; empty if a hole cannot be reached. Time: up to the cube of the corners.
std::vector<std::uint32_t> ring_with_holes(std::span<const std::array<double, 2>> points,
                                           std::span<const std::size_t> ends);

}  // namespace camway::scene::mesh_readers
