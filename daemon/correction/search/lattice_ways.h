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
  std::vector<AvoidedBall> avoided = {};  ///< balls that the way must not meet
  double max_cost_m = std::numeric_limits<double>::infinity();  ///< limit of the cost of a way
  /// Limit of the points visited in each lattice. The lattice has a limit of its own as well.
  std::size_t max_points = std::numeric_limits<std::size_t>::max();
  double coarseness = 1.0;  ///< factor to the spacing of each lattice [Limit: value > 0]
};

/// The lattices on which a way is searched.
enum class Lattices {
  kAllButFinest,  ///< detours that need the finest one mostly are narrow as well
  kFinest,
  /// The coarsest one, and the next one if the points of the first did not run out. Only
  /// `LatticeWayUse::use` is called.
  kCoarse,
};

/// Receives the ways of `for_each_lattice_way`.
struct LatticeWayUse {
  /// Receives a way that joins `from_W` to `to_W`. Returns true to end the search.
  std::function<bool(const LatticeResult& way)> use;
  /// Called if `use` accepted no way on the coarsest lattice. Returns true to end the search.
  std::function<bool()> is_hopeless = [] { return false; };
  /// Called before the lattices that take long. Returns true to end the search.
  std::function<bool()> is_done = [] { return false; };
};

/// Searches ways for a ball on finer and finer lattices (`lattice_search.h`) until `use` accepts
/// one. If the limit of points ended searches, wider lattices follow, because the way may be much
/// longer than the distance of its ends. These searches start from the other end, from which fewer
/// points may be reachable. `about_W`: a polyline that ways should follow, or empty.
///
/// Returns the number of points visited. Requires that the ball is free at both ends.
std::size_t for_each_lattice_way(const FreeSpace& space, const BallMotion& ball, Lattices lattices,
                                 std::span<const geometry::Vec3> about_W, const LatticeWayUse& use,
                                 const base::Deadline& deadline);

}  // namespace camway::correction
