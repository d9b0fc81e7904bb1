// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/correction/narrow/narrow_passage.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// Finds a motion of the body through each place of `way_W` at which it collides with the
/// orientation of the interpolated path, and keeps that orientation. Requires a policy of `space`
/// that allows no turns.
///
/// From the middle of such a narrow place, and from its tightest point, a line is shifted to where
/// it has the most room. The body is put there, or in the middle of the free space beside it; where
/// it collides, a scaled-down body grows there (`centering.h`). From there the narrow place is
/// followed to both sides (`corridor.h`), to the places of the way before and behind it. The
/// motions are proved free with `margin_m` beyond the required clearance, or with less where the
/// gap is small.
///
/// `from`: the pose at the beginning. `interpolated`: poses of the interpolated path at equal steps
/// in time; the body has their orientation at the same share of the length of the way. Returns
/// nothing if a narrow place was not passed. Deterministic, unless the deadline strikes.
///
/// [Limit: `way_W` has one point or more, `interpolated` two]
std::optional<std::vector<NarrowPassage>> kept_passages(
    FreeSpace& space, std::span<const geometry::Vec3> way_W, const motion::SignedPose& from,
    std::span<const motion::Pose> interpolated, double margin_m, const base::Deadline& deadline);

/// Returns the guide from `from` to `to` on which the centre of the body follows `way_W`, with the
/// orientations of `interpolated` as above; nothing unless its motions are proved free with
/// `margin_m` beyond the required clearance. Requires a way from the centre of the body at `from`
/// to that at `to`. [Limit: as above]
std::optional<Guide> kept_way(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                              const motion::SignedPose& from, const motion::SignedPose& to,
                              std::span<const motion::Pose> interpolated, double margin_m);

}  // namespace camway::correction
