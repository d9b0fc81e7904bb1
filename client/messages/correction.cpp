// SPDX-License-Identifier: MIT
#include "client/messages/correction.h"

#include <algorithm>
#include <iterator>

#include "client/messages/constraints.h"

namespace camway {
namespace {

std::optional<Correction::Method> method_of(std::int8_t wire) {
  switch (wire) {
    case correction_t::NONE:
      return Correction::Method::kNone;
    case correction_t::MOVE:
      return Correction::Method::kMove;
    case correction_t::TURN:
      return Correction::Method::kTurn;
    case correction_t::GO_ROUND:
      return Correction::Method::kGoRound;
    case correction_t::SHRINK:
      return Correction::Method::kShrink;
    default:
      return std::nullopt;
  }
}

PathMeasures from_wire(const path_measures_t& wire) {
  PathMeasures measures;
  measures.length_m = wire.length_m;
  measures.largest_deviation_m = wire.largest_deviation_m;
  measures.bending_energy_m2_per_s3 = wire.bending_energy_m2_per_s3;
  measures.largest_speed_m_per_s = wire.largest_speed_m_per_s;
  measures.largest_acceleration_m_per_s2 = wire.largest_acceleration_m_per_s2;
  measures.largest_turn_rate_rad_per_s = wire.largest_turn_rate_rad_per_s;
  measures.largest_turn_acceleration_rad_per_s2 = wire.largest_turn_acceleration_rad_per_s2;
  measures.clearance_lower_bound_m = wire.clearance_lower_bound_m;
  return measures;
}

KeyframeFault from_wire(const keyframe_fault_t& wire) {
  KeyframeFault fault;
  fault.keyframe = wire.keyframe;
  fault.depth_m = wire.depth_m;
  if (wire.has_free_pose == 0) return fault;
  Pose& pose = fault.free_pose.emplace();
  std::copy(std::begin(wire.free_position_m), std::end(wire.free_position_m),
            pose.position_m.begin());
  std::copy(std::begin(wire.free_orientation_wxyz), std::end(wire.free_orientation_wxyz),
            pose.orientation_wxyz.begin());
  return fault;
}

Cage from_wire(const cage_t& wire) {
  Cage cage;
  std::copy(std::begin(wire.orientation_wxyz), std::end(wire.orientation_wxyz),
            cage.orientation_wxyz.begin());
  std::copy(std::begin(wire.min_m), std::end(wire.min_m), cage.min_m.begin());
  std::copy(std::begin(wire.max_m), std::end(wire.max_m), cage.max_m.begin());
  cage.widest_hole_m = wire.widest_hole_m;
  cage.shortest_chord_m = wire.shortest_chord_m;
  return cage;
}

}  // namespace

void read_correction_head(const plan_response_t& page, PlanResponse& response) {
  if (page.has_measures_before != 0) response.measures_before = from_wire(page.measures_before);
  if (page.has_measures != 0) response.measures = from_wire(page.measures);
  response.bounds = from_wire(page.bounds);
  response.near_scale = page.near_scale;
  response.time_scale = page.time_scale;
  response.deadline_reached = page.deadline_reached != 0;
  if (page.has_infeasibility == 0) return;
  response.infeasibility = Infeasibility{page.keyframe_inside, page.keyframe_outside, {}};
  if (page.has_cage != 0) response.infeasibility->cage = from_wire(page.proof_cage);
}

std::optional<std::string> append_correction_lists(const plan_response_t& page,
                                                   PlanResponse& response) {
  for (const correction_t& wire : page.corrections) {
    const std::optional<Correction::Method> method = method_of(wire.method);
    if (!method) return "a correction by method " + std::to_string(wire.method);
    const Effort tried{wire.tried_directions, wire.tried_paths, wire.tried_lattice_points,
                       wire.tried_tree_samples};
    response.corrections.push_back({wire.t_begin_s, wire.t_end_s, *method, wire.changed_t_begin_s,
                                    wire.changed_t_end_s, wire.moved_m, wire.turned_rad, tried});
  }
  for (const slowed_stretch_t& wire : page.slowed) {
    response.slowed.push_back(
        {wire.t_begin_s, wire.t_end_s, wire.given_t_begin_s, wire.given_t_end_s});
  }
  for (const keyframe_fault_t& wire : page.keyframe_faults) {
    response.keyframe_faults.push_back(from_wire(wire));
  }
  if (response.infeasibility) {
    std::vector<std::int32_t>& triangles = response.infeasibility->triangles;
    triangles.insert(triangles.end(), page.proof_triangles.begin(), page.proof_triangles.end());
  }
  return std::nullopt;
}

}  // namespace camway
