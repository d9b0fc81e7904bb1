// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>

#include "daemon/correction/narrow/hole_line.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// The shifts from a line at which the body is tried: none, to the middle of the free space in the
/// one direction, in the other, and in both.
std::array<geometry::Vec3, 4> shifts_of(const Side& side, const Side& other);

/// A pose with a sign, and how much it is turned as the ends of a motion are.
struct SignedLikeEnds {
  double likeness = 0.0;  ///< cosine to the less similar end orientation
  motion::SignedPose pose;
};

/// Gives a pose the sign with which its orientation is nearer to those of both ends.
SignedLikeEnds signed_as_ends(const motion::Pose& pose, const motion::SignedPose& from,
                              const motion::SignedPose& to);

/// Returns the straight motion along the unit vector `along_W` through a free pose: as far to
/// either side as it is free with `margin_m`, but no farther than `farthest_m`. Returns nothing if
/// that leads less than about the radius of the body's ball to one side, which would not leave a
/// thin wall.
std::optional<Guide> straight_passage(FreeSpace& space, const motion::SignedPose& pose,
                                      const geometry::Vec3& along_W, double farthest_m,
                                      double margin_m);

/// Returns whether a motion begins nearer to the beginning of the way than to its end, and ends
/// nearer to its end.
bool leads_through(const Guide& poses, std::span<const geometry::Vec3> way_W,
                   const FreeSpace& space);

}  // namespace camway::correction
