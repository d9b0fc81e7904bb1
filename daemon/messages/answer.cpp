// SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>

#include "daemon/messages/convert.h"
#include "daemon/messages/fields.h"
#include "lcmtypes/wire/layout.h"

namespace camway::messages {

using planning::PlanResult;

template <class Io>
void pair(const Io& io, Is<motion::Segment> auto& mine, Is<segment_t> auto& wire) {
  io(mine.t0_s, wire.t0_s);
  io(mine.t1_s, wire.t1_s);
  io(mine.position, wire.position_m);
  io(mine.orientation, wire.orientation_wxyz);
}

/// Pairs all members except for the names of the witness, which a result has in lists of their own.
template <class Io>
void pair(const Io& io, Is<collision::CollisionInterval> auto& mine,
          Is<collision_interval_t> auto& wire) {
  io(mine.t_begin_s, wire.t_begin_s);
  io(mine.t_end_s, wire.t_end_s);
  io.optional(mine.witness, wire.has_witness, [&](auto& witness) {
    io(witness.time_s, wire.witness_time_s);
    io(witness.triangle, wire.witness_triangle);
    io(witness.depth_m, wire.witness_depth_m);
    io(witness.point_W, wire.witness_point_m);
  });
}

template <class Io>
void pair(const Io& io, Is<correction::Correction> auto& mine, Is<correction_t> auto& wire) {
  io(mine.interval.t_begin_s, wire.t_begin_s);
  io(mine.interval.t_end_s, wire.t_end_s);
  io(mine.kind, wire.method);
  io(mine.t_begin_s, wire.changed_t_begin_s);
  io(mine.t_end_s, wire.changed_t_end_s);
  io(mine.moved_m, wire.moved_m);
  io(mine.turned_rad, wire.turned_rad);
  io(mine.tried.directions, wire.tried_directions);
  io(mine.tried.paths, wire.tried_paths);
  io(mine.tried.lattice_points, wire.tried_lattice_points);
  io(mine.tried.tree_samples, wire.tried_tree_samples);
}

template <class Io>
void pair(const Io& io, Is<planning::KeyframeFault> auto& mine, Is<keyframe_fault_t> auto& wire) {
  io(mine.keyframe, wire.keyframe);
  io(mine.depth_m, wire.depth_m);
  io.optional(mine.free_pose, wire.has_free_pose, [&](auto& pose) {
    io(pose.position, wire.free_position_m);
    io(pose.orientation, wire.free_orientation_wxyz);
  });
}

template <class Io>
void pair(const Io& io, Is<correction::CageBox> auto& mine, Is<cage_t> auto& wire) {
  io(mine.orientation, wire.orientation_wxyz);
  io(mine.box.min(), wire.min_m);
  io(mine.box.max(), wire.max_m);
  io(mine.widest_hole_m, wire.widest_hole_m);
  io(mine.shortest_chord_m, wire.shortest_chord_m);
}

/// Pairs all members except for the message, the keyframe at fault, the path and the collisions.
template <class Io>
void pair(const Io& io, Is<PlanResult> auto& mine, Is<plan_response_t> auto& wire) {
  io(mine.status, wire.status);
  io(mine.certificate.certified, wire.certified);
  io(mine.certificate.clearance_lower_bound_m, wire.clearance_lower_bound_m);
  io(mine.bounds, wire.bounds);
  io(mine.near_scale, wire.near_scale);
  io(mine.time_scale, wire.time_scale);
  io(mine.deadline_reached, wire.deadline_reached);
  io.optional(mine.measures_before, wire.has_measures_before,
              [&](auto& measures) { io(measures, wire.measures_before); });
  io.optional(mine.measures, wire.has_measures,
              [&](auto& measures) { io(measures, wire.measures); });
  io.optional(mine.infeasibility, wire.has_infeasibility, [&](auto& proof) {
    io(proof.keyframe_inside, wire.keyframe_inside);
    io(proof.keyframe_outside, wire.keyframe_outside);
    io.optional(proof.cage, wire.has_cage, [&](auto& cage) { io(cage, wire.proof_cage); });
    io(proof.triangles, wire.proof_triangles);
  });
  pair_common(io, mine.timing, wire);
  io(mine.keyframes, wire.keyframes);
  io(mine.corrections, wire.corrections);
  io(mine.slowed, wire.slowed);
  io(mine.keyframe_faults, wire.keyframe_faults);
}

namespace {

/// `names` may be shorter than `wire`: the rest of the witnesses have no names.
void put_names(const std::vector<planning::WitnessNames>& names,
               std::vector<collision_interval_t>& wire) {
  for (std::size_t i = 0; i < wire.size() && i < names.size(); ++i) {
    if (wire[i].has_witness == 0) continue;
    wire[i].witness_object = clipped(names[i].object, wire::kMaxObjectNameBytes);
    wire[i].witness_feature = clipped(names[i].feature, wire::kMaxFeatureBytes);
  }
}

std::vector<planning::WitnessNames> names_in(const std::vector<collision_interval_t>& wire) {
  std::vector<planning::WitnessNames> names(wire.size());
  for (std::size_t i = 0; i < wire.size(); ++i) {
    if (wire[i].has_witness != 0) names[i] = {wire[i].witness_object, wire[i].witness_feature};
  }
  return names;
}

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
  pair(io, result, wire);
  result.message = wire.message;
  if (wire.keyframe >= 0) result.keyframe = static_cast<std::size_t>(wire.keyframe);
  std::vector<motion::Segment> segments;
  io(segments, wire.segments);
  if (!segments.empty()) result.path = motion::Path(std::move(segments));
  io(result.collisions, wire.collisions);
  io(result.remaining_collisions, wire.remaining);
  result.collision_names = names_in(wire.collisions);
  result.remaining_names = names_in(wire.remaining);
  return result;
}

plan_response_t to_wire(const PlanResult& result, const AnswerHeader& header) {
  const ToWire io;
  plan_response_t wire = plain_answer(0, result.message, header);
  pair(io, result, wire);
  if (result.keyframe) wire.keyframe = static_cast<std::int32_t>(*result.keyframe);
  wire.segments.reserve(result.path.segments().size());
  for (const motion::Segment& segment : result.path.segments()) {
    io(segment, wire.segments.emplace_back());
  }
  io(result.collisions, wire.collisions);
  io(result.remaining_collisions, wire.remaining);
  put_names(result.collision_names, wire.collisions);
  put_names(result.remaining_names, wire.remaining);
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
  wire.message = clipped(message, wire::kMaxTextBytes);
  wire.keyframe = -1;
  wire.scene = clipped(header.scene, wire::kMaxSceneNameBytes);
  wire.scene_revision = header.scene_revision;
  wire.scene_digest = clipped(header.scene_digest, wire::kMaxDigestBytes);
  wire.near_scale = 1.0;
  wire.time_scale = 1.0;
  wire.keyframe_inside = -1;
  wire.keyframe_outside = -1;
  return wire;
}

}  // namespace camway::messages
