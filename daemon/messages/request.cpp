// SPDX-License-Identifier: MIT
#include <utility>

#include "daemon/messages/body.h"
#include "daemon/messages/convert.h"
#include "daemon/messages/members.h"

namespace camway::messages {
namespace {

using correction::OrientationPolicy;
using correction::OrientationRule;
using geometry::Vec3;
using planning::FieldSpec;

/// Returns the name on the wire of the member at `path`. There options are members of the request,
/// and the points of all pieces of a body are one list.
std::string wire_name(std::string_view path) {
  constexpr std::string_view kPieces = "body.pieces[";
  constexpr std::string_view kGroup = "options.";
  const std::size_t end = path.find("][");
  if (path.starts_with(kPieces) && end != std::string_view::npos) {
    return "body.points_m (point " + std::string(path.substr(end + 2, path.size() - end - 3)) +
           " of piece " + std::string(path.substr(kPieces.size(), end - kPieces.size())) + ")";
  }
  const std::string name = planning::spell(path, planning::Spelling::kWire);
  return name.starts_with(kGroup) ? name.substr(kGroup.size()) : name;
}

/// Returns how a message spells the members of a request. Keeps no reference to the message.
planning::FieldSpelling wire_spelling(const plan_request_t& wire) {
  return [corrects_nothing = wire.correct_nothing != 0](std::string_view path) -> std::string {
    if (corrects_nothing && path == "options.max_inserted_keyframes") return "correct_nothing";
    return wire_name(path);
  };
}

/// Reads options. Only an exact 0 asks for the default: NaN and negative values go on to
/// `planning::validate`. Keeps the first error.
struct OptionReader {
  std::string& error;

  void refuse(std::string_view name, const std::string& reason) const {
    if (error.empty()) error = std::string(name) + ": " + reason;
  }
  /// Refuses a member that has a value but no effect: its sender meant it.
  template <class Member>
  void refuse_idle(bool counts, const Member& member, std::string_view name,
                   const std::string& reason) const {
    if (!counts && !wire::is_blank(member)) refuse(name, reason);
  }

  template <class Number, class Wire>
  requires std::is_arithmetic_v<Number> && std::is_arithmetic_v<Wire>
  void operator()(const FieldSpec& spec, Number& mine, Wire wire) const {
    constexpr bool kIsUnsigned = std::is_unsigned_v<Number> && !std::is_same_v<Number, bool>;
    if (kIsUnsigned && wire < Wire{}) {
      refuse(spec.wire_name(), "is " + std::to_string(wire) + "; it must be " + spec.range_text());
    } else if (wire != 0 || mine == 0) {
      mine = static_cast<Number>(wire);
    }
  }
  void operator()(const FieldSpec&, std::optional<double>& mine, double wire) const {
    if (wire != 0.0) mine = wire;
  }
  template <base::NamedEnum Enum>
  void operator()(const FieldSpec& spec, Enum& mine, std::int8_t wire) const {
    if (!base::value_of<Enum>(wire)) refuse(spec.wire_name(), std::to_string(wire) + " is unknown");
    translate(wire, mine);
  }
  template <base::NamedEnum Enum>
  void operator()(const FieldSpec& spec, Enum& mine, const std::string& wire) const {
    const std::optional<Enum> named = base::value_of<Enum>(wire);
    if (!named && !wire.empty()) refuse(spec.wire_name(), "'" + wire + "' is unknown");
    mine = named.value_or(mine);
  }
  void operator()(const FieldSpec&, geometry::Bounds& mine, const bounds_t& wire) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string at = "[" + std::to_string(axis) + "]";
      refuse_idle(wire.has_min[axis] != 0, wire.min_m[axis], "bounds.min_m" + at,
                  "counts only with has_min" + at + "; set that, or leave it 0");
      refuse_idle(wire.has_max[axis] != 0, wire.max_m[axis], "bounds.max_m" + at,
                  "counts only with has_max" + at + "; set that, or leave it 0");
    }
    translate(wire, mine);
  }
  void operator()(const FieldSpec&, correction::MotionLimits& mine,
                  const motion_limits_t& wire) const {
    planning::visit_limits(*this, mine, wire);
  }
  void operator()(const FieldSpec& spec, OrientationPolicy& mine, const orientation_t& wire) const {
    (*this)(FieldSpec{.name = "orientation.policy"}, mine.rule, wire.policy);
    const bool is_target = mine.rule == OrientationRule::kTarget;
    refuse_idle(mine.rule == OrientationRule::kLevel, wire.up, "orientation.up",
                "counts only with the policy LEVEL; leave it zero");
    refuse_idle(is_target, wire.target_m, "orientation.target_m",
                "counts only with the policy TARGET; leave it zero");
    refuse_idle(is_target, wire.cone_rad, "orientation.cone_rad",
                "counts only with the policy TARGET; leave it 0");
    refuse_idle(wire.has_max_turn != 0, wire.max_turn_rad, "orientation.max_turn_rad",
                "counts only with has_max_turn; set that, or leave it 0");
    if (!wire::is_blank(wire.up)) {
      FromWire{}(mine.up_W, wire.up);
      mine.up_W = planning::direction_of(mine.up_W);
    }
    FromWire{}(mine.target_W, wire.target_m);
    (*this)(spec, mine.cone_rad, wire.cone_rad);
    if (wire.has_max_turn != 0) mine.max_turn_rad = wire.max_turn_rad;
  }
};

/// Refuses members beside the options that have a value but no effect.
void refuse_idle_members(const OptionReader& reader, const plan_request_t& wire) {
  reader.refuse_idle(wire.correct_nothing == 0, wire.max_inserted_keyframes,
                     "max_inserted_keyframes",
                     "is " + std::to_string(wire.max_inserted_keyframes) +
                         ", which does not count beside correct_nothing; leave it 0");
  for (std::size_t i = 0; wire.has_times == 0 && i < wire.keyframes.size(); ++i) {
    if (wire::is_blank(wire.keyframes[i].time_s)) continue;
    return reader.refuse(
        "keyframes[" + std::to_string(i) + "].time_s",
        "is not 0, and does not count without has_times; set that, or leave all times 0");
  }
  reader.refuse_idle(
      wire.has_frame != 0, wire.frame, "frame",
      "is not zero, and does not count without has_frame; set that, or leave it zero");
}

/// Writes options. Infinity means no limit on the wire, too, and an option that is not set is 0.
struct OptionWriter {
  template <class Mine, class Wire>
  void operator()(const FieldSpec&, const Mine& mine, Wire& wire) const {
    ToWire{}(mine, wire);
  }
  template <base::NamedEnum Enum>
  void operator()(const FieldSpec&, Enum mine, std::string& wire) const {
    wire = base::name_of(mine);
  }
  /// Writes the members that the rule uses.
  void operator()(const FieldSpec&, const OrientationPolicy& mine, orientation_t& wire) const {
    const ToWire io;
    io(mine.rule, wire.policy);
    if (mine.rule == OrientationRule::kLevel) io(mine.up_W, wire.up);
    if (mine.rule == OrientationRule::kTarget) {
      io(mine.target_W, wire.target_m);
      wire.cone_rad = mine.cone_rad;
    }
    wire.has_max_turn = 1;
    wire.max_turn_rad = mine.max_turn_rad;
  }
};

}  // namespace

double deadline_of(double wire_s, const DeadlineLimits& limits) {
  const double deadline_s = wire_s == 0.0 ? limits.default_s : wire_s;
  return deadline_s > limits.max_s ? limits.max_s : deadline_s;
}

base::Result<planning::PlanRequest> from_wire(const plan_request_t& wire,
                                              const DeadlineLimits& limits) {
  const FromWire io;
  planning::PlanRequest request;
  request.scene = wire.scene;
  io(request.camera, wire.camera);
  base::Result<std::optional<motion::BodyShape>> body = body_of(wire.body);
  if (!body) return base::Failure{std::move(body.error)};
  request.body = *std::move(body);

  std::string error;
  const OptionReader reader{error};
  refuse_idle_members(reader, wire);
  visit_options(reader, request.options, wire);
  if (!error.empty()) return base::Failure{std::move(error)};
  request.options.deadline_s = deadline_of(wire.deadline_s, limits);
  if (wire.correct_nothing != 0) request.options.max_inserted_keyframes = 0;

  request.has_times = wire.has_times != 0;
  if (wire.has_frame != 0) io(request.frame.emplace(), wire.frame);
  request.spelling = wire_spelling(wire);
  io(request.keyframes, wire.keyframes);
  for (motion::Keyframe& keyframe : request.keyframes) {
    keyframe.origin = motion::KeyframeOrigin::kGiven;
    keyframe.is_repaired = false;
  }
  return request;
}

plan_request_t to_wire(const planning::PlanRequest& request, const RequestIds& ids) {
  const ToWire io;
  plan_request_t wire{};
  wire.client_id = ids.client_id;
  wire.request_id = ids.request_id;
  wire.utime = ids.utime;
  wire.num_pages = 1;
  wire.scene = request.scene;
  // The wire has no near quadrilateral other than the camera's, so one that is given as the body
  // goes as the camera.
  const auto* camera = request.body ? std::get_if<motion::Camera>(&*request.body) : nullptr;
  io(camera == nullptr ? request.camera : *camera, wire.camera);
  if (request.body) wire.body = wire_body(*request.body);
  visit_options(OptionWriter{}, request.options, wire);
  wire.correct_nothing = request.options.max_inserted_keyframes == 0 ? 1 : 0;
  wire.has_times = request.has_times ? 1 : 0;
  wire.has_frame = request.frame ? 1 : 0;
  if (request.frame) io(*request.frame, wire.frame);
  io(request.keyframes, wire.keyframes);
  for (keyframe_t& keyframe : wire.keyframes) {
    if (!request.has_times) keyframe.time_s = 0.0;
  }
  wire::set_counts(wire);
  return wire;
}

}  // namespace camway::messages
