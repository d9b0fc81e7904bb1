// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/correction/path/free_space.h"

namespace camway::correction {

struct LatticeOptions {
  /// Of the ball. One that holds the body in every orientation is on the safe side; a smaller one
  /// shows where the body may get through if it turns.
  double ball_radius_m = 0.0;
  double spacing_m = 0.1;          ///< between neighbouring points [Limit: value > 0]
  std::size_t max_points = 20000;  ///< that are met [Limit: value < 2^20]
  /// A way that is to be kept to where two are about as short; may be empty.
  std::span<const geometry::Vec3> about_W = {};
};

struct LatticeResult {
  /// From the begin to the end, both included; empty if none was found.
  std::vector<geometry::Vec3> way_W;
  /// All that can be reached at this spacing was looked at, and the end was not among it.
  bool exhausted = false;
  std::size_t points = 0;  ///< that were met
};

/// A way for a ball, by A* (Hart, Nilsson & Raphael 1968) on the points of a cubic lattice about
/// `from_W`, 26 neighbours each. It is the shortest on the lattice, but that being close to the
/// scene makes a step count for up to twice its length, and being far from `about_W` for a little
/// more. Deviation: a point waits with what it costs at least, and the scene is asked about it and
/// the steps that lead there when it is the next (as in lazy searches: Cohen, Phillips & Likhachev
/// 2014).
///
/// Between points the distance is looked at until the ball is shown to pass, or in steps that are
/// small beside it: a guide, not a proof. Deterministic, unless the deadline strikes.
/// Precondition: the ball is free at both ends.
LatticeResult lattice_way(const FreeSpace& space, const geometry::Vec3& from_W,
                          const geometry::Vec3& to_W, const LatticeOptions& options,
                          const collision::Deadline& deadline);

}  // namespace camway::correction
