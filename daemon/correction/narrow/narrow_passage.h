// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// A motion of the body through a narrow place of a way, where the ball about the body does not
/// fit: a straight one, or one through many poses.
struct NarrowPassage {
  Guide poses;
  std::size_t first = 0;  ///< index of the last point of the way before the narrow place
  std::size_t last = 0;   ///< index of the first point of the way after it
};

/// Finds a motion of the body through each narrow place of `way_W`, a way for a smaller ball, in
/// the order of the way. Random sampling rarely finds such motions: a plate passes a hole little
/// wider than its short side in few orientations only.
///
/// From the tightest point of a narrow place a line is grown and shifted to where it has the most
/// room. The body is put there, or in the middle of the free space beside it, with one of its axes
/// along the line; it is rotated about the line step by step, and moved along the line to both
/// sides. Orientations that the interpolated path has are tried before these, and turns are made
/// smaller after them (`least_turn.h`). Where no such pose is free, scaled-down bodies are tried at
/// the same poses and grow (`centering.h`), and the narrow place is followed to both sides
/// (`corridor.h`). The motions are proved free with `margin_m` beyond the required clearance.
///
/// `from` and `to` are the poses at the ends, `interpolated` those of the interpolated path between
/// them at equal steps in time, at least two. Of the orientations with an axis along the line, the
/// one turned least from both ends is taken. Returns nothing if a narrow place was not passed, if
/// there is none, or if the orientation policy limits orientations. Deterministic, unless the
/// deadline strikes.
std::vector<NarrowPassage> narrow_passages(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                                           const motion::SignedPose& from,
                                           const motion::SignedPose& to,
                                           std::span<const motion::Pose> interpolated,
                                           double margin_m, const base::Deadline& deadline);

}  // namespace camway::correction
