// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "daemon/planning/request/field_spec.h"
#include "daemon/planning/result/result.h"
#include "daemon/planning/result/witness_names.h"

/// The members of answers: one list for each struct, which files and messages follow in both
/// directions. A list is a function `members(io, mine, wire...)` that calls
/// `io(name, mine.member, wire.member...)` for each member. `name` is the name in files. `wire` is
/// the corresponding message; it is left out where `io` reads or writes a file, and there are two
/// where `io` compares messages. `io` has two more functions:
///  - `group(name, indent, list)` handles members that are an object of their own in files alone;
///    `list(io)` lists them;
///  - `optional(name, mine, list, has...)` handles an optional struct, which a message marks by the
///    flag `has`; `list(io, *mine)` lists its members;
/// A number whose name contains `_deg` is an angle: in degrees in files, in radians elsewhere. A
/// pair of numbers (`std::tie`) is an array in files.
namespace camway::planning {

/// How files have a member. Its constructors are implicit, so that the lists below read as lists of
/// names.
struct FileName {
  constexpr FileName(const char* name_now, std::string_view old_name = {})
      : name(name_now), old(old_name) {}
  constexpr FileName(const FieldSpec& spec)
      : name(spec.file_name()), old(spec.old_file), is_needed(spec.is_needed) {}
  std::string_view name;
  std::string_view old;    ///< earlier name, which is still read
  bool is_needed = true;   ///< a file without the member is refused
  bool is_written = true;  ///< false: files leave the member out
  int line = -1;           ///< `indent` of `on_line`; -1: the member begins no line of its own
};
/// Returns the name of a member that files may lack, and that is left out if `is_written` is false.
constexpr FileName may_lack(FileName name, bool is_written = true) {
  name.is_needed = false;
  name.is_written = is_written;
  return name;
}
/// Returns the name of a member that begins a line of a file, after `indent` spaces.
constexpr FileName on_line(int indent, FileName name) {
  name.line = indent;
  return name;
}

template <class Io, class... Wire>
void members(Io& io, Is<motion::Segment> auto& segment, Wire&... wire) {
  io("t0", segment.t0_s, wire.t0_s...);
  io("t1", segment.t1_s, wire.t1_s...);
  io(on_line(5, "position"), segment.position, wire.position_m...);
  io(on_line(5, "orientation"), segment.orientation, wire.orientation_wxyz...);
}

template <class Io, class... Wire>
void members(Io& io, Is<motion::Keyframe> auto& keyframe, Wire&... wire) {
  io("time", keyframe.time_s, wire.time_s...);
  io("position", keyframe.pose.position, wire.position_m...);
  io("orientation", keyframe.pose.orientation, wire.orientation_wxyz...);
  io("origin", keyframe.origin, wire.origin...);
  io(may_lack("repaired", keyframe.is_repaired), keyframe.is_repaired, wire.repaired...);
  io(may_lack("image", !keyframe.image.isZero(0.0)), keyframe.image, wire.image...);
}

template <class Io, class... Wire>
void members(Io& io, Is<motion::PathEnd> auto& end, Wire&... wire) {
  io("velocity_m_per_s", end.velocity_m_per_s, wire.velocity_m_per_s...);
  io("image_rate_per_s", end.image_rate_per_s, wire.image_rate_per_s...);
}

template <class Io, class... Wire>
void members(Io& io, Is<motion::PathFrame> auto& frame, Wire&... wire) {
  io("reference", frame.reference, wire.reference_wxyz...);
  io(on_line(4, "begin"), frame.begin, wire.begin...);
  io(on_line(4, "end"), frame.end, wire.end...);
}

template <class Io, class... Wire>
void members(Io& io, Is<NamedCollision> auto& collision, Wire&... wire) {
  io("t_begin", collision.interval.t_begin_s, wire.t_begin_s...);
  io("t_end", collision.interval.t_end_s, wire.t_end_s...);
  const auto list = [&](auto& object, auto& witness) {
    object("time", witness.time_s, wire.witness_time_s...);
    object("object", collision.names.object, wire.witness_object...);
    object("triangle", witness.triangle, wire.witness_triangle...);
    object("feature", collision.names.feature, wire.witness_feature...);
    object({"depth_m", "depth"}, witness.depth_m, wire.witness_depth_m...);
    object("point", witness.point_W, wire.witness_point_m...);
  };
  io.optional(on_line(5, "witness"), collision.interval.witness, list, wire.has_witness...);
}

/// Files have the effort only of a collision that was not corrected. Those of earlier versions lack
/// the shift, here and in measures.
template <class Io, class... Wire>
void members(Io& io, Is<correction::Correction> auto& correction, Wire&... wire) {
  io("t_begin", correction.interval.t_begin_s, wire.t_begin_s...);
  io("t_end", correction.interval.t_end_s, wire.t_end_s...);
  io({"kind", "method"}, correction.kind, wire.method...);
  io("changed", std::tie(correction.t_begin_s, correction.t_end_s),
     std::tie(wire.changed_t_begin_s, wire.changed_t_end_s)...);
  io("moved_m", correction.moved_m, wire.moved_m...);
  io("turned_deg", correction.turned_rad, wire.turned_rad...);
  io(may_lack("largest_shift_deg"), correction.shift.largest_rad, wire.largest_shift_rad...);
  io(may_lack("mean_shift_deg"), correction.shift.mean_rad, wire.mean_shift_rad...);
  const bool is_said = correction.kind == correction::CorrectionKind::kNone;
  io.group(on_line(5, may_lack("tried", is_said)), -1, [&](auto& object) {
    object("directions", correction.tried.directions, wire.tried_directions...);
    object("paths", correction.tried.paths, wire.tried_paths...);
    object("lattice_points", correction.tried.lattice_points, wire.tried_lattice_points...);
    object("tree_samples", correction.tried.tree_samples, wire.tried_tree_samples...);
  });
}

/// Files leave out a shift that was not measured; messages have 0 then.
template <class Io, class... Wire>
void path_measures_members(Io& io, Is<motion::PathMeasures> auto& measures, bool is_shift_measured,
                           Wire&... wire) {
  io("length_m", measures.length_m, wire.length_m...);
  io("largest_deviation_m", measures.largest_deviation_m, wire.largest_deviation_m...);
  io(may_lack("largest_shift_deg", is_shift_measured), measures.largest_shift_rad,
     wire.largest_shift_rad...);
  io(may_lack("mean_shift_deg", is_shift_measured), measures.mean_shift_rad,
     wire.mean_shift_rad...);
  io("bending_energy_m2_per_s3", measures.bending_energy_m2_per_s3,
     wire.bending_energy_m2_per_s3...);
  io("largest_speed_m_per_s", measures.largest_speed_m_per_s, wire.largest_speed_m_per_s...);
  io("largest_acceleration_m_per_s2", measures.largest_acceleration_m_per_s2,
     wire.largest_acceleration_m_per_s2...);
  io("largest_turn_rate_deg_per_s", measures.largest_turn_rate_rad_per_s,
     wire.largest_turn_rate_rad_per_s...);
  io("largest_turn_acceleration_deg_per_s2", measures.largest_turn_acceleration_rad_per_s2,
     wire.largest_turn_acceleration_rad_per_s2...);
  io("clearance_lower_bound_m", measures.clearance_lower_bound_m, wire.clearance_lower_bound_m...);
}

template <class Io, class... Wire>
void members(Io& io, Is<SlowedStretch> auto& stretch, Wire&... wire) {
  io("t_begin", stretch.t_begin_s, wire.t_begin_s...);
  io("t_end", stretch.t_end_s, wire.t_end_s...);
  io("given", std::tie(stretch.given_t_begin_s, stretch.given_t_end_s),
     std::tie(wire.given_t_begin_s, wire.given_t_end_s)...);
}

template <class Io, class... Wire>
void members(Io& io, Is<collision::ClearanceStretch> auto& stretch, Wire&... wire) {
  io("t_begin", stretch.t_begin_s, wire.t_begin_s...);
  io("t_end", stretch.t_end_s, wire.t_end_s...);
  io("clearance_m", stretch.clearance_m, wire.clearance_m...);
}

template <class Io, class... Wire>
void members(Io& io, Is<KeyframeFault> auto& fault, Wire&... wire) {
  io("keyframe", fault.keyframe, wire.keyframe...);
  io({"depth_m", "depth"}, fault.depth_m, wire.depth_m...);
  const auto list = [&](auto& object, auto& pose) {
    object("position", pose.position, wire.free_position_m...);
    object("orientation", pose.orientation, wire.free_orientation_wxyz...);
  };
  io.optional("free_pose", fault.free_pose, list, wire.has_free_pose...);
}

template <class Io, class... Wire>
void members(Io& io, Is<correction::CageBox> auto& cage, Wire&... wire) {
  io("orientation", cage.orientation, wire.orientation_wxyz...);
  io("min", cage.box.min(), wire.min_m...);
  io("max", cage.box.max(), wire.max_m...);
  io(on_line(6, "widest_hole_m"), cage.widest_hole_m, wire.widest_hole_m...);
  io("shortest_chord_m", cage.shortest_chord_m, wire.shortest_chord_m...);
}

/// `wire` is the whole answer, of which the proof is a part.
template <class Io, class... Wire>
void members(Io& io, Is<Infeasibility> auto& proof, Wire&... wire) {
  io("keyframe_inside", proof.keyframe_inside, wire.keyframe_inside...);
  io("keyframe_outside", proof.keyframe_outside, wire.keyframe_outside...);
  const auto list = [&](auto& object, auto& cage) { members(object, cage, wire.proof_cage...); };
  io.optional(on_line(4, "cage"), proof.cage, list, wire.has_cage...);
  io(on_line(4, "triangles"), proof.triangles, wire.proof_triangles...);
}

template <class Io, class... Wire>
void members(Io& io, Is<Timing> auto& timing, Wire&... wire) {
  if constexpr (sizeof...(Wire) == 0) io(may_lack("load_scene"), timing.load_scene_ms);
  io(may_lack("motion"), timing.motion_ms, wire.motion_ms...);
  io(may_lack("detect"), timing.detect_ms, wire.detect_ms...);
  io(may_lack("correct"), timing.correct_ms, wire.correct_ms...);
  io(may_lack("certify"), timing.certify_ms, wire.certify_ms...);
  io(may_lack("total"), timing.total_ms, wire.total_ms...);
}

/// Collisions with the names of their witnesses, which a result has in a list of its own.
template <class Io, class Collisions, class Names, class... Wire>
void named_collisions(Io& io, FileName name, Collisions& collisions, Names& names, Wire&... wire) {
  if constexpr (std::is_const_v<Collisions>) {
    io(name, with_names(collisions, names), wire...);
  } else {
    std::vector<NamedCollision> list;
    io(may_lack(name), list, wire...);
    append(std::move(list), collisions, names);
  }
}

/// The members of a result in the order of files: those before the path, and those after it. The
/// path is no plain list: its reader checks it.
template <class Io, class... Wire>
void head_members(Io& io, Is<PlanResult> auto& result, Wire&... wire) {
  io("status", result.status, wire.status...);
  io(may_lack("message"), result.message, wire.message...);
  io(may_lack("keyframe", result.keyframe.has_value()), result.keyframe, wire.keyframe...);
}

/// Whether the shift of the returned path is known. The method `keyframe_insertion` measures none:
/// a shift of 0 is one only with a viewing distance, or of a path that nothing was inserted into.
inline bool has_measured_shift(const PlanResult& result, const motion::PathMeasures& measures) {
  const auto is_inserted = [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  };
  return result.viewing_distance_m || measures.largest_shift_rad > 0.0 ||
         measures.mean_shift_rad > 0.0 || std::ranges::none_of(result.keyframes, is_inserted);
}

template <class Io, class... Wire>
void measures_members(Io& io, Is<PlanResult> auto& result, Wire&... wire) {
  const auto before = [&](auto& object, auto& measures) {
    path_measures_members(object, measures, /*is_shift_measured=*/true, wire.measures_before...);
  };
  io.optional("before", result.measures_before, before, wire.has_measures_before...);
  const auto after = [&](auto& object, auto& measures) {
    path_measures_members(object, measures, has_measured_shift(result, measures), wire.measures...);
  };
  io.optional("after", result.measures, after, wire.has_measures...);
}

template <class Io, class... Wire>
void report_members(Io& io, Is<PlanResult> auto& result, Wire&... wire) {
  named_collisions(io, "collisions", result.collisions, result.collision_names, wire.collisions...);
  named_collisions(io, "remaining_collisions", result.remaining_collisions, result.remaining_names,
                   wire.remaining...);
  const auto frame = [&](auto& object, auto& mine) { members(object, mine, wire.frame...); };
  io.optional("frame", result.frame, frame, wire.has_frame...);
  io.group("certificate", -1, [&](auto& object) {
    object("certified", result.certificate.certified, wire.certified...);
    object(may_lack("clearance_lower_bound"), result.certificate.clearance_lower_bound_m,
           wire.clearance_lower_bound_m...);
  });
  io(may_lack("corrections"), result.corrections, wire.corrections...);
  io.group(may_lack("measures", result.measures_before || result.measures), 4,
           [&](auto& object) { measures_members(object, result, wire...); });
  io(may_lack("viewing_distance_m", result.viewing_distance_m.has_value()),
     result.viewing_distance_m, wire.viewing_distance_m...);
  io(may_lack("bounds", result.bounds.any()), result.bounds, wire.bounds...);
  io(may_lack("near_scale", result.near_scale != 1.0), result.near_scale, wire.near_scale...);
  io(may_lack("time_scale", result.time_scale != 1.0), result.time_scale, wire.time_scale...);
  io(may_lack("deadline_reached", result.deadline_reached), result.deadline_reached,
     wire.deadline_reached...);
  io(may_lack("slowed", !result.slowed.empty()), result.slowed, wire.slowed...);
  io(may_lack("clearance_profile", !result.clearance_profile.empty()), result.clearance_profile,
     wire.clearance_profile...);
  io(may_lack("keyframe_faults", !result.keyframe_faults.empty()), result.keyframe_faults,
     wire.keyframe_faults...);
  const auto proof = [&](auto& object, auto& mine) { members(object, mine, wire...); };
  io.optional("infeasibility", result.infeasibility, proof, wire.has_infeasibility...);
}

}  // namespace camway::planning
