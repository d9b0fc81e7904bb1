// SPDX-License-Identifier: MIT
#include <utility>

#include "tools/json/json_io.h"
#include "tools/json/json_members.h"

namespace camway::tools {

using planning::PlanResult;

/// A collision with the names of its witness.
struct NamedInterval {
  collision::CollisionInterval interval;
  planning::WitnessNames names;
};

template <class Io>
void members(Io& io, Is<motion::Segment> auto& segment) {
  io.need("t0", segment.t0_s);
  io.need("t1", segment.t1_s);
  io.line(5);
  io.need("position", segment.position);
  io.line(5);
  io.need("orientation", segment.orientation);
}

template <class Io>
void members(Io& io, Is<motion::Pose> auto& pose) {
  io.need("position", pose.position);
  io.need("orientation", pose.orientation);
}

template <class Io>
void members(Io& io, Is<motion::Keyframe> auto& keyframe) {
  io.need("time", keyframe.time_s);
  members(io, keyframe.pose);
  io.need("origin", keyframe.origin);
  io.may("repaired", keyframe.is_repaired, keyframe.is_repaired);
}

template <class Io>
void members(Io& io, Is<NamedInterval> auto& collision) {
  io.need("t_begin", collision.interval.t_begin_s);
  io.need("t_end", collision.interval.t_end_s);
  io.line(5);
  auto& witness = collision.interval.witness;
  io.group("witness", witness.has_value(), -1, [&](auto& group) {
    if constexpr (std::same_as<Io, JsonReader>) witness.emplace();
    group.need("time", witness->time_s);
    group.need("object", collision.names.object);
    group.need("triangle", TriangleOrSide{witness->triangle});
    group.need("feature", collision.names.feature);
    group.need("depth_m", witness->depth_m, Old{"depth"});
    group.need("point", witness->point_W);
  });
}

template <class Io>
void members(Io& io, Is<correction::Effort> auto& effort) {
  io.need("directions", effort.directions);
  io.need("paths", effort.paths);
  io.need("lattice_points", effort.lattice_points);
  io.need("tree_samples", effort.tree_samples);
}

template <class Io>
void members(Io& io, Is<correction::Correction> auto& correction) {
  io.need("t_begin", correction.interval.t_begin_s);
  io.need("t_end", correction.interval.t_end_s);
  io.need("kind", correction.kind, Old{"method"});
  io.need("changed", Both{correction.t_begin_s, correction.t_end_s});
  io.need("moved_m", correction.moved_m);
  io.need("turned_deg", Angle{correction.turned_rad});
  io.line(5);
  io.may("tried", correction.tried, correction.kind == correction::CorrectionKind::kNone);
}

template <class Io>
void members(Io& io, Is<motion::PathMeasures> auto& measures) {
  io.need("length_m", measures.length_m);
  io.need("largest_deviation_m", measures.largest_deviation_m);
  io.need("bending_energy_m2_per_s3", measures.bending_energy_m2_per_s3);
  io.need("largest_speed_m_per_s", measures.largest_speed_m_per_s);
  io.need("largest_acceleration_m_per_s2", measures.largest_acceleration_m_per_s2);
  io.need("largest_turn_rate_deg_per_s", Angle{measures.largest_turn_rate_rad_per_s});
  io.need("largest_turn_acceleration_deg_per_s2",
          Angle{measures.largest_turn_acceleration_rad_per_s2});
  io.need("clearance_lower_bound_m", measures.clearance_lower_bound_m);
}

template <class Io>
void members(Io& io, Is<planning::SlowedStretch> auto& stretch) {
  io.need("t_begin", stretch.t_begin_s);
  io.need("t_end", stretch.t_end_s);
  io.need("given", Both{stretch.given_t_begin_s, stretch.given_t_end_s});
}

template <class Io>
void members(Io& io, Is<planning::KeyframeFault> auto& fault) {
  io.need("keyframe", fault.keyframe);
  io.need("depth_m", fault.depth_m, Old{"depth"});
  io.may("free_pose", fault.free_pose);
}

template <class Io>
void members(Io& io, Is<correction::CageBox> auto& cage) {
  io.need("orientation", cage.orientation);
  io.need("min", cage.box.min());
  io.need("max", cage.box.max());
  io.line(6);
  io.need("widest_hole_m", cage.widest_hole_m);
  io.need("shortest_chord_m", cage.shortest_chord_m);
}

template <class Io>
void members(Io& io, Is<planning::Infeasibility> auto& proof) {
  io.need("keyframe_inside", proof.keyframe_inside);
  io.need("keyframe_outside", proof.keyframe_outside);
  io.line(4);
  io.may("cage", proof.cage);
  io.line(4);
  io.need("triangles", proof.triangles);
}

template <class Io>
void members(Io& io, Is<planning::Certificate> auto& certificate) {
  io.need("certified", certificate.certified);
  io.may("clearance_lower_bound", certificate.clearance_lower_bound_m);
}

template <class Io>
void members(Io& io, Is<planning::Timing> auto& timing) {
  io.may("load_scene", timing.load_scene_ms);
  io.may("motion", timing.motion_ms);
  io.may("detect", timing.detect_ms);
  io.may("correct", timing.correct_ms);
  io.may("certify", timing.certify_ms);
  io.may("total", timing.total_ms);
}

namespace {

template <class Io, class Result>
void head(Io& io, Result& result) {
  io.need("status", result.status);
  io.may("message", result.message);
  io.may("keyframe", result.keyframe);
}

/// Lists the members after the collisions, except for the times that planning took.
template <class Io, class Result>
void report(Io& io, Result& result) {
  io.may("certificate", result.certificate);
  io.may("corrections", result.corrections);
  io.group("measures", result.measures_before || result.measures, 4, [&](auto& group) {
    group.may("before", result.measures_before);
    group.may("after", result.measures);
  });
  io.may("bounds", result.bounds, result.bounds.any());
  io.may("near_scale", result.near_scale, result.near_scale != 1.0);
  io.may("time_scale", result.time_scale, result.time_scale != 1.0);
  io.may("deadline_reached", result.deadline_reached, result.deadline_reached);
  io.may("slowed", result.slowed, !result.slowed.empty());
  io.may("keyframe_faults", result.keyframe_faults, !result.keyframe_faults.empty());
  io.may("infeasibility", result.infeasibility);
}

/// Joins intervals and names. `names` may be shorter if witnesses have no names.
std::vector<NamedInterval> named(const std::vector<collision::CollisionInterval>& intervals,
                                 const std::vector<planning::WitnessNames>& names) {
  std::vector<NamedInterval> list;
  for (const collision::CollisionInterval& interval : intervals) {
    const std::size_t i = list.size();
    list.push_back({interval, i < names.size() ? names[i] : planning::WitnessNames{}});
  }
  return list;
}

void read_intervals(JsonReader& io, std::string_view name,
                    std::vector<collision::CollisionInterval>& intervals,
                    std::vector<planning::WitnessNames>& names) {
  std::vector<NamedInterval> list;
  io.may(name, list);
  for (NamedInterval& collision : list) {
    intervals.push_back(collision.interval);
    names.push_back(std::move(collision.names));
  }
}

PlanResult read_result(const Field& root) {
  JsonReader io(root);
  PlanResult result;
  head(io, result);
  std::vector<motion::Segment> segments;
  if (const auto list = root.optional_member("segments")) segments = read_segments(*list);
  // A path requires valid segments.
  if (!root.failed()) result.path = motion::Path(std::move(segments));
  io.may("keyframes", result.keyframes);
  read_intervals(io, "collisions", result.collisions, result.collision_names);
  read_intervals(io, "remaining_collisions", result.remaining_collisions, result.remaining_names);
  report(io, result);
  io.may("timing_ms", result.timing);
  return result;
}

}  // namespace

base::Result<std::string> write_plan_response(const PlanResult& result,
                                              const ResponseFormat& format) {
  std::string out;
  JsonWriter io(out);
  io.object(2, [&] {
    head(io, result);
    io.may("scene", format.scene, !format.scene.empty());
    io.may("scene_digest", format.scene_digest, !format.scene_digest.empty());
    io.may("warnings", format.warnings, !format.warnings.empty());
    io.need("segments", result.path.segments());
    io.need("keyframes", result.keyframes);
    io.need("collisions", named(result.collisions, result.collision_names));
    io.need("remaining_collisions", named(result.remaining_collisions, result.remaining_names));
    report(io, result);
    io.may("timing_ms", result.timing, format.timing == TimingField::kWritten);
  });
  out += '\n';
  if (!io.error().empty()) return base::Failure{io.error()};
  return out;
}

base::Result<PlanResult> parse_plan_response(std::string_view text, std::string_view source) {
  return parse_as(read_result, text, source);
}

base::Result<PlanResult> read_plan_response(const std::string& file) {
  return read_as(read_result, file);
}

}  // namespace camway::tools
