// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "daemon/messages/convert.h"
#include "daemon/messages/members.h"
#include "daemon/planning/request/body_members.h"
#include "lcmtypes/wire/layout.h"

namespace camway::messages {
namespace {

using correction::OrientationPolicy;
using geometry::Vec3;
using motion::BodyShape;
using planning::FieldSpec;
using Points = std::vector<std::vector<double>>;

static_assert(wire::kMaxBodyPoints == motion::kMaxBodyPoints);
static_assert(wire::kMaxBodyVertices == motion::kMaxBodyVertices);
static_assert(wire::kMaxBodyTriangles == motion::kMaxBodyTriangles);
static_assert(planning::kShapeNames[body_t::MESH] == "mesh");
static_assert(planning::kSolidMesh == body_t::SOLID_MESH);

/// Returns the name on the wire of the member at `path`. There options are members of the request,
/// and the points of all pieces of a body are one list.
std::string wire_name(std::string_view path) {
  constexpr std::string_view kPieces = "body.pieces[";
  constexpr std::string_view kGroup = "options.";
  const std::size_t end = path.find("][");
  if (path.starts_with(kPieces) && end != std::string_view::npos) {
    return fmt::format("body.points_m (point {} of piece {})",
                       path.substr(end + 2, path.size() - end - 3),
                       path.substr(kPieces.size(), end - kPieces.size()));
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

/// Reads members of tables. One that is zero or empty leaves the default; NaN and negative values
/// go on to `planning::validate`.
struct TableReader {
  Refusal& refusal;

  /// Reads the members of `wire` that count with this `kind`, and refuses others that have a value:
  /// their sender meant them. `visit_used(visit)` visits those that count.
  template <class Wire, class Kind, class VisitUsed>
  void read_used(const Wire& wire, const Kind& kind, const VisitUsed& visit_used) const {
    std::vector<const void*> used{&kind};
    visit_used([&](const FieldSpec&, const auto&, const auto&... members) {
      (used.push_back(&members), ...);
    });
    wire::visit_unused(wire, used, [&](std::string_view name, const auto& member) {
      if (name.starts_with("has_")) return;  // `refuse_idle` looks at what a flag marks
      refusal.add(member,
                  fmt::format("does not count with this {}; leave it zero or empty, or set the "
                              "one it belongs to",
                              refusal.path_of(kind)));
    });
    visit_used(*this);
  }

  template <class Mine, class Wire>
  void operator()(const FieldSpec& spec, Mine& mine, const Wire& wire) const {
    if (wire::is_blank(wire)) return;
    if constexpr (std::same_as<Mine, std::uint64_t>) {
      if (wire < 0) {
        refusal.add(wire, fmt::format("is {}; it must be {}", wire, spec.range_text()));
      }
    }
    FromWire{refusal}(mine, wire);
  }
  void operator()(const FieldSpec&, correction::MotionLimits& mine,
                  const motion_limits_t& wire) const {
    planning::visit_limits(*this, mine, wire);
  }
  void operator()(const FieldSpec&, OrientationPolicy& mine, const orientation_t& wire) const {
    (*this)(planning::option::kPolicy, mine.rule, wire.policy);
    read_used(wire, wire.policy,
              [&](const auto& visit) { planning::visit_used(visit, mine, wire); });
    mine.up_W = planning::direction_of(mine.up_W);
    if (wire.has_max_turn != 0) mine.max_turn_rad = wire.max_turn_rad;
  }
  void operator()(const FieldSpec&, std::vector<std::vector<Vec3>>& pieces,
                  const std::vector<std::int32_t>& sizes, const Points& points) const {
    std::span left(points);
    for (const std::int32_t& size : sizes) {
      if (size < 0 || static_cast<std::size_t>(size) > left.size()) {
        return refusal.add(size, fmt::format("is {}, and {} points are left", size, left.size()));
      }
      FromWire{refusal}(pieces.emplace_back(), left.first(static_cast<std::size_t>(size)));
      left = left.subspan(static_cast<std::size_t>(size));
    }
    if (left.empty()) return;
    refusal.add(sizes, fmt::format("{} points belong to no piece", left.size()));
  }
};

/// Reads the shape of a body. The shape is nothing if it is the near quadrilateral of the request's
/// camera. Sizes and counts are checked by `planning::validate`.
std::optional<BodyShape> read_body(const body_t& wire, Refusal& refusal) {
  std::optional<BodyShape> shape = planning::blank_shape(static_cast<std::size_t>(wire.type));
  if (!shape) {
    refusal.add(wire.type, unknown_value(wire.type, planning::kShapeNumberNames));
    return shape;
  }
  const auto read = [&](auto& part) {
    TableReader{refusal}.read_used(
        wire, wire.type, [&](const auto& visit) { planning::visit_shape(visit, part, wire); });
  };
  std::visit(read, *shape);
  if (wire.type == body_t::CAMERA) shape.reset();
  return shape;
}

/// Refuses members beside body and orientation that have a value but no effect.
void refuse_idle(Refusal& refusal, const plan_request_t& wire) {
  wire::visit_unmarked(wire, [&](const auto& member, const auto& flag) {
    refusal.add(member, fmt::format("counts only with {}; set that, or leave it zero",
                                    refusal.path_of(flag)));
  });
  if (wire.correct_nothing != 0 && wire.max_inserted_keyframes != 0) {
    refusal.add(wire.max_inserted_keyframes,
                fmt::format("is {}, which does not count beside correct_nothing; leave it 0",
                            wire.max_inserted_keyframes));
  }
  for (const keyframe_t& keyframe : wire.keyframes) {
    if (wire.has_times != 0 || wire::is_blank(keyframe.time_s)) continue;
    return refusal.add(keyframe.time_s,
                       "counts only with has_times; set that, or leave all times 0");
  }
}

}  // namespace

double deadline_of(double wire_s, const DeadlineLimits& limits) {
  const double deadline_s = wire_s == 0.0 ? limits.default_s : wire_s;
  return deadline_s > limits.max_s ? limits.max_s : deadline_s;
}

base::Result<planning::PlanRequest> from_wire(const plan_request_t& wire,
                                              const DeadlineLimits& limits) {
  Refusal refusal(wire);
  const FromWire io(refusal);
  planning::PlanRequest request;
  request.scene = wire.scene;
  io(request.camera, wire.camera);
  request.body = read_body(wire.body, refusal);
  refuse_idle(refusal, wire);
  visit_options(TableReader{refusal}, request.options, wire);
  request.options.deadline_s = deadline_of(wire.deadline_s, limits);
  if (wire.correct_nothing != 0) request.options.max_inserted_keyframes = 0;

  request.has_times = wire.has_times != 0;
  if (wire.has_frame != 0) io(request.frame.emplace(), wire.frame);
  request.spelling = wire_spelling(wire);
  if (!refusal.error().empty()) return base::Failure{refusal.error()};
  io(request.keyframes, wire.keyframes);  // whatever their origins say
  for (motion::Keyframe& keyframe : request.keyframes) {
    keyframe.origin = motion::KeyframeOrigin::kGiven;
    keyframe.is_repaired = false;
  }
  return request;
}

}  // namespace camway::messages
