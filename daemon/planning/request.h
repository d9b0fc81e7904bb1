// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/correction/path/constraints.h"
#include "daemon/geometry/bounds.h"
#include "daemon/motion/body/body.h"
#include "daemon/motion/path/keyframe.h"

namespace camway::planning {

/// How a colliding path is corrected.
enum class Method {
  kLadder,             ///< move, turn or go round, whichever succeeds first (design, section 7)
  kKeyframeInsertion,  ///< the seed's: Ptacek & Johnstone 2006, section 4
};

std::string_view to_string(Method method);
std::optional<Method> method_from_string(std::string_view text);

/// What a request may ask for. Every default works.
struct PlanOptions {
  Method method = Method::kLadder;
  /// Planning stops at this and answers `timeout` with what it has; the check of that may take a
  /// second more. [Limit: 0 < value] [Units: seconds]
  double deadline_s = 10.0;
  /// How far the tessellated swept surface may stray from the true one.
  /// [Limit: kLeastChordError_m <= value] [Units: metres]
  double chord_error_m = 0.005;
  /// To how much motion of a corner the ends of collision intervals are bracketed.
  /// [Limit: kLeastIntervalTolerance_m <= value] [Units: metres]
  double interval_tolerance_m = 1e-3;
  /// How far the body has to stay from the scene; nearer is a collision.
  /// [Limit: 0 <= value <= kMaxCoordinate_m] [Units: metres]
  double clearance_m = 0.0;
  /// What no point of the body may leave, beside the bounds of the scene. `clearance_m` is about
  /// the scene alone. [Limit: finite ones are below kMaxCoordinate_m; min < max]
  geometry::Bounds bounds = {};
  /// Cut-off of the correction, per request. With 0 nothing is corrected: neither the path nor, by
  /// `max_shrink`, the camera. Keyframes are repaired and times moved all the same, if that was
  /// asked for. [Limit: 0 <= value]
  std::int32_t max_inserted_keyframes = 2000;
  correction::Objective objective = correction::Objective::kClosest;
  correction::OrientationPolicy orientation;
  correction::MotionLimits limits;
  /// Where nothing else helps, the near distance may be made smaller by up to this share; cameras
  /// only. [Limit: 0 <= value < 1]
  double max_shrink = 0.0;
  /// Given keyframes that collide are moved to the nearest free pose instead of being refused.
  bool repair_keyframes = false;
  std::uint64_t seed = 1;  ///< of the searches for ways round [Limit: 1 <= value]
  /// Speed of the chords where times are derived; without it motion::kNominalSpeed_m_per_s. Refused
  /// where keyframes have times. [Limit: kLeastDefaultSpeed_m_per_s <= value <=
  /// kMostDefaultSpeed_m_per_s]
  std::optional<double> default_speed_m_per_s;

  bool operator==(const PlanOptions&) const = default;
};

/// Returns how the sender of a request spells the member at a path in it. Paths have the names of
/// the structs here, without units: "camera.fov_x", "keyframes[3].time", "options.limits.speed".
using FieldSpelling = std::function<std::string(std::string_view path)>;

/// The input of planning, whoever asked: daemon, command line or replay.
struct PlanRequest {
  std::string scene;  ///< id or path; planning itself only echoes it
  motion::Camera camera;
  /// What moves, if it is not the near quadrilateral of `camera`.
  std::optional<motion::BodyShape> body;
  std::vector<motion::Keyframe> keyframes;
  bool has_times = false;  ///< false: `keyframes[i].time_s` mean nothing yet and are derived
  PlanOptions options;
  /// For messages about the request. Empty: paths stay as they are.
  FieldSpelling spelling = {};

  /// The member at `path` as the sender spells it.
  [[nodiscard]] std::string name_of(std::string_view path) const;
};

/// Whether the near distance may be made smaller: that corrects a path, and a camera alone has one.
bool may_shrink(const PlanRequest& request);

/// The unit vector in the direction of `vector`, of any length. A unit vector, as far as doubles
/// can tell, keeps its bits; what is zero or not finite comes back as it is, for `validate` to
/// refuse.
geometry::Vec3 direction_of(const geometry::Vec3& vector);

/// How far the computed squared length of a unit vector may be from 1. With u = eps / 2: computing
/// a squared length is off by 3 u (three squares, two sums), its root by 2.5 u, so a normalised
/// vector is by 3.5 u, its square by 7 u, and computing that adds 3 u.
inline constexpr double kUnitLengthError = 5 * 2.220446049250313e-16;

/// Why a request cannot be planned at all.
struct InvalidRequest {
  std::string field;                    ///< its path (`FieldSpelling`), "keyframes[3].orientation"
  std::optional<std::size_t> keyframe;  ///< index from 0, where one keyframe is at fault
  std::string reason;                   ///< what is wrong with the field
  std::string message;                  ///< the field as the sender spells it, and the reason
};

/// Checks everything that can be checked without the scene: counts, finiteness, quaternion length,
/// increasing times, camera and option ranges. Nothing if all is well.
std::optional<InvalidRequest> validate(const PlanRequest& request);

/// Largest numbers that a request may hold.
inline constexpr std::size_t kMaxKeyframes = 100'000;
inline constexpr double kMaxCoordinate_m = 1e9;  ///< doubles still resolve 0.1 micrometre there
/// Finer than this, tessellation takes seconds and tells nothing more: the check does not rest on
/// it.
inline constexpr double kLeastChordError_m = 1e-5;
inline constexpr double kLeastIntervalTolerance_m = 1e-9;  ///< rounding far from the origin
inline constexpr double kMaxTime_s = 1e10;                 ///< seconds since 1970 fit
/// Times closer than this share of their size leave too few digits for a parameter between them.
inline constexpr double kLeastRelativeTimeStep = 1e-12;
/// Times closer than this share of the whole path's duration ask for speeds that no number on the
/// way keeps digits of.
inline constexpr double kLeastTimeStepOfPath = 1e-9;
/// And times closer than this for rates, and their squares, beyond the range of numbers.
/// [Units: seconds]
inline constexpr double kLeastTimeStep_s = 1e-9;
/// Speeds at which times may be derived. Slower or faster ones are mistakes of units.
inline constexpr double kLeastDefaultSpeed_m_per_s = 1e-6;
inline constexpr double kMostDefaultSpeed_m_per_s = 1e6;
/// A shorter quaternion is meant to be zero, and its square would lose digits to underflow.
inline constexpr double kLeastQuaternionLength = 1e-100;

}  // namespace camway::planning
