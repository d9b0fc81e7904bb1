// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "daemon/base/budget.h"
#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/correction.h"

namespace camway::correction {

/// The kind of change that a nudge makes to poses.
enum class NudgeKind { kMove, kTurn };

struct NudgeResult {
  std::optional<Candidate> candidate;  ///< nothing if no nudge is free
  Effort effort;                       ///< effort spent
};

/// Corrects a collision by a short row of bumps about it (`window.h`) that moves the body to one
/// side or turns it about its centre.
/// 1. Measures, for a fan of directions or axes, the least amount that frees the body at the
///    collision (`NudgeSearch`).
/// 2. Tries the smallest of them as rows of bumps.
/// 3. Relaxes each row that is free; this spends steps of `budget`.
/// 4. Returns the row of least cost (`closeness.h`).
///
/// A moved body keeps its orientation, unless the orientation policy demands another. If the
/// deadline strikes, returns the best row found so far, or none.
///
/// Source of the idea: the direction and depth of Ptacek & Johnstone 2006, section 4. Deviations:
/// directions come from the contact and from a fan across the path, instead of one direction from
/// the corners that are hit; the amount is measured; orientations change as well.
///
/// `collisions`: the collisions to correct together, in order of time, within `problem.interval`.
/// `space`: checks poses and paths; its body and scene are those of the problem.
///
/// Not thread-safe: uses the buffers of `space`.
NudgeResult nudge(const Problem& problem, std::span<const collision::CollisionInterval> collisions,
                  NudgeKind kind, base::Budget& budget, FreeSpace& space,
                  const base::Deadline& deadline);

}  // namespace camway::correction
