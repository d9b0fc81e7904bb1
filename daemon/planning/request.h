// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/motion/body/body.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/planning/options.h"

namespace camway::planning {

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
inline constexpr double kMaxTime_s = 1e10;  ///< seconds since 1970 fit
/// Times closer than this share of their size leave too few digits for a parameter between them.
inline constexpr double kLeastRelativeTimeStep = 1e-12;
/// Times closer than this share of the whole path's duration ask for speeds that no number on the
/// way keeps digits of.
inline constexpr double kLeastTimeStepOfPath = 1e-9;
/// And times closer than this for rates, and their squares, beyond the range of numbers.
/// [Units: seconds]
inline constexpr double kLeastTimeStep_s = 1e-9;
/// A shorter quaternion is meant to be zero, and its square would lose digits to underflow.
inline constexpr double kLeastQuaternionLength = 1e-100;

}  // namespace camway::planning
