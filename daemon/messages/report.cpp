// SPDX-License-Identifier: MIT
#include "daemon/messages/report.h"

#include <algorithm>
#include <optional>

#include "daemon/messages/bounds.h"

namespace camway::service {
namespace {

using correction::Correction;
using correction::CorrectionKind;
using motion::PathMeasures;
using planning::KeyframeFault;
using planning::PlanResult;

std::int8_t wire_method(CorrectionKind kind) {
  switch (kind) {
    case CorrectionKind::kNone:
      return correction_t::NONE;
    case CorrectionKind::kMove:
      return correction_t::MOVE;
    case CorrectionKind::kTurn:
      return correction_t::TURN;
    case CorrectionKind::kGoRound:
      return correction_t::GO_ROUND;
    case CorrectionKind::kShrink:
      return correction_t::SHRINK;
  }
  return correction_t::NONE;
}

std::optional<CorrectionKind> kind_of(std::int8_t wire) {
  for (const CorrectionKind kind :
       {CorrectionKind::kNone, CorrectionKind::kMove, CorrectionKind::kTurn,
        CorrectionKind::kGoRound, CorrectionKind::kShrink}) {
    if (wire_method(kind) == wire) return kind;
  }
  return std::nullopt;
}

correction_t wire_correction(const Correction& correction) {
  correction_t wire{};
  wire.t_begin_s = correction.interval.t_begin_s;
  wire.t_end_s = correction.interval.t_end_s;
  wire.method = wire_method(correction.kind);
  wire.changed_t_begin_s = correction.t_begin_s;
  wire.changed_t_end_s = correction.t_end_s;
  wire.moved_m = correction.moved_m;
  wire.turned_rad = correction.turned_rad;
  wire.tried_directions = correction.tried.directions;
  wire.tried_paths = correction.tried.paths;
  wire.tried_lattice_points = correction.tried.lattice_points;
  wire.tried_tree_samples = correction.tried.tree_samples;
  return wire;
}

Correction correction_of(const correction_t& wire, CorrectionKind kind) {
  Correction correction;
  correction.interval = {wire.t_begin_s, wire.t_end_s};
  correction.kind = kind;
  correction.t_begin_s = wire.changed_t_begin_s;
  correction.t_end_s = wire.changed_t_end_s;
  correction.moved_m = wire.moved_m;
  correction.turned_rad = wire.turned_rad;
  correction.tried = {wire.tried_directions, wire.tried_paths, wire.tried_lattice_points,
                      wire.tried_tree_samples};
  return correction;
}

path_measures_t wire_measures(const PathMeasures& measures) {
  path_measures_t wire{};
  wire.length_m = measures.length_m;
  wire.largest_deviation_m = measures.largest_deviation_m;
  wire.bending_energy_m2_per_s3 = measures.bending_energy_m2_per_s3;
  wire.largest_speed_m_per_s = measures.largest_speed_m_per_s;
  wire.largest_acceleration_m_per_s2 = measures.largest_acceleration_m_per_s2;
  wire.largest_turn_rate_rad_per_s = measures.largest_turn_rate_rad_per_s;
  wire.largest_turn_acceleration_rad_per_s2 = measures.largest_turn_acceleration_rad_per_s2;
  wire.clearance_lower_bound_m = measures.clearance_lower_bound_m;
  return wire;
}

PathMeasures measures_of(const path_measures_t& wire) {
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

slowed_stretch_t wire_slowed(const planning::SlowedStretch& stretch) {
  slowed_stretch_t wire{};
  wire.t_begin_s = stretch.t_begin_s;
  wire.t_end_s = stretch.t_end_s;
  wire.given_t_begin_s = stretch.given_t_begin_s;
  wire.given_t_end_s = stretch.given_t_end_s;
  return wire;
}

keyframe_fault_t wire_fault(const KeyframeFault& fault) {
  keyframe_fault_t wire{};
  wire.keyframe = static_cast<std::int32_t>(fault.keyframe);
  wire.depth_m = fault.depth_m;
  if (!fault.free_pose) return wire;
  wire.has_free_pose = 1;
  std::copy_n(fault.free_pose->position.data(), 3, wire.free_position_m);
  const geometry::Vec4 wxyz = geometry::wxyz(fault.free_pose->orientation);
  std::copy_n(wxyz.data(), 4, wire.free_orientation_wxyz);
  return wire;
}

KeyframeFault fault_of(const keyframe_fault_t& wire) {
  KeyframeFault fault;
  fault.keyframe = static_cast<std::size_t>(wire.keyframe);
  fault.depth_m = wire.depth_m;
  if (wire.has_free_pose == 0) return fault;
  motion::Pose& pose = fault.free_pose.emplace();
  std::copy_n(wire.free_position_m, 3, pose.position.data());
  geometry::Vec4 wxyz;
  std::copy_n(wire.free_orientation_wxyz, 4, wxyz.data());
  pose.orientation = geometry::from_wxyz(wxyz);
  return fault;
}

cage_t wire_cage(const correction::CageBox& cage) {
  cage_t wire{};
  const geometry::Vec4 wxyz = geometry::wxyz(cage.orientation);
  std::copy_n(wxyz.data(), 4, wire.orientation_wxyz);
  std::copy_n(cage.box.min().data(), 3, wire.min_m);
  std::copy_n(cage.box.max().data(), 3, wire.max_m);
  wire.widest_hole_m = cage.widest_hole_m;
  wire.shortest_chord_m = cage.shortest_chord_m;
  return wire;
}

correction::CageBox cage_of(const cage_t& wire) {
  correction::CageBox cage;
  geometry::Vec4 wxyz;
  std::copy_n(wire.orientation_wxyz, 4, wxyz.data());
  cage.orientation = geometry::from_wxyz(wxyz);
  std::copy_n(wire.min_m, 3, cage.box.min().data());
  std::copy_n(wire.max_m, 3, cage.box.max().data());
  cage.widest_hole_m = wire.widest_hole_m;
  cage.shortest_chord_m = wire.shortest_chord_m;
  return cage;
}

void put_infeasibility(const planning::Infeasibility& proof, plan_response_t& wire) {
  wire.has_infeasibility = 1;
  wire.keyframe_inside = static_cast<std::int32_t>(proof.keyframe_inside);
  wire.keyframe_outside = static_cast<std::int32_t>(proof.keyframe_outside);
  wire.has_cage = proof.cage ? 1 : 0;
  if (proof.cage) wire.proof_cage = wire_cage(*proof.cage);
  wire.proof_triangles.assign(proof.triangles.begin(), proof.triangles.end());
  wire.num_proof_triangles = static_cast<std::int32_t>(wire.proof_triangles.size());
}

std::string read_corrections(const plan_response_t& wire, PlanResult& result) {
  for (std::size_t i = 0; i < wire.corrections.size(); ++i) {
    const correction_t& correction = wire.corrections[i];
    const std::optional<CorrectionKind> kind = kind_of(correction.method);
    if (!kind) {
      return "corrections[" + std::to_string(i) + "].method: " + std::to_string(correction.method) +
             " is unknown";
    }
    result.corrections.push_back(correction_of(correction, *kind));
  }
  return {};
}

std::string read_faults(const plan_response_t& wire, PlanResult& result) {
  for (std::size_t i = 0; i < wire.keyframe_faults.size(); ++i) {
    if (wire.keyframe_faults[i].keyframe < 0) {
      return "keyframe_faults[" + std::to_string(i) + "].keyframe: is below 0";
    }
    result.keyframe_faults.push_back(fault_of(wire.keyframe_faults[i]));
  }
  return {};
}

std::string read_infeasibility(const plan_response_t& wire, PlanResult& result) {
  if (wire.has_infeasibility == 0) return {};
  if (wire.keyframe_inside < 0) return "keyframe_inside: is below 0";
  if (wire.keyframe_outside < 0) return "keyframe_outside: is below 0";
  planning::Infeasibility& proof = result.infeasibility.emplace();
  proof.keyframe_inside = static_cast<std::size_t>(wire.keyframe_inside);
  proof.keyframe_outside = static_cast<std::size_t>(wire.keyframe_outside);
  if (wire.has_cage != 0) proof.cage = cage_of(wire.proof_cage);
  for (std::size_t i = 0; i < wire.proof_triangles.size(); ++i) {
    const std::int32_t triangle = wire.proof_triangles[i];
    if (triangle < 0) return "proof_triangles[" + std::to_string(i) + "]: is below 0";
    proof.triangles.push_back(static_cast<std::uint32_t>(triangle));
  }
  return {};
}

}  // namespace

void put_report(const PlanResult& result, plan_response_t& wire) {
  for (const Correction& correction : result.corrections) {
    wire.corrections.push_back(wire_correction(correction));
  }
  wire.num_corrections = static_cast<std::int32_t>(wire.corrections.size());
  wire.has_measures_before = result.measures_before ? 1 : 0;
  if (result.measures_before) wire.measures_before = wire_measures(*result.measures_before);
  wire.has_measures = result.measures ? 1 : 0;
  if (result.measures) wire.measures = wire_measures(*result.measures);
  wire.bounds = wire_bounds(result.bounds);
  wire.near_scale = result.near_scale;
  wire.time_scale = result.time_scale;
  wire.deadline_reached = result.deadline_reached ? 1 : 0;
  for (const planning::SlowedStretch& stretch : result.slowed) {
    wire.slowed.push_back(wire_slowed(stretch));
  }
  wire.num_slowed = static_cast<std::int32_t>(wire.slowed.size());
  for (const KeyframeFault& fault : result.keyframe_faults) {
    wire.keyframe_faults.push_back(wire_fault(fault));
  }
  wire.num_keyframe_faults = static_cast<std::int32_t>(wire.keyframe_faults.size());
  if (result.infeasibility) put_infeasibility(*result.infeasibility, wire);
}

std::string read_report(const plan_response_t& wire, PlanResult& result) {
  if (wire.has_measures_before != 0) result.measures_before = measures_of(wire.measures_before);
  if (wire.has_measures != 0) result.measures = measures_of(wire.measures);
  result.bounds = bounds_of(wire.bounds);
  result.near_scale = wire.near_scale;
  result.time_scale = wire.time_scale;
  result.deadline_reached = wire.deadline_reached != 0;
  for (const slowed_stretch_t& stretch : wire.slowed) {
    result.slowed.push_back(
        {stretch.t_begin_s, stretch.t_end_s, stretch.given_t_begin_s, stretch.given_t_end_s});
  }
  std::string error = read_corrections(wire, result);
  if (error.empty()) error = read_faults(wire, result);
  if (error.empty()) error = read_infeasibility(wire, result);
  return error;
}

}  // namespace camway::service
