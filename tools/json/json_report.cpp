// SPDX-License-Identifier: MIT
#include "tools/json/json_report.h"

#include <cstdint>
#include <limits>
#include <string>

#include "daemon/planning/request.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_options.h"

namespace camway::tools {
namespace {

using correction::Correction;
using correction::CorrectionKind;
using motion::PathMeasures;

CorrectionKind read_method(const Field& field) {
  const std::string name = field.text();
  for (const CorrectionKind kind :
       {CorrectionKind::kNone, CorrectionKind::kMove, CorrectionKind::kTurn,
        CorrectionKind::kGoRound, CorrectionKind::kShrink}) {
    if (correction::to_string(kind) == name) return kind;
  }
  field.fail("'" + name + "' is unknown");
  return CorrectionKind::kNone;
}

correction::Effort read_effort(const Field& field) {
  const auto count = [&](const char* name) {
    return static_cast<std::int32_t>(
        field.member(name).integer(0, std::numeric_limits<std::int32_t>::max()));
  };
  return {count("directions"), count("paths"), count("lattice_points"), count("tree_samples")};
}

Correction read_correction(const Field& field) {
  Correction correction;
  correction.interval = {field.member("t_begin").number(), field.member("t_end").number()};
  correction.kind = read_method(field.member("method"));
  double changed_s[2];
  field.member("changed").numbers(changed_s, 2);
  correction.t_begin_s = changed_s[0];
  correction.t_end_s = changed_s[1];
  correction.moved_m = field.member("moved_m").number();
  correction.turned_rad = radians(field.member("turned_deg").number());
  if (const auto tried = field.optional_member("tried")) correction.tried = read_effort(*tried);
  return correction;
}

PathMeasures read_measures(const Field& field) {
  PathMeasures measures;
  measures.length_m = field.member("length_m").number();
  measures.largest_deviation_m = field.member("largest_deviation_m").number();
  measures.bending_energy_m2_per_s3 = field.member("bending_energy_m2_per_s3").number();
  measures.largest_speed_m_per_s = field.member("largest_speed_m_per_s").number();
  measures.largest_acceleration_m_per_s2 = field.member("largest_acceleration_m_per_s2").number();
  measures.largest_turn_rate_rad_per_s =
      radians(field.member("largest_turn_rate_deg_per_s").number());
  measures.largest_turn_acceleration_rad_per_s2 =
      radians(field.member("largest_turn_acceleration_deg_per_s2").number());
  measures.clearance_lower_bound_m = field.member("clearance_lower_bound_m").number();
  return measures;
}

std::size_t read_keyframe_index(const Field& field) {
  return static_cast<std::size_t>(field.integer(0, planning::kMaxKeyframes));
}

planning::KeyframeFault read_fault(const Field& field) {
  planning::KeyframeFault fault;
  fault.keyframe = read_keyframe_index(field.member("keyframe"));
  fault.depth_m = field.member("depth").number();
  if (const auto free_pose = field.optional_member("free_pose")) {
    motion::Pose& pose = fault.free_pose.emplace();
    free_pose->member("position").numbers(pose.position.data(), 3);
    geometry::Vec4 wxyz;
    free_pose->member("orientation").numbers(wxyz.data(), 4);
    pose.orientation = geometry::from_wxyz(wxyz);
  }
  return fault;
}

planning::SlowedStretch read_slowed(const Field& field) {
  double given_s[2] = {};
  field.member("given").numbers(given_s, 2);
  return {field.member("t_begin").number(), field.member("t_end").number(), given_s[0], given_s[1]};
}

correction::CageBox read_cage(const Field& field) {
  correction::CageBox cage;
  geometry::Vec4 wxyz;
  field.member("orientation").numbers(wxyz.data(), 4);
  cage.orientation = geometry::from_wxyz(wxyz);
  field.member("min").numbers(cage.box.min().data(), 3);
  field.member("max").numbers(cage.box.max().data(), 3);
  cage.widest_hole_m = field.member("widest_hole_m").number();
  cage.shortest_chord_m = field.member("shortest_chord_m").number();
  return cage;
}

planning::Infeasibility read_infeasibility(const Field& field) {
  planning::Infeasibility proof;
  proof.keyframe_inside = read_keyframe_index(field.member("keyframe_inside"));
  proof.keyframe_outside = read_keyframe_index(field.member("keyframe_outside"));
  if (const auto cage = field.optional_member("cage")) proof.cage = read_cage(*cage);
  const Field triangles = field.member("triangles");
  const std::size_t count = triangles.size();
  for (std::size_t i = 0; i < count && !field.failed(); ++i) {
    proof.triangles.push_back(static_cast<std::uint32_t>(
        triangles.element(i).integer(0, std::numeric_limits<std::uint32_t>::max())));
  }
  return proof;
}

}  // namespace

void read_report(const Field& root, planning::PlanResult& result) {
  if (const auto list = root.optional_member("corrections")) {
    const std::size_t count = list->size();
    for (std::size_t i = 0; i < count && !list->failed(); ++i) {
      result.corrections.push_back(read_correction(list->element(i)));
    }
  }
  if (const auto measures = root.optional_member("measures")) {
    const auto before = measures->optional_member("before");
    if (before) result.measures_before = read_measures(*before);
    const auto after = measures->optional_member("after");
    if (after) result.measures = read_measures(*after);
  }
  if (const auto bounds = root.optional_member("bounds")) result.bounds = read_bounds(*bounds);
  if (const auto scale = root.optional_member("near_scale")) result.near_scale = scale->number();
  if (const auto scale = root.optional_member("time_scale")) result.time_scale = scale->number();
  if (const auto reached = root.optional_member("deadline_reached")) {
    result.deadline_reached = reached->boolean();
  }
  if (const auto list = root.optional_member("slowed")) {
    const std::size_t count = list->size();
    for (std::size_t i = 0; i < count && !list->failed(); ++i) {
      result.slowed.push_back(read_slowed(list->element(i)));
    }
  }
  if (const auto list = root.optional_member("keyframe_faults")) {
    const std::size_t count = list->size();
    for (std::size_t i = 0; i < count && !list->failed(); ++i) {
      result.keyframe_faults.push_back(read_fault(list->element(i)));
    }
  }
  if (const auto proof = root.optional_member("infeasibility")) {
    result.infeasibility = read_infeasibility(*proof);
  }
}

}  // namespace camway::tools
