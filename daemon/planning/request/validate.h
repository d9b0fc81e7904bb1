// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "daemon/planning/request/request.h"

namespace camway::planning {

/// Why a request cannot be planned at all.
struct InvalidRequest {
  std::string field;  ///< path of the member (`FieldSpelling`): "keyframes[3].orientation"
  std::optional<std::size_t> keyframe;  ///< index from 0, where one keyframe is at fault
  std::string reason;                   ///< what is wrong with the field
  std::string message;                  ///< the field as the sender spells it, with the reason
};

/// Checks everything that can be checked without the scene: counts, finiteness, quaternion length,
/// increasing times, camera and option ranges. Returns nothing if the request is valid.
std::optional<InvalidRequest> validate(const PlanRequest& request);

/// Largest numbers that a request may hold.
inline constexpr std::size_t kMaxKeyframes = 100'000;
inline constexpr double kMaxTime_s = 1e10;  ///< large enough for seconds since 1970
/// Least difference of consecutive times, as a share of their size: at least 64 times the distance
/// of doubles there, so that a correction finds room for four knots between them, 16 steps apart
/// (`motion::kLeastTimesAStep`). For seconds since 1970 that is 25 microseconds.
inline constexpr double kLeastRelativeTimeStep = 64 * std::numeric_limits<double>::epsilon();
/// Least difference of consecutive times, as a share of the duration of the path. A smaller one
/// needs speeds that lose all digits in later computations.
inline constexpr double kLeastTimeStepOfPath = 1e-9;
/// Least difference of consecutive times. With a smaller one rates, and their squares, leave the
/// range of doubles. [Units: seconds]
inline constexpr double kLeastTimeStep_s = 1e-9;
/// A shorter quaternion counts as zero; its square would lose digits to underflow.
inline constexpr double kLeastQuaternionLength = 1e-100;
/// Range of the length of an image (`motion::Keyframe::image`). Images of interpolated keyframes
/// have unit length, and corrections change that by less than a factor of ten.
inline constexpr double kLeastImageLength = 1e-3;
inline constexpr double kMostImageLength = 1e3;

}  // namespace camway::planning
