// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// Margin of a way out where it begins at a small gap, relative to that. Chosen by measurement.
inline constexpr double kMarginOfGap = 0.3;

/// The test by which a body has left a narrow place.
enum class RoomTest {
  kGap,   ///< its gap is a share of the ball's radius, or the ball fits
  kBall,  ///< the ball fits; a ring about a thin pole has a gap, but is not off the pole
};

/// Follows the narrow place in which the body is at `from`, to where it has room. Returns the poses
/// on the way, `from` first, joined by straight motions that are free with `margin_m`; nothing if
/// it ends before.
///
/// Goes in small steps, with the body centred after each (`centering.h`). The direction is that in
/// which contacts change least: the eigenvector of the least eigenvalue of Σ n·nᵀ over the normals
/// n of the nearest pairs, with the sign that is nearer to `along_W` and later to the last step.
std::optional<Guide> way_out(FreeSpace& space, const motion::SignedPose& from,
                             const geometry::Vec3& along_W, RoomTest room_test, double margin_m,
                             const base::Deadline& deadline);

/// Returns the way out of a narrow place in which the body is at `from` already, in either
/// direction; only `from` where it has room, nothing if no way out was found.
std::optional<Guide> way_out(FreeSpace& space, const motion::SignedPose& from, RoomTest room_test,
                             const base::Deadline& deadline);

/// Free poses to which a corridor may lead: one before a narrow place, and one behind it.
struct CorridorGoals {
  motion::SignedPose back;
  motion::SignedPose forth;
};

/// Ways out to either side: from a pose in a narrow place backwards and forwards along `along_W`,
/// in the order of a way along it, without poses that a straight motion can skip. Each ends where
/// the body has room, or at its goal where a straight motion there is free: a body that passes a
/// door just above the floor has room nowhere. `goals` may be null. Nothing if one of the two ways
/// is missing.
std::optional<Guide> corridor(FreeSpace& space, const motion::SignedPose& middle,
                              const geometry::Vec3& along_W, double margin_m,
                              const base::Deadline& deadline, const CorridorGoals* goals = nullptr);

}  // namespace camway::correction
