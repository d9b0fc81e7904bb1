// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "daemon/motion/path/segment.h"

namespace camway::motion {

/// The pose at the middle of a stretch of a segment, and motion bounds about it.
struct Stretch {
  geometry::Vec3 eye_W;  ///< position of the eye, computed in doubles
  Eigen::Matrix3d R_WC;  ///< rotation from the body's frame to the world's, computed in doubles
  /// Bound of the eye's distance from `eye_W` anywhere on the stretch, without `travel_rounding_m`.
  /// [Units: metres]
  double travel_m = 0.0;
  /// Sine of half the largest turn from `R_WC`; 1 if the turn is not known. A turn by θ moves a
  /// point at radius ρ by at most the chord 2·ρ·sin(θ/2). [Limit: 0 <= value <= 1]
  double turn_sine = 0.0;
  /// First order of the motion. From the middle of the stretch to its end, the point `R_WC * x +
  /// eye_W` moves by `eye_step_W + turn_step_W.cross(R_WC * x)`; from the middle to the beginning,
  /// by the negative of that. `turn_step_W` is 0 if the turn is not bounded.
  geometry::Vec3 eye_step_W = geometry::Vec3::Zero();
  geometry::Vec3 turn_step_W = geometry::Vec3::Zero();
  /// Bounds of the deviation from the first order. `travel_bend_m`: of the eye, without
  /// `travel_rounding_m` [Units: metres]. `turn_bend`: of a point at radius 1, by the turn.
  double travel_bend_m = 0.0;
  double turn_bend = 0.0;
  /// `travel_rounding_m`: bound of the rounding of the eye's travel. `turn_rounding_sine`: the part
  /// of `turn_sine` that is rounding. Splitting a stretch reduces neither.
  double travel_rounding_m = 0.0;
  double turn_rounding_sine = 0.0;

  /// Returns the motion bound of a point x of the body within `radius_m` of the eye. Anywhere on
  /// the stretch, the place of the point by the segment's numbers in exact arithmetic is within
  /// this distance of `R_WC * x + eye_W` as computed in doubles. Not a number or infinite if the
  /// segment's numbers are too large. [Units: metres]
  [[nodiscard]] double reach_m(double radius_m) const;

  /// Returns a bound of the deviation from linear motion. At the fraction s of the stretch, the
  /// same point is within this distance of lerp(begin, end, s). Here begin and end are its places
  /// at the two ends to first order, as computed in doubles. The bound is of second order in the
  /// stretch's length. [Units: metres]
  [[nodiscard]] double bend_m(double radius_m) const;

  /// Returns the part of `reach_m` that is rounding; splitting the stretch does not reduce it.
  [[nodiscard]] double rounding_m(double radius_m) const;
};

/// Returns the stretch of a body that stands still at `pose`. Requires an orientation of unit
/// length.
Stretch standing_at(const Pose& pose);

/// A segment prepared for the motion bounds of many stretches. It holds the power series of both
/// curves about the middle of the segment, and shifts them to the middle of each stretch.
/// Thread-safe.
///
/// With P(m + s) = Σ Pₖ sᵏ and |s| <= h the eye strays by Σ_{k>0} |Pₖ| hᵏ at most. For the
/// orientation's four-vector Q(m + s) = Σ Qₖ sᵏ, let e be the direction of Q(m). Across e it has at
/// most Σ_{k>0} |Qₖ⊥| hᵏ, along e at least |Q₀| - Σ_{k>0} |Qₖ·e| hᵏ: the quotient bounds the
/// tangent of its angle a from Q(m). An angle a between quaternions is a rotation by 2a, so sin a
/// is the sine of half the turn. Nothing is sampled; in the limit of short stretches both bounds
/// are exact.
///
/// Deviation from the first order: of the eye, Σ_{k>1} |Pₖ| hᵏ. With e as above the turn from Q(m)
/// is the quaternion of direction (1, τ), τ = V/α, where Q(m + s) e* = (α, V): a rotation that
/// moves y by 2/(1 + τ²)·(τ×y + τ×(τ×y)). Let τ₁ = V₁s/|Q₀| be its first order and the step 2·τ₁×y.
/// With T, the bound of |τ| from above, and ε that of |τ - τ₁|, the difference is at most 2|y|·(ε +
/// T²·T + T²). From τ - τ₁ = (Σ_{k>1} Vₖsᵏ)/|Q₀| - τ·(α - |Q₀|)/|Q₀| follows ε <= (Σ_{k>1} |Qₖ⊥|hᵏ
/// + T·Σ_{k>0} |Qₖ·e|hᵏ)/|Q₀|.
///
/// All rounding is bounded below, relative to the *differences* of control points, and so does not
/// grow with the distance from the origin, except for the rounding of the eye's own coordinates.
class SegmentMotion {
 public:
  explicit SegmentMotion(const Segment& segment);

  /// Returns the stretch u0 <= u <= u1. Requires 0 <= u0 <= u1 <= 1.
  [[nodiscard]] Stretch around(double u0, double u1) const;

 private:
  void turn_around(Stretch& stretch, const std::array<geometry::Vec4, 7>& series,
                   double half_width) const;

  std::array<geometry::Vec3, 4> position_;     ///< series about 1/2, less `first_position_`
  std::array<geometry::Vec4, 7> orientation_;  ///< series about 1/2, less `first_orientation_`
  geometry::Vec3 first_position_;
  geometry::Vec4 first_orientation_;
  double position_rounding_m_ = 0.0;
  double orientation_rounding_ = 0.0;
};

}  // namespace camway::motion
