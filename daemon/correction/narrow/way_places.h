// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// Returns the points of a way that a ball of that radius cannot skip on a straight line; the ways
/// of balls lead from cell to cell, up and down in open space.
std::vector<geometry::Vec3> pulled_tight(const FreeSpace& space,
                                         std::span<const geometry::Vec3> way_W, double radius_m);

/// A place on a way, and the index of the way's point before it.
struct WayPlace {
  geometry::Vec3 at_W;
  std::size_t leg = 0;
};

/// Returns places on `way_W`, both ends included, at most a quarter of `radius_m` apart; nothing if
/// they would be too many. [Limit: one point or more]
std::vector<WayPlace> places_on_way(std::span<const geometry::Vec3> way_W, double radius_m);

/// A range of places, from `begin` to before `end`.
struct PlaceRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Returns the ranges of places of whose indices `is_narrow` is true. Ranges less than the body's
/// diameter apart are one. Leaves out ranges at the ends of the way, where the body is already.
std::vector<PlaceRange> inner_ranges(std::size_t places,
                                     const std::function<bool(std::size_t)>& is_narrow);

/// Returns the places of an inner range, the one before it and the one behind it.
std::vector<geometry::Vec3> with_neighbours_W(std::span<const WayPlace> places,
                                              const PlaceRange& range);

}  // namespace camway::correction
