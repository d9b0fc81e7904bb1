// SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>

#include "daemon/messages/convert.h"
#include "daemon/messages/members.h"
#include "lcmtypes/wire/layout.h"

namespace camway::messages {

using planning::NamedCollision;
using planning::PlanResult;

namespace {

/// Checks the preconditions of `motion::Path`, which does not check them itself.
std::string path_fault(const std::vector<segment_t>& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const segment_t& segment = segments[i];
    const std::string name = "segments[" + std::to_string(i) + "]";
    if (!std::isfinite(segment.t0_s) || !std::isfinite(segment.t1_s) ||
        !(segment.t0_s < segment.t1_s)) {
      return name + ": its times do not increase";
    }
    if (i > 0 && segments[i - 1].t1_s != segment.t0_s) {
      return name + ": does not begin where the one before ends";
    }
  }
  return {};
}

/// Returns an error about the first number in the report that no result has.
std::string report_fault(const plan_response_t& wire) {
  const auto at = [](const char* list, std::size_t i) {
    return std::string(list) + "[" + std::to_string(i) + "]";
  };
  for (std::size_t i = 0; i < wire.corrections.size(); ++i) {
    const std::int8_t method = wire.corrections[i].method;
    if (base::value_of<correction::CorrectionKind>(method)) continue;
    return at("corrections", i) + ".method: " + std::to_string(method) + " is unknown";
  }
  for (std::size_t i = 0; i < wire.keyframe_faults.size(); ++i) {
    if (wire.keyframe_faults[i].keyframe < 0) {
      return at("keyframe_faults", i) + ".keyframe: is below 0";
    }
  }
  if (wire.has_infeasibility == 0) return {};
  if (wire.keyframe_inside < 0) return "keyframe_inside: is below 0";
  if (wire.keyframe_outside < 0) return "keyframe_outside: is below 0";
  for (std::size_t i = 0; i < wire.proof_triangles.size(); ++i) {
    if (wire.proof_triangles[i] < 0) return at("proof_triangles", i) + ": is below 0";
  }
  return {};
}

/// Converts the members of an answer other than its path and its collisions.
template <class Io, class Result, class Wire>
void convert_report(const Io& io, Result& result, Wire& wire) {
  planning::head_members(io, result, wire);
  io(result.keyframes, wire.keyframes);
  planning::report_members(io, result, wire);
  planning::members(io, result.timing, wire);
}

}  // namespace

base::Result<PlanResult> from_wire(const plan_response_t& wire) {
  if (!base::value_of<planning::Status>(wire.status)) {
    return base::Failure{std::string(status_name(wire.status)) + ": " + wire.message};
  }
  std::string fault = path_fault(wire.segments);
  if (fault.empty()) fault = report_fault(wire);
  if (!fault.empty()) return base::Failure{std::move(fault)};

  const FromWire io;
  PlanResult result;
  convert_report(io, result, wire);
  std::vector<motion::Segment> segments;
  io(segments, wire.segments);
  if (!segments.empty()) result.path = motion::Path(std::move(segments));
  std::vector<NamedCollision> collisions;
  io(collisions, wire.collisions);
  append(std::move(collisions), result.collisions, result.collision_names);
  std::vector<NamedCollision> remaining;
  io(remaining, wire.remaining);
  append(std::move(remaining), result.remaining_collisions, result.remaining_names);
  return result;
}

plan_response_t to_wire(const PlanResult& result, const AnswerHeader& header) {
  const ToWire io;
  plan_response_t wire = plain_answer(0, "", header);
  convert_report(io, result, wire);
  io(result.path.segments(), wire.segments);
  io(with_names(result.collisions, result.collision_names), wire.collisions);
  io(with_names(result.remaining_collisions, result.remaining_names), wire.remaining);
  clip_texts(wire);
  wire::set_counts(wire);
  return wire;
}

plan_response_t plain_answer(std::int32_t status, std::string_view message,
                             const AnswerHeader& header) {
  plan_response_t wire{};
  wire.client_id = header.ids.client_id;
  wire.request_id = header.ids.request_id;
  wire.utime = header.ids.utime;
  wire.num_pages = 1;
  wire.status = status;
  wire.message = message;
  wire.keyframe = -1;
  wire.scene = header.scene;
  wire.scene_revision = header.scene_revision;
  wire.scene_digest = header.scene_digest;
  wire.near_scale = 1.0;
  wire.time_scale = 1.0;
  wire.keyframe_inside = -1;
  wire.keyframe_outside = -1;
  clip_texts(wire);
  return wire;
}

}  // namespace camway::messages
