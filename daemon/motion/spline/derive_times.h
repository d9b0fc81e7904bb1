// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "daemon/motion/path/keyframe.h"

namespace camway::motion {

/// Nominal rates of derived times. A step takes the time of its chord at this speed, unless another
/// is given, and of its turning angle at this rate, combined as the two legs of a right triangle.
inline constexpr double kNominalSpeed_m_per_s = 1.0;
inline constexpr double kNominalTurnRate_rad_per_s = 1.0;

/// Least duration of a step, as a share of the mean step; repeated poses get it.
inline constexpr double kShortestStep = 0.01;

/// Duration of each step if no pose differs from the next.
inline constexpr double kStepWithoutMotion_s = 1.0;

/// Derives times for poses without times: chord length (Farin 2002, section 9.6), blended with the
/// turning angle, so that turning on the spot and repeated poses take time. The times start at 0
/// and increase strictly. Deviation from chord length alone: the turning angle and the floor
/// `kShortestStep`. `speed_m_per_s` is the speed along the chords. Requires at least two poses and
/// 0 < speed_m_per_s.
std::vector<double> derive_times_s(std::span<const Pose> poses,
                                   double speed_m_per_s = kNominalSpeed_m_per_s);

}  // namespace camway::motion
