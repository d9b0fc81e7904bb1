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

/// Returns the limits that a motion must meet now, so that it meets `limits` after its times are
/// multiplied by `factor`. [Limit: 0 < factor]
RateLimits scaled_limits(const RateLimits& limits, double factor);

/// For each limit the least factor that all times must be multiplied by to meet it. It is above 1
/// exactly if the limit is broken; it may be anything from 0 on. Speed and turn rate fall with the
/// factor, acceleration with its square (Hollerbach 1984, "Dynamic scaling of manipulator
/// trajectories").
struct SlowDowns {
  double speed = 0.0;
  double acceleration = 0.0;
  double turn_rate = 0.0;

  /// The least factor by which all limits are met.
  [[nodiscard]] double largest() const;
};

/// Returns what the limits need at parameter `u` of `segment`. [Limit: 0 <= u <= 1]
SlowDowns slow_downs(const Segment& segment, double u, const RateLimits& limits);
/// Returns the largest of these.
double needed_slow_down(const Segment& segment, double u, const RateLimits& limits);

/// Returns true only if the limits are shown to hold for every u in [0, 1]. False may also mean
/// that a rate comes within some millionths of its limit.
///
/// Nothing is sampled: the margin to a limit is a polynomial whose Bernstein coefficients are shown
/// to be non-negative on short enough parts. P is the position, N the orientation curve before
/// normalisation, ' the derivative by u, L the limit times the duration.
/// - Speed: the margin is L² - |P'|².
/// - Turn rate: the margin is L² |N|⁴ - 4 |N ∧ N'|², because N/|N| moves at the rate
///   |N ∧ N'| / |N|² and a rotation turns twice as fast.
/// - Acceleration: that of a cubic is largest at an end, and is compared there.
///
/// The rounding of these sums is not bounded.
bool meets(const Segment& segment, const RateLimits& limits);
/// Returns whether `meets` is true for each segment of `path`.
bool meets(const Path& path, const RateLimits& limits);

}  // namespace camway::motion
