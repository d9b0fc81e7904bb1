// SPDX-License-Identifier: MIT
#include "daemon/messages/plan.h"

#include <utility>

#include "daemon/messages/converter.h"
#include "lcmtypes/wire/path_fault.h"

namespace camway::messages {

using planning::PlanResult;

bounds_t to_wire(const geometry::Bounds& bounds) {
  bounds_t wire{};
  ToWire{}(geometry::limits_of(bounds), wire);
  return wire;
}

geometry::Bounds from_wire(const bounds_t& wire) {
  geometry::Limits limits;
  FromWire{}(limits, wire);
  return geometry::bounds_of(limits);
}

base::Result<motion::Path> path_of(const std::vector<segment_t>& wire) {
  std::string fault = wire::path_fault(wire);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  if (wire.empty()) return motion::Path();
  std::vector<motion::Segment> segments;
  FromWire{}(segments, wire);
  return motion::Path(std::move(segments));
}

plan_response_t to_wire(const PlanResult& result, const AnswerHeader& header) {
  const ToWire io;
  plan_response_t wire{};
  wire::convert_common(io, header.ids, wire);
  wire::convert_common(io, header, wire);
  wire.num_pages = 1;
  wire.keyframe_inside = -1;
  wire.keyframe_outside = -1;
  planning::head_members(io, result, wire);
  io(result.path.segments(), wire.segments);
  io(result.keyframes, wire.keyframes);
  planning::report_members(io, result, wire);
  planning::members(io, result.timing, wire);
  clip_texts(wire);
  wire::set_counts(wire);
  return wire;
}

plan_response_t plain_answer(std::int32_t status, std::string_view message,
                             const AnswerHeader& header) {
  PlanResult nothing;
  nothing.message = message;
  plan_response_t wire = to_wire(nothing, header);
  wire.status = status;
  return wire;
}

// The values of enumerations are those of the wire.
static_assert(static_cast<int>(planning::Status::kInternalError) ==
              plan_response_t::STATUS_INTERNAL_ERROR);
static_assert(static_cast<int>(correction::Objective::kSafest) == plan_request_t::SAFEST);
static_assert(static_cast<int>(correction::OrientationRule::kTarget) == orientation_t::TARGET);
static_assert(static_cast<int>(correction::CorrectionKind::kShrink) == correction_t::SHRINK);
static_assert(static_cast<int>(motion::KeyframeOrigin::kInserted) == keyframe_t::ORIGIN_INSERTED);

}  // namespace camway::messages
