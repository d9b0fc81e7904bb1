// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "daemon/motion/path/path.h"

namespace camway::motion {

/// Limits of speed, acceleration and turn rate. Infinity means no limit. [Limit: value > 0]
struct RateLimits {
  double speed_m_per_s = std::numeric_limits<double>::infinity();  ///< speed of the eye
  /// Acceleration of the eye.
  double acceleration_m_per_s2 = std::numeric_limits<double>::infinity();
  double turn_rate_rad_per_s = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool any() const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    return speed_m_per_s < kNone || acceleration_m_per_s2 < kNone || turn_rate_rad_per_s < kNone;
  }

  bool operator==(const RateLimits&) const = default;
};

/// The limits for a motion whose times are stretched by `factor` afterwards.
RateLimits stretched(const RateLimits& limits, double factor);

/// The factor by which all times must be stretched to meet the limits at `u` of `segment`; above 1
/// exactly if they are broken there. Speeds fall with the factor, accelerations with its square
/// (Hollerbach 1984, "Dynamic scaling of manipulator trajectories").
double needed_stretch(const Segment& segment, double u, const RateLimits& limits);

/// Whether the limits are met at every instant. Nothing is sampled: the margin to a limit is a
/// polynomial whose Bernstein coefficients are shown to be non-negative on short enough parts. For
/// the speed it is L² - |P'|²; for the turn rate L² |N|⁴ - 4 |N ∧ N'|², as N/|N| moves at the rate
/// |N ∧ N'| / |N|² and a rotation turns twice as fast. The acceleration of a cubic is largest at an
/// end. True is a proof, up to the rounding of these sums; false may also mean that a rate comes
/// within some millionths of its limit.
bool meets(const Segment& segment, const RateLimits& limits);
bool meets(const Path& path, const RateLimits& limits);

}  // namespace camway::motion
