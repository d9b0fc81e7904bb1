// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <string>
#include <string_view>

#include "daemon/correction/path/constraints.h"
#include "daemon/geometry/bounds.h"
#include "daemon/motion/body/camera.h"
#include "daemon/planning/request/field_spec.h"
#include "daemon/planning/request/options.h"

namespace camway::planning {

/// Descriptions of the options of a request.
namespace option {

inline constexpr FieldSpec kMethod{
    .name = "method",
    .help =
        "how a colliding path is corrected: `ladder` (move, go round or turn, so that the picture "
        "shifts little) or `keyframe_insertion` (the paper's method)"};
inline constexpr FieldSpec kDeadline{
    .name = "deadline_s",
    .range = {.least = 0.0, .excludes_least = true, .excludes_infinity = true},
    .help = "seconds after which planning ends and answers `timeout` with what is proved"};
inline constexpr FieldSpec kClearance{
    .name = "clearance_m",
    .old_file = "clearance",
    .range = {.least = 0.0, .most = kMaxCoordinate_m},
    .help = "least distance between body and scene; less counts as a collision"};
inline constexpr FieldSpec kChordError{
    .name = "chord_error_m",
    .range = {.least = kLeastChordError_m, .excludes_infinity = true},
    .help =
        "only for the method `keyframe_insertion`: largest distance of the tessellated swept "
        "surface from the true one"};
inline constexpr FieldSpec kIntervalTolerance{
    .name = "interval_tolerance_m",
    .range = {.least = kLeastIntervalTolerance_m, .most = kMostIntervalTolerance_m},
    .help =
        "accuracy of the ends of collision intervals, as a distance: no point of the body moves "
        "farther between the true and the reported end; for bodies below a centimetre use a "
        "hundredth of their size"};
inline constexpr FieldSpec kMaxInsertedKeyframes{
    .name = "max_inserted_keyframes",
    .range = {.least = 0.0},
    .help =
        "most inserted keyframes of an answer, with those that the interpolation needs where a "
        "corrected path turns far; 0 corrects and shrinks nothing, and repairs keyframes all the "
        "same"};
inline constexpr FieldSpec kObjective{
    .name = "objective", .help = "what corrected stretches are improved for", .has_section = true};
inline constexpr FieldSpec kOrientation{.name = "orientation",
                                        .unset = R"({"policy": "free"})",
                                        .help = "what a correction may do to the orientation",
                                        .has_section = true};
inline constexpr FieldSpec kLimits{.name = "limits",
                                   .unset = "none",
                                   .help = "limits on speed, acceleration and turn rate",
                                   .has_section = true};
inline constexpr FieldSpec kBounds{
    .name = "bounds",
    .unset = "none",
    .help = R"(`{"min": [x, y, z], "max": [x, y, z]}`: a box that no point of the body may leave)",
    .has_section = true};
inline constexpr FieldSpec kMaxShrink{
    .name = "max_shrink",
    .range = {.least = 0.0, .most = 1.0, .excludes_most = true},
    .help =
        "the largest share by which the near distance may shrink if nothing else helps: 0.3 allows "
        "70 % of it. Cameras only. Above 0, half of the deadline is reserved for smaller cameras"};
inline constexpr FieldSpec kRepairKeyframes{
    .name = "repair_keyframes",
    .help = "move a given keyframe that collides to the nearest free pose, instead of refusing it"};
inline constexpr FieldSpec kClearanceProfile{
    .name = "clearance_profile",
    .help =
        "add the proved clearance of each stretch of the path to the answer, as "
        "`clearance_profile`"};
inline constexpr FieldSpec kSeed{.name = "seed",
                                 .range = {.least = 1.0},
                                 .help = "seed of the random numbers in searches for ways round"};
inline constexpr FieldSpec kDefaultSpeed{
    .name = "default_speed_m_per_s",
    .unit = "m/s",
    .range = {.least = kLeastDefaultSpeed_m_per_s, .most = kMostDefaultSpeed_m_per_s},
    .unset = "1",
    .help = "speed between keyframes without times; refused beside times"};
inline constexpr FieldSpec kViewingDistance{
    .name = "viewing_distance_m",
    .range = {.least = 0.0, .most = kMaxCoordinate_m, .excludes_least = true},
    .unset = "from the scene",
    .help =
        "distance of what the picture shows: a correction that moves the camera by a metre shifts "
        "the picture as much as a turn by 1 / viewing_distance_m radians"};

inline constexpr FieldSpec kPolicy{.name = "policy"};
inline constexpr FieldSpec kUp{.name = "up"};
inline constexpr FieldSpec kTarget{.name = "target", .wire = "target_m"};
inline constexpr FieldSpec kCone{
    .name = "cone",
    .wire = "cone_rad",
    .file = "cone_deg",
    .range = {.least = 0.0, .most = std::numbers::pi, .excludes_least = true}};
inline constexpr FieldSpec kMaxTurn{
    .name = "max_turn",
    .wire = "max_turn_rad",
    .file = "max_turn_deg",
    .range = {.least = 0.0, .most = std::numbers::pi},
    .help = "largest angle by which a correction may turn the camera, in degrees"};

}  // namespace option

/// Calls `visit(spec, member, wire...)` for each option, in the order of request files. Each `wire`
/// is a struct with members of the same names: the request of the wire or that of the client.
template <class Visit, class... Wire>
void visit_table(const Visit& visit, Is<PlanOptions> auto& options, Wire&... wire) {
  visit(option::kMethod, options.method, wire.method...);
  visit(option::kDeadline, options.deadline_s, wire.deadline_s...);
  visit(option::kClearance, options.clearance_m, wire.clearance_m...);
  visit(option::kChordError, options.chord_error_m, wire.chord_error_m...);
  visit(option::kIntervalTolerance, options.interval_tolerance_m, wire.interval_tolerance_m...);
  visit(option::kMaxInsertedKeyframes, options.max_inserted_keyframes,
        wire.max_inserted_keyframes...);
  visit(option::kObjective, options.objective, wire.objective...);
  visit(option::kOrientation, options.orientation, wire.orientation...);
  visit(option::kLimits, options.limits, wire.limits...);
  visit(option::kBounds, options.bounds, wire.bounds...);
  visit(option::kMaxShrink, options.max_shrink, wire.max_shrink...);
  visit(option::kRepairKeyframes, options.repair_keyframes, wire.repair_keyframes...);
  visit(option::kClearanceProfile, options.clearance_profile, wire.clearance_profile...);
  visit(option::kSeed, options.seed, wire.seed...);
  visit(option::kDefaultSpeed, options.default_speed_m_per_s, wire.default_speed_m_per_s...);
  visit(option::kViewingDistance, options.viewing_distance_m, wire.viewing_distance_m...);
}

/// Visits the members of an orientation policy as `visit_table` visits options.
template <class Visit>
void visit_table(const Visit& visit, Is<correction::OrientationPolicy> auto& policy) {
  visit(option::kPolicy, policy.rule);
  visit(option::kUp, policy.up_W);
  visit(option::kTarget, policy.target_W);
  visit(option::kCone, policy.cone_rad);
  visit(option::kMaxTurn, policy.max_turn_rad);
}

/// Calls `visit(spec, member, wire...)` for those members of an orientation policy that its rule
/// uses. `wire` is the message.
template <class Visit, class Policy, class... Wire>
void visit_used(const Visit& visit, Policy& policy, Wire&... wire) {
  using correction::OrientationRule;
  visit(option::kPolicy, policy.rule, wire.policy...);
  if (policy.rule == OrientationRule::kLevel) visit(option::kUp, policy.up_W, wire.up...);
  if (policy.rule == OrientationRule::kTarget) {
    visit(option::kTarget, policy.target_W, wire.target_m...);
    visit(option::kCone, policy.cone_rad, wire.cone_rad...);
  }
  visit(option::kMaxTurn, policy.max_turn_rad, wire.max_turn_rad...);
}

/// Visits the limits of the motion. Infinity means no limit.
template <class Visit, class... Wire>
void visit_table(const Visit& visit, Is<correction::MotionLimits> auto& limits, Wire&... wire) {
  visit(FieldSpec{.name = "speed_m_per_s", .old_file = "speed", .range = kAboveZero},
        limits.speed_m_per_s, wire.speed_m_per_s...);
  visit(FieldSpec{.name = "acceleration_m_per_s2", .old_file = "acceleration", .range = kAboveZero},
        limits.acceleration_m_per_s2, wire.acceleration_m_per_s2...);
  visit(FieldSpec{.name = "turn_rate",
                  .wire = "turn_rate_rad_per_s",
                  .file = "turn_rate_deg_per_s",
                  .old_file = "turn_rate_deg",
                  .range = kAboveZero},
        limits.turn_rate_rad_per_s, wire.turn_rate_rad_per_s...);
  visit(FieldSpec{.name = "retime", .wire = "may_retime"}, limits.may_retime, wire.may_retime...);
}

/// Visits the limits of bounds.
template <class Visit>
void visit_table(const Visit& visit, Is<geometry::OptionalBounds> auto& limits) {
  visit(FieldSpec{.name = "min", .wire = "min_m"}, limits.min_m);
  visit(FieldSpec{.name = "max", .wire = "max_m"}, limits.max_m);
}

/// Visits the members of a camera.
template <class Visit, class... Wire>
void visit_table(const Visit& visit, Is<motion::Camera> auto& camera, Wire&... wire) {
  constexpr Range kAngle{
      .least = 0.0, .most = std::numbers::pi, .excludes_least = true, .excludes_most = true};
  constexpr Range kDistance{.least = 0.0, .most = kMaxCoordinate_m, .excludes_least = true};
  visit(FieldSpec{.name = "fov_x",
                  .wire = "fov_x_rad",
                  .file = "fov_x_deg",
                  .range = kAngle,
                  .is_needed = true},
        camera.fov_x_rad, wire.fov_x_rad...);
  visit(FieldSpec{.name = "fov_y",
                  .wire = "fov_y_rad",
                  .file = "fov_y_deg",
                  .range = kAngle,
                  .is_needed = true},
        camera.fov_y_rad, wire.fov_y_rad...);
  visit(
      FieldSpec{
          .name = "near", .wire = "near_m", .unit = "m", .range = kDistance, .is_needed = true},
      camera.near_m, wire.near_m...);
}

/// Calls `visit(spec)` for each row of the table of `Struct`.
template <class Struct, class Visit>
void visit_specs(const Visit& visit) {
  const Struct blank{};
  visit_table([&](const FieldSpec& spec, const auto&) { visit(spec); }, blank);
}

/// Visits those members of a frame whose names differ, without their values.
template <class Visit>
void visit_frame(const Visit& visit) {
  visit(FieldSpec{.name = "reference", .wire = "reference_wxyz"});
}

/// Visits those members of a keyframe whose names differ, without their values.
template <class Visit>
void visit_keyframe(const Visit& visit) {
  visit(FieldSpec{.name = "time", .wire = "time_s"});
  visit(FieldSpec{.name = "position", .wire = "position_m"});
  visit(FieldSpec{.name = "orientation", .wire = "orientation_wxyz"});
}

/// Place whose names of members are meant.
enum class Spelling { kWire, kFile };

/// Returns the path of a member of a request, with the last name as `spelling` has it:
/// "options.limits.turn_rate_rad_per_s" for "options.limits.turn_rate", "body.size_m[2]" for
/// "body.size[2]". Returns other paths as they are.
std::string spell(std::string_view path, Spelling spelling);

}  // namespace camway::planning
