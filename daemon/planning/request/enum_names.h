// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "daemon/correction/path/constraints.h"
#include "daemon/correction/path/correction.h"
#include "daemon/motion/path/keyframe.h"

/// Names in files of the enumerations that requests and answers have from other rooms, in order of
/// their values (`base::NamedEnum`).
namespace camway::motion {

constexpr std::array<std::string_view, 2> names_of(KeyframeOrigin) { return {"given", "inserted"}; }

}  // namespace camway::motion

namespace camway::correction {

constexpr std::array<std::string_view, 4> names_of(Objective) {
  return {"closest", "shortest", "smoothest", "safest"};
}

constexpr std::array<std::string_view, 4> names_of(OrientationRule) {
  return {"free", "keep", "level", "target"};
}

constexpr std::array<std::string_view, 5> names_of(CorrectionKind) {
  return {"none", "move", "turn", "go_round", "shrink"};
}

}  // namespace camway::correction
