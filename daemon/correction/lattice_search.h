// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/correction/free_space.h"

namespace camway::correction {

struct LatticeOptions {
  /// Of the ball. One that holds the body in every orientation is on the safe side; a smaller one
  /// shows where the body may get through if it turns.
  double ball_radius_m = 0.0;
  double spacing_m = 0.1;          ///< between neighbouring points [Limit: value > 0]
  std::size_t max_points = 20000;  ///< of which the distance is asked for
};

struct LatticeResult {
  /// From the begin to the end, both included; empty if none was found.
  std::vector<geometry::Vec3> way_W;
  /// All that can be reached at this spacing was looked at, and the end was not among it.
  bool exhausted = false;
  std::size_t points = 0;  ///< of which the distance was asked for
};

/// A way for a ball, by A* (Hart, Nilsson & Raphael
/// 1968) on the points of a cubic lattice about `from_W`, 26 neighbours each, whose distance is
/// asked for when they are met. It is the shortest on the lattice, but that being close to the
/// scene makes a step count for up to twice its length.
///
/// Between points the distance is looked at until the ball is shown to pass, or in steps that are
/// small beside it: a guide, not a proof. Deterministic, unless the deadline strikes.
/// Precondition: the ball is free at both ends.
LatticeResult lattice_way(const FreeSpace& space, const geometry::Vec3& from_W,
                          const geometry::Vec3& to_W, const LatticeOptions& options,
                          const collision::Deadline& deadline);

}  // namespace camway::correction
