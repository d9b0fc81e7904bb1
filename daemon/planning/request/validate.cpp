// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

#include "daemon/planning/request/request.h"

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

std::optional<InvalidRequest> check_length(std::string field, double length,
                                           std::optional<std::size_t> keyframe = std::nullopt) {
  if (length >= kLeastQuaternionLength && std::isfinite(length)) return std::nullopt;
  return invalid(
      std::move(field),
      fmt::format("has length {:g}; a rotation needs a quaternion that is not zero", length),
      keyframe);
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
  return check_length(orientation, keyframe.pose.orientation.norm(), index);
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

std::optional<InvalidRequest> check_image(const Keyframe& keyframe, std::size_t index,
                                          bool has_frame) {
  if (keyframe.image.isZero(0.0)) return std::nullopt;
  const std::string field = fmt::format("keyframes[{}].image", index);
  if (!has_frame) {
    return invalid(field, "counts only with a frame; copy that of the answer, too, or leave it out",
                   index);
  }
  if (!keyframe.image.allFinite()) return invalid(field, "is not finite", index);
  const double length = keyframe.image.norm();
  if (length >= kLeastImageLength && length <= kMostImageLength) return std::nullopt;
  return invalid(field,
                 fmt::format("has length {:g}; it must be from {:g} to {:g}, or the image left out",
                             length, kLeastImageLength, kMostImageLength),
                 index);
}

/// Checks the derivatives at an end. `step_s` is the time to the next keyframe there.
std::optional<InvalidRequest> check_end(const std::string& field, const motion::PathEnd& end,
                                        double step_s) {
  const auto check = [&](const char* member, double rate, double most, std::string_view what) {
    // Also false for a rate that is no number.
    if (rate * step_s <= most) return std::optional<InvalidRequest>();
    return std::optional(
        invalid(fmt::format("{}.{}", field, member),
                fmt::format("is {:g}; {} to the next keyframe, {:g} s away, must be at most {:g}",
                            rate, what, step_s, most)));
  };
  if (auto fault = check("velocity_m_per_s", end.velocity_m_per_s.norm(), kMaxCoordinate_m,
                         "the way in metres")) {
    return fault;
  }
  return check("image_rate_per_s", end.image_rate_per_s.norm(), kMostImageLength,
               "the change of the image");
}

/// Checks the frame. Requires valid keyframes.
std::optional<InvalidRequest> check_frame(const PlanRequest& request) {
  for (std::size_t i = 0; i < request.keyframes.size(); ++i) {
    if (auto fault = check_image(request.keyframes[i], i, request.frame.has_value())) return fault;
  }
  if (!request.frame) return std::nullopt;
  const motion::PathFrame& frame = *request.frame;
  if (!request.has_times)
    return invalid("frame", "needs a time in each keyframe, and none has one");
  if (request.options.method != Method::kLadder) {
    return invalid("frame", "does not go with the method keyframe_insertion, which has none");
  }
  if (auto fault = check_length("frame.reference", frame.reference.norm())) return fault;
  const auto& keyframes = request.keyframes;
  const double first_s = keyframes[1].time_s - keyframes[0].time_s;
  if (auto fault = check_end("frame.begin", frame.begin, first_s)) return fault;
  const double last_s = keyframes.back().time_s - keyframes[keyframes.size() - 2].time_s;
  return check_end("frame.end", frame.end, last_s);
}

bool is_within_scenes(const geometry::Vec3& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

using Fault = std::optional<InvalidRequest>;

/// Returns an error if `value` is beyond the range of `spec`.
template <class Number>
Fault check_number(const std::string& group, const FieldSpec& spec, Number value) {
  if (!spec.range.any() || spec.range.holds(static_cast<double>(value))) return std::nullopt;
  std::string said = fmt::format("{}", value);
  if (spec.is_angle()) {
    // In both units, as files have degrees and messages radians.
    const auto angle_rad = static_cast<double>(value);
    said = fmt::format("{:.6g} degrees ({:.6g} rad)", angle_rad * (180.0 / std::numbers::pi),
                       angle_rad);
  }
  if (!spec.unit.empty()) said += fmt::format(" {}", spec.unit);
  const std::string range = spec.range_text();
  return invalid(group + std::string(spec.name),
                 fmt::format("is {}; it must {} {}", said,
                             range.starts_with("between") ? "lie" : "be", range));
}

/// Visits the members of a struct, and keeps the first fault.
class FirstFault {
 public:
  explicit FirstFault(std::string group) : group_(std::move(group)) {}

  template <class Member>
  void operator()(const FieldSpec& spec, const Member& member) const {
    if (!fault_) fault_ = check(spec, member);
  }
  [[nodiscard]] Fault take() { return std::move(fault_); }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  [[nodiscard]] Fault check(const FieldSpec& spec, Number value) const {
    return check_number(group_, spec, value);
  }
  [[nodiscard]] Fault check(const FieldSpec& spec, const std::optional<double>& value) const {
    return value ? check_number(group_, spec, *value) : std::nullopt;
  }
  [[nodiscard]] Fault check(const FieldSpec& spec, const geometry::Bounds& bounds) const;
  [[nodiscard]] Fault check(const FieldSpec&, const correction::OrientationPolicy& policy) const;
  [[nodiscard]] Fault check(const FieldSpec&, const correction::MotionLimits& limits) const;
  /// Points and enumerations have no range.
  template <class Other>
  requires(!std::is_arithmetic_v<Other>) [[nodiscard]] Fault
      check(const FieldSpec&, const Other&) const {
    return std::nullopt;
  }

  std::string group_;
  mutable Fault fault_;
};

Fault FirstFault::check(const FieldSpec& spec, const geometry::Bounds& bounds) const {
  const auto fault = geometry::fault_in(bounds);
  if (!fault) return std::nullopt;
  return invalid(fmt::format("{}{}.{}", group_, spec.name, fault->field), fault->reason);
}

Fault FirstFault::check(const FieldSpec&, const correction::OrientationPolicy& policy) const {
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
  FirstFault members("options.orientation.");
  visit_orientation(members, policy);
  return members.take();
}

Fault FirstFault::check(const FieldSpec&, const correction::MotionLimits& limits) const {
  FirstFault members("options.limits.");
  visit_limits(members, limits);
  return members.take();
}

/// Checks each option by itself, then those that depend on other parts of the request.
std::optional<InvalidRequest> check_options(const PlanRequest& request) {
  const PlanOptions& options = request.options;
  FirstFault members("options.");
  visit_options(members, options);
  if (auto fault = members.take()) return fault;
  if (options.default_speed_m_per_s && request.has_times) {
    return invalid("options.default_speed_m_per_s",
                   "counts only where keyframes have no times, and these have");
  }
  if (options.max_shrink > 0.0 && moving_camera(request) == nullptr) {
    return invalid("options.max_shrink",
                   fmt::format("is {}, but the body is no camera: it has no near distance that "
                               "could be made smaller",
                               options.max_shrink));
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
  if (auto fault = check_frame(request)) return fault;
  return check_options(request);
}

}  // namespace

std::optional<InvalidRequest> validate(const PlanRequest& request) {
  std::optional<InvalidRequest> fault = find_fault(request);
  if (fault) fault->message = fmt::format("{}: {}", request.name_of(fault->field), fault->reason);
  return fault;
}

}  // namespace camway::planning
