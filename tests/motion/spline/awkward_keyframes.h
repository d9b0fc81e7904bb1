// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "daemon/motion/path/keyframe.h"

namespace camway::motion::test {

/// Keyframes with a particular difficulty.
struct AwkwardKeyframes {
  std::string name;
  std::vector<Keyframe> keyframes;
  bool has_half_turns = false;
};

inline constexpr std::uint64_t kAwkwardSeed = 60;

/// Prints a parameter for GoogleTest.
inline void PrintTo(const AwkwardKeyframes& set, std::ostream* out) {
  *out << set.name << ", seed " << kAwkwardSeed;
}

/// Returns one set for each known difficulty. Deterministic.
std::vector<AwkwardKeyframes> awkward_keyframes();

}  // namespace camway::motion::test
