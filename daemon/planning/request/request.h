// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/motion/body/body.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/spline/path_frame.h"
#include "daemon/planning/request/options.h"

namespace camway::planning {

/// Returns how the sender of a request spells the member at a path. A path consists of the names of
/// the members of these structs, mostly without units: "camera.fov_x", "keyframes[3].time",
/// "options.limits.turn_rate".
using FieldSpelling = std::function<std::string(std::string_view path)>;

/// The input of planning, the same for daemon, command line and replay.
struct PlanRequest {
  std::string scene;  ///< id or path; not used by planning itself
  motion::Camera camera;
  /// The body, if it is not the near quadrilateral of `camera`.
  std::optional<motion::BodyShape> body;
  std::vector<motion::Keyframe> keyframes;
  bool has_times = false;  ///< false: `keyframes[i].time_s` are ignored, and times are derived
  /// The frame of an answer whose keyframes these are, as they were or edited. Without it the
  /// interpolation chooses its own. Requires `has_times`.
  std::optional<motion::PathFrame> frame = {};
  PlanOptions options;
  /// Spelling of paths in messages about the request. If empty, paths stay as they are.
  FieldSpelling spelling = {};

  /// Returns the member at `path` as the sender spells it.
  [[nodiscard]] std::string name_of(std::string_view path) const;
};

/// Returns the camera whose near quadrilateral is the body: `PlanRequest::camera`, or the camera
/// that `PlanRequest::body` holds. Returns null if the body is another shape.
const motion::Camera* moving_camera(const PlanRequest& request);
motion::Camera* moving_camera(PlanRequest& request);

/// Returns the shape of the body. The near distance of a camera is multiplied by `near_scale`.
motion::BodyShape body_shape(const PlanRequest& request, double near_scale = 1.0);

/// Returns whether the near distance may be reduced: `max_shrink` is above 0, the body is a camera,
/// and correction is on.
bool may_shrink(const PlanRequest& request);

/// Returns the unit vector in the direction of `vector`, which may have any length. A vector whose
/// squared length is 1 within `kUnitLengthError` is returned bit for bit, and so is one that is
/// zero or not finite, which `validate` refuses.
geometry::Vec3 direction_of(const geometry::Vec3& vector);
/// Returns the unit quaternion, w, x, y, z, in the direction of `wxyz` in the same way.
geometry::Vec4 direction_of(const geometry::Vec4& wxyz);

/// Largest difference between 1 and the computed squared length of a unit vector. With u = eps / 2:
/// a computed squared length is off by 3 u (three squares, two sums), its root by 2.5 u, so a
/// normalised vector is off by 3.5 u, its square by 7 u, and computing that square adds 3 u.
/// Rounding the four coefficients of a unit quaternion changes the squared length by at most 2 eps,
/// and computing it (four squares, three sums) by at most 2.5 eps, so the bound holds for that,
/// too.
inline constexpr double kUnitLengthError = 5 * std::numeric_limits<double>::epsilon();

}  // namespace camway::planning
