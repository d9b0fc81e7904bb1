// SPDX-License-Identifier: MIT
#include "daemon/planning/request/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "daemon/motion/spline/knot_row.h"
#include "daemon/planning/request/option_table.h"
#include "daemon/planning/request/request.h"

namespace camway::planning {

namespace {

using motion::Keyframe;
using Fault = std::optional<InvalidRequest>;

static_assert(motion::kMaxBodyCoordinate_m == kMaxCoordinate_m);
static_assert(geometry::kMaxBound_m == kMaxCoordinate_m);
// Doubles about t are at least epsilon / 2 · t apart, so knots that corrections keep apart may be
// keyframes of a request.
static_assert(kLeastRelativeTimeStep <=
              0.5 * std::numeric_limits<double>::epsilon() * motion::kTimesBetweenKeyframes);

InvalidRequest invalid(std::string field, std::string_view reason,
                       std::optional<std::size_t> keyframe = std::nullopt) {
  return {std::move(field), keyframe, std::string(reason), {}};
}

/// Returns the unit of angles in the sender's names: radians where the name says so, as in
/// "cone_rad" and "turn_rate_rad_per_s", else degrees.
AngleUnit unit_of(const PlanRequest& request, std::string_view field) {
  const bool is_in_radians = request.name_of(field).find("_rad") != std::string::npos;
  return is_in_radians ? AngleUnit::kRadians : AngleUnit::kDegrees;
}

/// Returns an error if `value` is beyond the range of `spec`.
template <class Number>
Fault check_number(const PlanRequest& request, const std::string& group, const FieldSpec& spec,
                   Number value) {
  const auto number = static_cast<double>(value);
  if (!spec.range.any() || spec.range.holds(number)) return std::nullopt;
  const std::string field = group + std::string(spec.name);
  const AngleUnit unit = unit_of(request, field);
  const std::string said =
      std::is_integral_v<Number> ? fmt::format("{}", value) : spec.value_text(number, unit);
  const std::string range = spec.range_text(unit);
  return invalid(field, fmt::format("is {}; it must {} {}{}{}", said,
                                    range.starts_with("between") ? "lie" : "be", range,
                                    spec.unit.empty() ? "" : " ", spec.unit));
}

/// Returns whether a quaternion of this length is that of a rotation.
bool is_rotation(double length) {
  return length >= kLeastQuaternionLength && std::isfinite(length);
}

std::string no_rotation(double length) {
  return fmt::format("has length {:g}; a rotation needs a quaternion that is not zero", length);
}

/// A fault of a member of a keyframe. Its path is made for a fault alone, as a request may have
/// many keyframes.
InvalidRequest invalid_in(std::size_t index, std::string_view member, std::string_view reason) {
  return invalid(fmt::format("keyframes[{}].{}", index, member), reason, index);
}

Fault check_pose(const Keyframe& keyframe, std::size_t index) {
  const geometry::Vec3& position = keyframe.pose.position;
  if (!position.allFinite()) return invalid_in(index, "position", "is not finite");
  if (position.cwiseAbs().maxCoeff() > kMaxCoordinate_m) {
    return invalid_in(index, "position",
                      fmt::format("is more than {:g} m from the origin", kMaxCoordinate_m));
  }
  const geometry::Quat& orientation = keyframe.pose.orientation;
  if (!orientation.coeffs().allFinite()) return invalid_in(index, "orientation", "is not finite");
  if (is_rotation(orientation.norm())) return std::nullopt;
  return invalid_in(index, "orientation", no_rotation(orientation.norm()));
}

/// Checks the time of keyframe `index`, at least 1, against the one before.
Fault check_step(const std::vector<Keyframe>& keyframes, std::size_t index, double duration_s) {
  const double time_s = keyframes[index].time_s;
  const double previous_s = keyframes[index - 1].time_s;
  const double step_s = time_s - previous_s;
  if (!(step_s > 0.0)) {
    return invalid_in(index, "time",
                      fmt::format("is {} s, not after the {} s of keyframe {}; times must increase",
                                  time_s, previous_s, index - 1));
  }
  const double least_step_s = std::max(
      kLeastTimeStep_s, kLeastRelativeTimeStep * std::max(std::abs(time_s), std::abs(previous_s)));
  if (step_s < least_step_s) {
    return invalid_in(index, "time",
                      fmt::format("is only {:.4g} s after keyframe {}; times of that size must be "
                                  "{:.4g} s apart or more, for the precision of doubles",
                                  step_s, index - 1, least_step_s));
  }
  if (step_s < kLeastTimeStepOfPath * duration_s) {
    return invalid_in(
        index, "time",
        fmt::format("is only {:.2g} s after keyframe {}, too little for a path of {:.3g} s", step_s,
                    index - 1, duration_s));
  }
  return std::nullopt;
}

Fault check_times(const std::vector<Keyframe>& keyframes) {
  const double duration_s = keyframes.back().time_s - keyframes.front().time_s;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double time_s = keyframes[i].time_s;
    if (!std::isfinite(time_s) || std::abs(time_s) > kMaxTime_s) {
      return invalid_in(
          i, "time", fmt::format("is {}; it must be finite and within {:g} s", time_s, kMaxTime_s));
    }
    if (i == 0) continue;
    if (auto fault = check_step(keyframes, i, duration_s)) return fault;
  }
  return std::nullopt;
}

Fault check_image(const Keyframe& keyframe, std::size_t index, bool has_frame) {
  if (keyframe.image.isZero(0.0)) return std::nullopt;
  if (!has_frame) {
    return invalid_in(index, "image",
                      "counts only with a frame; copy that of the answer, too, or leave it out");
  }
  if (!keyframe.image.allFinite()) return invalid_in(index, "image", "is not finite");
  const double length = keyframe.image.norm();
  if (length >= kLeastImageLength && length <= kMostImageLength) return std::nullopt;
  return invalid_in(
      index, "image",
      fmt::format("has length {:g}; it must be from {:g} to {:g}, or the image left out", length,
                  kLeastImageLength, kMostImageLength));
}

/// Checks the derivatives at an end. `step_s` is the time to the next keyframe there.
Fault check_end(const std::string& field, const motion::PathEnd& end, double step_s) {
  const auto check = [&](const char* member, double rate, double most, std::string_view what) {
    // Also false for a rate that is no number.
    if (rate * step_s <= most) return Fault();
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
Fault check_frame(const PlanRequest& request) {
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
  const double length = frame.reference.norm();
  if (!is_rotation(length)) return invalid("frame.reference", no_rotation(length));
  const auto& keyframes = request.keyframes;
  const double first_s = keyframes[1].time_s - keyframes[0].time_s;
  if (auto fault = check_end("frame.begin", frame.begin, first_s)) return fault;
  const double last_s = keyframes.back().time_s - keyframes[keyframes.size() - 2].time_s;
  return check_end("frame.end", frame.end, last_s);
}

bool is_within_scenes(const geometry::Vec3& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

/// Visits the members of a struct, and keeps the first fault.
class FirstFault {
 public:
  FirstFault(const PlanRequest& request, std::string group)
      : request_(request), group_(std::move(group)) {}

  template <class Member>
  void operator()(const FieldSpec& spec, const Member& member) const {
    if (!fault_) fault_ = check(spec, member);
  }
  [[nodiscard]] Fault take() { return std::move(fault_); }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  [[nodiscard]] Fault check(const FieldSpec& spec, Number value) const {
    return check_number(request_, group_, spec, value);
  }
  [[nodiscard]] Fault check(const FieldSpec& spec, const std::optional<double>& value) const {
    return value ? check_number(request_, group_, spec, *value) : std::nullopt;
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

  const PlanRequest& request_;
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
  FirstFault members(request_, "options.orientation.");
  visit_table(members, policy);
  return members.take();
}

Fault FirstFault::check(const FieldSpec&, const correction::MotionLimits& limits) const {
  if (limits.may_retime && !limits.any()) {
    return invalid("options.limits.retime",
                   "has no limit beside it that the path could be slowed for");
  }
  FirstFault members(request_, "options.limits.");
  visit_table(members, limits);
  return members.take();
}

Fault check_camera(const PlanRequest& request) {
  FirstFault members(request, "camera.");
  visit_table(members, request.camera);
  if (auto fault = members.take()) return fault;
  // A field of view next to 180 degrees makes a quadrilateral that no scene holds.
  if (!(motion::body_radius_m(motion::near_corners_C(request.camera)) <= kMaxCoordinate_m)) {
    return invalid("camera", "its near quadrilateral is larger than any scene");
  }
  return std::nullopt;
}

/// Checks the body: the camera's near quadrilateral, or the shape in its place. With a shape the
/// camera may be left out (all zero); if it is there, it has to be valid.
Fault check_body(const PlanRequest& request) {
  const motion::Camera& camera = request.camera;
  const bool has_camera =
      camera.fov_x_rad != 0.0 || camera.fov_y_rad != 0.0 || camera.near_m != 0.0;
  if (has_camera || !request.body) {
    if (auto fault = check_camera(request)) return fault;
  }
  if (!request.body) return std::nullopt;
  const std::optional<motion::ShapeFault> fault = motion::fault_in(*request.body);
  if (!fault) return std::nullopt;
  return invalid(fault->field.empty() ? "body" : "body." + fault->field, fault->reason);
}

/// Checks each option by itself, then those that depend on other parts of the request.
Fault check_options(const PlanRequest& request) {
  const PlanOptions& options = request.options;
  FirstFault members(request, "options.");
  visit_table(members, options);
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

Fault find_fault(const PlanRequest& request) {
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
  Fault fault = find_fault(request);
  if (fault) fault->message = fmt::format("{}: {}", request.name_of(fault->field), fault->reason);
  return fault;
}

}  // namespace camway::planning
