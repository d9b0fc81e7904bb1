// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// Finds a guide from `from` to `to` along `way_W`, a way for a ball much smaller than the body, on
/// which the body keeps the orientation of the interpolated path. Requires a policy of `space` that
/// allows no turns.
///
/// The way is pulled tight first (`way_places.h`). From the middle of each of its narrow places,
/// where the body collides, and from their tightest point, a line is shifted to where it has the
/// most room. The body is put there, or in the middle of the free space beside it; where it
/// collides, a scaled-down body grows there (`centering.h`). From there the narrow place is
/// followed to both sides (`corridor.h`), to the places of the way before and behind it.
///
/// `interpolated`: poses of the interpolated path at equal steps in time; the body has their
/// orientation at the same share of the length of the way. Motions are proved free with `margin_m`
/// beyond the required clearance, or with less where the gap is small. Returns nothing if a narrow
/// place was not passed. Deterministic, unless the deadline strikes.
///
/// [Limit: `way_W` has one point or more, `interpolated` two]
std::optional<Guide> kept_guide(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                                const motion::SignedPose& from, const motion::SignedPose& to,
                                std::span<const motion::Pose> interpolated, double margin_m,
                                const base::Deadline& deadline);

}  // namespace camway::correction
