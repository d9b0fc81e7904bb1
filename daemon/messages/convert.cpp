// SPDX-License-Identifier: MIT
#include "daemon/messages/convert.h"

#include <algorithm>
#include <utility>

#include <camway/occupancy_response_t.hpp>

#include "daemon/messages/converter.h"
#include "lcmtypes/wire/path_fault.h"

namespace camway::messages {

using planning::PlanResult;

std::string_view status_name(std::int32_t wire_status) {
  if (const auto status = base::value_of<planning::Status>(wire_status)) {
    return planning::to_string(*status);
  }
  if (wire_status == plan_response_t::STATUS_OVERLOADED) return "overloaded";
  if (wire_status == plan_response_t::STATUS_MALFORMED) return "malformed";
  if (wire_status == plan_response_t::STATUS_CANCELLED) return "cancelled";
  if (wire_status == plan_response_t::STATUS_LIMIT) return "limit";
  if (wire_status == occupancy_response_t::STATUS_NO_MAP) return "no_map";
  return "unknown status";
}

std::string clipped(std::string_view text, std::size_t max_bytes) {
  std::size_t size = std::min({text.size(), max_bytes, text.find('\0')});
  // A byte 10xxxxxx continues a character; cutting before one would leave half of it.
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  if (size == max_bytes) {
    while (size > 0 && size < text.size() && continues(size)) --size;
  }
  return std::string(text.substr(0, size));
}

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
