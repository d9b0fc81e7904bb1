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

/// Returns an error about a member that has a value but no effect: its sender meant it.
std::string idle_member(const plan_request_t& wire) {
  if (wire.correct_nothing != 0 && wire.max_inserted_keyframes != 0) {
    return "max_inserted_keyframes: is " + std::to_string(wire.max_inserted_keyframes) +
           ", which does not count beside correct_nothing; leave it 0";
  }
  for (std::size_t i = 0; wire.has_times == 0 && i < wire.keyframes.size(); ++i) {
    if (wire.keyframes[i].time_s != 0.0) {
      return "keyframes[" + std::to_string(i) +
             "].time_s: is not 0, and does not count without has_times; set that, or leave all "
             "times 0";
    }
  }
  if (wire.has_frame == 0 && !wire::is_blank(wire.frame)) {
    return "frame: is not zero, and does not count without has_frame; set that, or leave it zero";
  }
  return {};
}

/// Returns an error about a member of an orientation that has a value but no effect with this rule.
std::string idle_member(const orientation_t& wire, OrientationRule rule) {
  if (rule != OrientationRule::kLevel && !wire::is_blank(wire.up)) {
    return "orientation.up: counts only with the policy LEVEL; leave it zero";
  }
  if (rule != OrientationRule::kTarget && !wire::is_blank(wire.target_m)) {
    return "orientation.target_m: counts only with the policy TARGET; leave it zero";
  }
  if (rule != OrientationRule::kTarget && wire.cone_rad != 0.0) {
    return "orientation.cone_rad: counts only with the policy TARGET; leave it 0";
  }
  if (wire.has_max_turn == 0 && wire.max_turn_rad != 0.0) {
    return "orientation.max_turn_rad: counts only with has_max_turn; set that, or leave it 0";
  }
  return {};
}

/// Returns an error about a limit that has a value and no effect.
std::string idle_member(const bounds_t& wire) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_min = wire.has_min[axis] == 0 && wire.min_m[axis] != 0.0;
    if (!is_min && (wire.has_max[axis] != 0 || wire.max_m[axis] == 0.0)) continue;
    const std::string side = is_min ? "min" : "max";
    const std::string at = "[" + std::to_string(axis) + "]";
    return "bounds." + side + "_m" + at + ": counts only with has_" + side + at +
           "; set that, or leave it 0";
  }
  return {};
}

/// Reads options. Only an exact 0 asks for the default: NaN and negative values go on to
/// `planning::validate`. Keeps the first error.
struct OptionReader {
  std::string& error;

  template <class Number, class Wire>
  requires std::is_arithmetic_v<Number> && std::is_arithmetic_v<Wire>
  void operator()(const FieldSpec& spec, Number& mine, Wire wire) const {
    constexpr bool kIsUnsigned = std::is_unsigned_v<Number> && !std::is_same_v<Number, bool>;
    if (kIsUnsigned && wire < Wire{}) {
      if (error.empty()) {
        error = std::string(spec.wire_name()) + ": is " + std::to_string(wire) + "; it must be " +
                spec.range_text();
      }
      return;
    }
    if (wire != 0 || mine == 0) mine = static_cast<Number>(wire);
  }
  void operator()(const FieldSpec&, std::optional<double>& mine, double wire) const {
    if (wire != 0.0) mine = wire;
  }
  template <base::NamedEnum Enum>
  void operator()(const FieldSpec& spec, Enum& mine, std::int8_t wire) const {
    if (!base::value_of<Enum>(wire)) refuse(spec, std::to_string(wire));
    translate(wire, mine);
  }
  template <base::NamedEnum Enum>
  void operator()(const FieldSpec& spec, Enum& mine, const std::string& wire) const {
    const std::optional<Enum> named = base::value_of<Enum>(wire);
    if (!named && !wire.empty()) refuse(spec, "'" + wire + "'");
    mine = named.value_or(mine);
  }
  void operator()(const FieldSpec&, geometry::Bounds& mine, const bounds_t& wire) const {
    if (error.empty()) error = idle_member(wire);
    translate(wire, mine);
  }
  void operator()(const FieldSpec&, correction::MotionLimits& mine,
                  const motion_limits_t& wire) const {
    planning::visit_limits(*this, mine, wire);
  }
  void operator()(const FieldSpec& spec, OrientationPolicy& mine, const orientation_t& wire) const {
    const auto rule = base::value_of<OrientationRule>(wire.policy);
    std::string fault = rule ? idle_member(wire, *rule) : "";
    if (!rule) refuse(spec, std::to_string(wire.policy), ".policy");
    if (error.empty()) error = std::move(fault);
    mine.rule = rule.value_or(mine.rule);
    if (!wire::is_blank(wire.up)) {
      FromWire{}(mine.up_W, wire.up);
      mine.up_W = planning::direction_of(mine.up_W);
    }
    FromWire{}(mine.target_W, wire.target_m);
    (*this)(spec, mine.cone_rad, wire.cone_rad);
    if (wire.has_max_turn != 0) mine.max_turn_rad = wire.max_turn_rad;
  }

  void refuse(const FieldSpec& spec, const std::string& value, const char* member = "") const {
    if (error.empty())
      error = std::string(spec.wire_name()) + member + ": " + value + " is unknown";
  }
};

/// Writes options. Infinity means no limit on the wire, too.
struct OptionWriter {
  template <class Mine, class Wire>
  void operator()(const FieldSpec&, const Mine& mine, Wire& wire) const {
    ToWire{}(mine, wire);
  }
  void operator()(const FieldSpec&, const std::optional<double>& mine, double& wire) const {
    wire = mine.value_or(0.0);
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

  std::string error = idle_member(wire);
  visit_options(OptionReader{error}, request.options, wire);
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
