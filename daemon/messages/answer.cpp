// SPDX-License-Identifier: MIT
#include <utility>
#include <vector>

#include "daemon/messages/convert.h"
#include "daemon/messages/members.h"
#include "lcmtypes/wire/path_fault.h"

namespace camway::messages {

using planning::PlanResult;

namespace {

/// Converts the members of an answer other than its path.
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
  std::string fault = wire::path_fault(wire.segments);
  if (!fault.empty()) return base::Failure{std::move(fault)};

  Refusal refusal(wire);
  const FromWire io(refusal);
  PlanResult result;
  convert_report(io, result, wire);
  if (!refusal.error().empty()) return base::Failure{refusal.error()};
  std::vector<motion::Segment> segments;
  io(segments, wire.segments);
  if (!segments.empty()) result.path = motion::Path(std::move(segments));
  return result;
}

plan_response_t to_wire(const PlanResult& result, const AnswerHeader& header) {
  const ToWire io;
  plan_response_t wire = plain_answer(0, "", header);
  convert_report(io, result, wire);
  io(result.path.segments(), wire.segments);
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
