// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/correction/path/candidate.h"
#include "daemon/correction/path/correction.h"

namespace camway::correction {

/// The kind of change that a nudge makes to poses.
enum class NudgeKind { kMove, kTurn };

struct NudgeResult {
  std::optional<Candidate> candidate;  ///< nothing if no nudge is free
  Effort effort;                       ///< effort spent
};

/// Corrects a collision by one bump at its middle, which moves the camera to one side or turns it
/// about the centre of the body. Measures, for a fan of directions or axes, the least amount that
/// frees the body at the collision, and tries the smallest one with bumps of decreasing width; a
/// wider bump is smoother. Further bumps keep the keyframes within the support. The orientation
/// policy limits turns, and may turn a camera that is moved.
///
/// Source of the idea: the direction and depth of Ptacek & Johnstone 2006, section 4. Deviations:
/// directions come from the contact and from a fan across the path, instead of one direction from
/// the corners that are hit; the amount is measured; orientations change as well.
NudgeResult nudge(const Problem& problem, NudgeKind kind, FreeSpace& space,
                  const base::Deadline& deadline);

}  // namespace camway::correction
