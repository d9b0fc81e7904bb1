// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "daemon/messages/converter.h"
#include "daemon/messages/plan.h"
#include "daemon/planning/request/body_members.h"
#include "daemon/planning/request/option_table.h"
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

/// Reads members that count, pieces of bodies included.
struct UsedReader : FromWire {
  using FromWire::FromWire;
  using FromWire::operator();

  void operator()(const FieldSpec&, std::vector<std::vector<Vec3>>& pieces,
                  const std::vector<std::int32_t>& sizes, const Points& points) const {
    std::span left(points);
    for (const std::int32_t& size : sizes) {
      if (size < 0 || static_cast<std::size_t>(size) > left.size()) {
        return refusal_->add(size, fmt::format("is {}, and {} points are left", size, left.size()));
      }
      (*this)(pieces.emplace_back(), left.first(static_cast<std::size_t>(size)));
      left = left.subspan(static_cast<std::size_t>(size));
    }
    if (left.empty()) return;
    refusal_->add(sizes, fmt::format("{} points belong to no piece", left.size()));
  }
};

/// Reads the members of `wire` that count with this `kind`, and refuses others that have a value:
/// their sender meant them. `visit_used(visit)` visits those that count.
template <class Wire, class Kind, class VisitUsed>
void read_used(Refusal& refusal, const Wire& wire, const Kind& kind, const VisitUsed& visit_used) {
  std::vector<const void*> used{&kind};
  visit_used([&](const FieldSpec&, const auto&, const auto&... members) {
    (used.push_back(&members), ...);
  });
  wire::visit_unused(wire, used, [&](std::string_view name, const auto& member) {
    if (name.starts_with("has_")) return;  // `refuse_idle` looks at what a flag marks
    refusal.add(member, fmt::format("does not count with this {}; leave it zero or empty, or set "
                                    "the one it belongs to",
                                    refusal.path_of(kind)));
  });
  visit_used(UsedReader(refusal));
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

// `FromWire` finds these functions for the pairs of structs that differ.
static void translate(const orientation_t& wire, OrientationPolicy& mine, Refusal& refusal) {
  FromWire{refusal}(mine.rule, wire.policy);
  read_used(refusal, wire, wire.policy,
            [&](const auto& visit) { planning::visit_used(visit, mine, wire); });
  mine.up_W = planning::direction_of(mine.up_W);
  if (wire.has_max_turn != 0) mine.max_turn_rad = wire.max_turn_rad;
}
/// The shape is nothing if it is the near quadrilateral of the request's camera. Sizes and counts
/// are checked by `planning::validate`.
static void translate(const body_t& wire, std::optional<BodyShape>& shape, Refusal& refusal) {
  shape = planning::blank_shape(static_cast<std::size_t>(wire.type));
  if (!shape) return refusal.add(wire.type, unknown_value(wire.type, planning::kShapeNumberNames));
  const auto read = [&](auto& part) {
    read_used(refusal, wire, wire.type,
              [&](const auto& visit) { planning::visit_shape(visit, part, wire); });
  };
  std::visit(read, *shape);
  if (wire.type == body_t::CAMERA) shape.reset();
}

base::Result<planning::PlanRequest> from_wire(const plan_request_t& wire,
                                              const DeadlineLimits& limits) {
  Refusal refusal(wire);
  const FromWire io(refusal);
  planning::PlanRequest request;
  request.scene = wire.scene;
  io(request.camera, wire.camera);
  io(request.body, wire.body);
  refuse_idle(refusal, wire);
  io(request.options, wire);
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
