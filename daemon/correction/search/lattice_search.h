// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A ball that a way must not enter with its centre.
struct AvoidedBall {
  geometry::Vec3 center_W = geometry::Vec3::Zero();
  double radius_m = 0.0;
};

/// Weight of the way that is left. Measured: at 1.2 searches visit half as many points as at 1, and
/// the corrected paths are as good.
inline constexpr double kLatticeGreed = 1.2;

struct LatticeOptions {
  /// Radius of the ball. A ball that holds the body in every orientation is conservative; a smaller
  /// one shows where the body may get through if it turns.
  double ball_radius_m = 0.0;
  double spacing_m = 0.1;          ///< distance of neighbouring points [Limit: value > 0]
  std::size_t max_points = 20000;  ///< points that may be visited [Limit: value < 2^20]
  /// A polyline to prefer among ways of about equal length; may be empty.
  std::span<const geometry::Vec3> about_W = {};
  std::span<const AvoidedBall> avoided = {};
  /// Limit of the cost of a way, with the rest of it weighted. [Units: metres]
  double max_cost_m = std::numeric_limits<double>::infinity();
};

struct LatticeResult {
  /// The way from begin to end, both included; empty if none was found.
  std::vector<geometry::Vec3> way_W;
  /// Whether all points that are reachable at this spacing were visited, without the end among
  /// them.
  bool exhausted = false;
  double cost_m = 0.0;     ///< cost of the way, but for the last step to its end
  std::size_t points = 0;  ///< number of points visited
};

/// Finds a way for a ball by A* (Hart, Nilsson & Raphael 1968) on the points of a cubic lattice
/// about `from_W`, with 26 neighbours each. The cost of a step is its length, times up to 2 near
/// the scene and slightly more far from `about_W`. Deviations: the way that is left is
/// weighted by `kLatticeGreed`, so the cost of the way found is at most that times the least (Pohl
/// 1970); a point is queued with a lower bound of its cost, and the scene is queried about the
/// point and the steps to it only when it comes first (lazy search, as in Cohen, Phillips &
/// Likhachev 2014).
///
/// A step is checked until the distances show that the ball passes, or at intervals that are small
/// beside it: the way is a guide, not a proof. Deterministic, unless the deadline strikes. Requires
/// the ball to be free at both ends.
LatticeResult lattice_way(const FreeSpace& space, const geometry::Vec3& from_W,
                          const geometry::Vec3& to_W, const LatticeOptions& options,
                          const base::Deadline& deadline);

}  // namespace camway::correction
