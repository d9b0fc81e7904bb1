// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/correction/path/candidate.h"

namespace camway::correction {

/// How a nudge changes poses.
enum class NudgeKind { kMove, kTurn };

/// Corrects a collision by one bump at its middle: it moves the camera a little to one side, or
/// turns it about the middle of the body. Directions are tried in the order of how far they
/// have to move the body there; and widths of the bump from the widest, which is the smoothest, to
/// what just covers the collision. Where there is a rule for orientations only turns within it are
/// tried, and a move turns the camera where it has to.
///
/// Source of the idea: the direction and depth of Ptacek & Johnstone 2006, section 4, which has one
/// direction, from the corners that are hit, and none for an orientation. Here directions come from
/// the contact and from a fan across the way, and how far is measured.
///
/// Nothing if no such bump is free.
std::optional<Candidate> nudge(const Problem& problem, NudgeKind kind, FreeSpace& space,
                               const collision::Deadline& deadline);

}  // namespace camway::correction
