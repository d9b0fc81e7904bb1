// SPDX-License-Identifier: MIT
#include "daemon/messages/plan.h"

#include <cmath>
#include <type_traits>
#include <utility>

#include "daemon/messages/converter.h"
#include "lcmtypes/wire/path_fault.h"

namespace camway::messages {

using planning::PlanResult;

namespace {

bool is_pose(const motion::Pose& pose) {
  const double norm = pose.orientation.norm();
  return pose.position.allFinite() && std::isfinite(norm) && norm > 0.0;
}

/// Zeroes each number of a message, and of the structs and lists in it, whose name ends in `_ms`.
template <wire::Described Message>
void blank_durations(Message& message) {
  wire::for_each_member<Message>([&](const auto& described) {
    auto& member = message.*described.member;
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (std::is_arithmetic_v<Member>) {
      if (described.name.ends_with("_ms")) member = 0;
    } else if constexpr (wire::Described<Member>) {
      blank_durations(member);
    } else if constexpr (requires { blank_durations(member.front()); }) {
      for (auto& element : member) blank_durations(element);
    }
  });
}

}  // namespace

bounds_t to_wire(const geometry::Bounds& bounds) {
  bounds_t wire{};
  ToWire{}(geometry::optional_bounds_of(bounds), wire);
  return wire;
}

geometry::Bounds from_wire(const bounds_t& wire) {
  geometry::OptionalBounds limits;
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

base::Result<PlanResult> watched_part_of(const plan_response_t& answer, std::size_t keyframes) {
  base::Result<motion::Path> path = path_of(answer.segments);
  if (!path) return base::Failure{std::move(path.error)};
  PlanResult result;
  result.path = *std::move(path);
  result.certificate = {answer.certified != 0, answer.clearance_lower_bound_m};
  result.near_scale = answer.near_scale;
  for (const collision_interval_t& collision : answer.collisions) {
    result.collisions.push_back({collision.t_begin_s, collision.t_end_s, {}});
  }
  for (const keyframe_fault_t& fault : answer.keyframe_faults) {
    if (fault.keyframe < 0 || static_cast<std::size_t>(fault.keyframe) >= keyframes) {
      return base::Failure{"keyframe_faults: no such keyframe"};
    }
    planning::KeyframeFault& mine = result.keyframe_faults.emplace_back();
    FromWire{}(mine, fault);
    if (mine.free_pose && !is_pose(*mine.free_pose)) {
      return base::Failure{"keyframe_faults: a free pose is none"};
    }
  }
  return result;
}

plan_response_t without_times(plan_response_t answer) {
  answer.utime = 0;
  answer.daemon_start = {};
  blank_durations(answer);
  return answer;
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
