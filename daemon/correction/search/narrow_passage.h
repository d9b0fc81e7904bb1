// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/correction/path/free_space.h"

namespace camway::correction {

/// A straight motion of the body through a place of a way where its ball does not fit.
struct NarrowPassage {
  motion::SignedPose before;
  motion::SignedPose after;
  std::size_t first = 0;  ///< point of the way before the narrow place
  std::size_t last = 0;   ///< and the one after it
};

/// How the body, turned as suits best, gets through each narrow place of `way_W`, a way for
/// something smaller, from the beginning to the end: what searches by random poses hardly ever
/// meet, as a plate passes a hole little wider than its short side in few orientations only. From
/// the tightest point of such a place a straight line is grown to where it has the most room; the
/// body is put there, or in the middle of what is free beside, with an axis of its own along the
/// line, turned about it step by step, and moved along it to both sides. Motions are proved free
/// with `margin_m` beside what is required.
///
/// `from` and `to` are the poses at the ends: of all that fit, the one that is turned least from
/// both is taken. Nothing where one of the places was not passed, where there is none, or where a
/// rule limits orientations. Deterministic.
std::vector<NarrowPassage> narrow_passages(FreeSpace& space, std::span<const geometry::Vec3> way_W,
                                           const motion::SignedPose& from,
                                           const motion::SignedPose& to, double margin_m,
                                           const collision::Deadline& deadline);

}  // namespace camway::correction
