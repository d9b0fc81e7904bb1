// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/search/lattice_search.h"

namespace camway::correction {

/// A ball whose way is searched on lattices, and the two places that it joins.
struct BallMotion {
  double radius_m = 0.0;
  geometry::Vec3 from_W = geometry::Vec3::Zero();
  geometry::Vec3 to_W = geometry::Vec3::Zero();
  std::vector<AvoidedBall> avoided = {};
  double max_cost_m = std::numeric_limits<double>::infinity();
  /// Limit of the points of each lattice, beside the lattice's own.
  std::size_t max_points = std::numeric_limits<std::size_t>::max();
};

/// The lattices on which a way is searched.
enum class Lattices {
  kAll,
  kAllButFinest,  ///< detours that need the finest one mostly need turning as well
  kFinest,
  /// The coarsest, and the next one if the points of the first did not run out. Only
  /// `LatticeWayUse::use` is called.
  kCoarse,
};

/// Receives the ways of `for_each_lattice_way`.
struct LatticeWayUse {
  /// Uses a way, which joins `from_W` to `to_W`. The search ends if it returns true.
  std::function<bool(const LatticeResult& way)> use;
  /// Called if the coarsest lattice has no way that can be used. The search ends if it returns
  /// true.
  std::function<bool()> is_hopeless = [] { return false; };
  /// Called before lattices become costly. The search ends if it returns true.
  std::function<bool()> is_done = [] { return false; };
};

/// Searches ways for a ball on finer and finer lattices (`lattice_search.h`) until one can be used.
/// Where the limit of points ended searches, wider lattices follow, as the way may be much longer
/// than the distance of its ends; and the search starts from the other end, from where less may be
/// reachable. `about_W`: a polyline to prefer, or empty.
///
/// Returns the number of points visited. Requires the ball to be free at both ends.
std::size_t for_each_lattice_way(const FreeSpace& space, const BallMotion& ball, Lattices lattices,
                                 std::span<const geometry::Vec3> about_W, const LatticeWayUse& use,
                                 const base::Deadline& deadline);

}  // namespace camway::correction
