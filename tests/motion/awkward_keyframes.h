// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/motion/keyframe.h"

namespace camway::motion::test {

/// Keyframes with a difficulty.
struct AwkwardKeyframes {
  std::string name;
  std::vector<Keyframe> keyframes;
  /// How much more than a well-spaced motion this one amplifies rounding of its keyframes.
  double sensitivity = 1.0;
  bool has_half_turns = false;
};

/// One set for each difficulty that is known. Deterministic.
std::vector<AwkwardKeyframes> awkward_keyframes();

}  // namespace camway::motion::test
