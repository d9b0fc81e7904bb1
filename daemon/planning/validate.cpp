// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

#include "daemon/planning/request.h"

namespace camway::planning {

namespace {

using motion::Keyframe;

static_assert(motion::kMaxBodyCoordinate_m == kMaxCoordinate_m);
static_assert(geometry::kMaxBound_m == kMaxCoordinate_m);

InvalidRequest invalid(std::string field, std::string_view reason,
                       std::optional<std::size_t> keyframe = std::nullopt) {
  return {std::move(field), keyframe, std::string(reason), {}};
}

std::optional<InvalidRequest> check_angle(std::string_view field, double angle_rad) {
  if (angle_rad > 0.0 && angle_rad < std::numbers::pi) return std::nullopt;
  return invalid(std::string(field),
                 fmt::format("is {} degrees ({} rad); it must lie between 0 and 180 degrees",
                             angle_rad * (180.0 / std::numbers::pi), angle_rad));
}

std::optional<InvalidRequest> check_camera(const motion::Camera& camera) {
  if (auto fault = check_angle("camera.fov_x", camera.fov_x_rad)) return fault;
  if (auto fault = check_angle("camera.fov_y", camera.fov_y_rad)) return fault;
  if (!(camera.near_m > 0.0) || !(camera.near_m <= kMaxCoordinate_m)) {
    return invalid("camera.near",
                   fmt::format("is {} m; it must be above 0 and finite", camera.near_m));
  }
  // A field of view next to 180 degrees makes a quadrilateral that no scene holds.
  if (!(motion::body_radius_m(motion::near_corners_C(camera)) <= kMaxCoordinate_m)) {
    return invalid("camera", "its near quadrilateral is larger than any scene");
  }
  return std::nullopt;
}

/// Checks the body: the camera's near quadrilateral, or the shape in its place. With a shape the
/// camera may be left out (all zero); if it is there, it has to be valid.
std::optional<InvalidRequest> check_body(const PlanRequest& request) {
  const motion::Camera& camera = request.camera;
  const bool has_camera =
      camera.fov_x_rad != 0.0 || camera.fov_y_rad != 0.0 || camera.near_m != 0.0;
  if (has_camera || !request.body) {
    if (auto fault = check_camera(camera)) return fault;
  }
  if (!request.body) return std::nullopt;
  const std::optional<motion::ShapeFault> fault = motion::fault_in(*request.body);
  if (!fault) return std::nullopt;
  return invalid(fault->field.empty() ? "body" : "body." + fault->field, fault->reason);
}

std::optional<InvalidRequest> check_pose(const Keyframe& keyframe, std::size_t index) {
  const std::string position = fmt::format("keyframes[{}].position", index);
  const std::string orientation = fmt::format("keyframes[{}].orientation", index);
  if (!keyframe.pose.position.allFinite()) return invalid(position, "is not finite", index);
  if (keyframe.pose.position.cwiseAbs().maxCoeff() > kMaxCoordinate_m) {
    return invalid(position, fmt::format("is more than {:g} m from the origin", kMaxCoordinate_m),
                   index);
  }
  if (!keyframe.pose.orientation.coeffs().allFinite()) {
    return invalid(orientation, "is not finite", index);
  }
  const double length = keyframe.pose.orientation.norm();
  if (!(length >= kLeastQuaternionLength) || !std::isfinite(length)) {
    return invalid(
        orientation,
        fmt::format("has length {:g}; a rotation needs a quaternion that is not zero", length),
        index);
  }
  return std::nullopt;
}

std::optional<InvalidRequest> check_times(const std::vector<Keyframe>& keyframes) {
  const double duration_s = keyframes.back().time_s - keyframes.front().time_s;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double time_s = keyframes[i].time_s;
    const std::string field = fmt::format("keyframes[{}].time", i);
    if (!std::isfinite(time_s) || std::abs(time_s) > kMaxTime_s) {
      return invalid(
          field, fmt::format("is {}; it must be finite and within {:g} s", time_s, kMaxTime_s), i);
    }
    if (i == 0) continue;
    const double previous_s = keyframes[i - 1].time_s;
    const double least_step_s =
        kLeastRelativeTimeStep * std::max(std::abs(time_s), std::abs(previous_s));
    if (!(time_s - previous_s > least_step_s)) {
      return invalid(field,
                     fmt::format("is {} s, not after the {} s of keyframe {}; times must increase",
                                 time_s, previous_s, i - 1),
                     i);
    }
    if (time_s - previous_s < kLeastTimeStep_s) {
      return invalid(field,
                     fmt::format("is only {:.2g} s after keyframe {}; it must be {:g} s or more",
                                 time_s - previous_s, i - 1, kLeastTimeStep_s),
                     i);
    }
    if (time_s - previous_s < kLeastTimeStepOfPath * duration_s) {
      return invalid(
          field,
          fmt::format("is only {:.2g} s after keyframe {}, too little for a path of {:.3g} s",
                      time_s - previous_s, i - 1, duration_s),
          i);
    }
  }
  return std::nullopt;
}

bool is_within_scenes(const geometry::Vec3& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

std::optional<InvalidRequest> check_orientation(const correction::OrientationPolicy& policy) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  // Directions are brought to unit length where requests come in, unless they are zero or not
  // finite.
  if (!(std::abs(policy.up_W.squaredNorm() - 1.0) <= kUnitLengthError)) {
    return invalid("options.orientation.up",
                   fmt::format("has length {:g}, which is no direction", policy.up_W.norm()));
  }
  if (!is_within_scenes(policy.target_W)) {
    return invalid("options.orientation.target",
                   fmt::format("must be finite and within {:g} m", kMaxCoordinate_m));
  }
  if (!(policy.cone_rad > 0.0 && policy.cone_rad <= std::numbers::pi)) {
    return invalid("options.orientation.cone",
                   fmt::format("is {:.6g} degrees; it must be above 0 and at most 180 degrees",
                               policy.cone_rad * kDegrees));
  }
  if (!(policy.max_turn_rad >= 0.0 && policy.max_turn_rad <= std::numbers::pi)) {
    return invalid("options.orientation.max_turn",
                   fmt::format("is {:.6g} degrees; it must lie between 0 and 180 degrees",
                               policy.max_turn_rad * kDegrees));
  }
  return std::nullopt;
}

/// Infinity means no limit.
std::optional<InvalidRequest> check_limits(const correction::MotionLimits& limits) {
  const std::pair<const char*, double> members[] = {
      {"options.limits.speed", limits.speed_m_per_s},
      {"options.limits.acceleration", limits.acceleration_m_per_s2},
      {"options.limits.turn_rate", limits.turn_rate_rad_per_s}};
  for (const auto& [field, value] : members) {
    if (!(value > 0.0)) return invalid(field, fmt::format("is {}; it must be above 0", value));
  }
  return std::nullopt;
}

bool moves_a_camera(const PlanRequest& request) {
  return !request.body || std::holds_alternative<motion::Camera>(*request.body);
}

/// Checks the options of corrections.
std::optional<InvalidRequest> check_correction(const PlanRequest& request) {
  const PlanOptions& options = request.options;
  if (auto fault = check_orientation(options.orientation)) return fault;
  if (auto fault = check_limits(options.limits)) return fault;
  if (!(options.max_shrink >= 0.0 && options.max_shrink < 1.0)) {
    return invalid("options.max_shrink",
                   fmt::format("is {}; it must be at least 0 and below 1", options.max_shrink));
  }
  if (options.max_shrink > 0.0 && !moves_a_camera(request)) {
    return invalid("options.max_shrink",
                   fmt::format("is {}, but the body is no camera: it has no near distance that "
                               "could be made smaller",
                               options.max_shrink));
  }
  if (options.seed == 0) return invalid("options.seed", "is 0; it must be at least 1");
  return std::nullopt;
}

/// Checks the speed from which times are derived.
std::optional<InvalidRequest> check_speed(const PlanRequest& request) {
  constexpr char kField[] = "options.default_speed";
  const std::optional<double>& speed_m_per_s = request.options.default_speed_m_per_s;
  if (!speed_m_per_s) return std::nullopt;
  if (!(*speed_m_per_s >= kLeastDefaultSpeed_m_per_s &&
        *speed_m_per_s <= kMostDefaultSpeed_m_per_s)) {
    return invalid(kField, fmt::format("is {} m/s; it must be from {:g} to {:g}", *speed_m_per_s,
                                       kLeastDefaultSpeed_m_per_s, kMostDefaultSpeed_m_per_s));
  }
  if (!request.has_times) return std::nullopt;
  return invalid(kField, "counts only where keyframes have no times, and these have");
}

std::optional<InvalidRequest> check_options(const PlanOptions& options) {
  const auto at_least = [](std::string_view field, double value,
                           double least) -> std::optional<InvalidRequest> {
    if (value >= least && std::isfinite(value)) return std::nullopt;
    return invalid(std::string(field),
                   fmt::format("is {}; it must be at least {:g} and finite", value, least));
  };
  const auto positive = [](std::string_view field, double value) -> std::optional<InvalidRequest> {
    if (value > 0.0 && std::isfinite(value)) return std::nullopt;
    return invalid(std::string(field), fmt::format("is {}; it must be above 0 and finite", value));
  };
  if (auto fault = positive("options.deadline_s", options.deadline_s)) return fault;
  if (auto fault = at_least("options.chord_error_m", options.chord_error_m, kLeastChordError_m)) {
    return fault;
  }
  if (auto fault = at_least("options.interval_tolerance_m", options.interval_tolerance_m,
                            kLeastIntervalTolerance_m)) {
    return fault;
  }
  if (auto fault = at_least("options.clearance", options.clearance_m, 0.0)) return fault;
  if (options.clearance_m > kMaxCoordinate_m) {
    return invalid("options.clearance", fmt::format("is {}; it must be at most {:g}",
                                                    options.clearance_m, kMaxCoordinate_m));
  }
  if (const auto fault = geometry::fault_in(options.bounds))
    return invalid("options.bounds." + fault->field, fault->reason);
  if (options.max_inserted_keyframes < 0) {
    return invalid("options.max_inserted_keyframes",
                   fmt::format("is {}; it must be at least 0", options.max_inserted_keyframes));
  }
  return std::nullopt;
}

std::optional<InvalidRequest> find_fault(const PlanRequest& request) {
  if (auto fault = check_body(request)) return fault;
  const std::size_t count = request.keyframes.size();
  if (count < 2 || count > kMaxKeyframes) {
    return invalid("keyframes",
                   fmt::format("holds {}; a path needs 2 to {}", count, kMaxKeyframes));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (auto fault = check_pose(request.keyframes[i], i)) return fault;
  }
  if (request.has_times) {
    if (auto fault = check_times(request.keyframes)) return fault;
  }
  if (auto fault = check_options(request.options)) return fault;
  if (auto fault = check_speed(request)) return fault;
  return check_correction(request);
}

}  // namespace

std::optional<InvalidRequest> validate(const PlanRequest& request) {
  std::optional<InvalidRequest> fault = find_fault(request);
  if (fault) fault->message = fmt::format("{}: {}", request.name_of(fault->field), fault->reason);
  return fault;
}

}  // namespace camway::planning
