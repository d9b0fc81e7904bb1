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

/// Corrects a collision by a short row of bumps about it (`window.h`), which moves the camera to
/// one side or turns it about the centre of the body. Measures, for a fan of directions or axes,
/// the least amount that frees the body at the collision, tries the smallest of them as a row of
/// bumps, relaxes each that is free, which spends steps of `budget`, and returns the one of the
/// least cost (`closeness.h`). A moved camera keeps its orientation, unless the orientation policy
/// demands another.
///
/// Source of the idea: the direction and depth of Ptacek & Johnstone 2006, section 4. Deviations:
/// directions come from the contact and from a fan across the path, instead of one direction from
/// the corners that are hit; the amount is measured; orientations change as well.
///
/// `collisions`: the collisions to correct together, in order of time, within `problem.interval`.
NudgeResult nudge(const Problem& problem, std::span<const collision::CollisionInterval> collisions,
                  NudgeKind kind, base::Budget& budget, FreeSpace& space,
                  const base::Deadline& deadline);

}  // namespace camway::correction
