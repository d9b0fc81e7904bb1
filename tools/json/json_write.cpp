// SPDX-License-Identifier: MIT
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "daemon/collision/obstacles.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_io.h"

namespace camway::tools {
namespace {

using motion::Keyframe;

/// Builds the text of a response. Each small object (a keyframe, an interval) is on one line, so
/// that a person can read a long path and `diff` can compare two.
class Writer {
 public:
  explicit Writer(std::string& out) : out_(out) {}

  void raw(std::string_view text) { out_ += text; }

  /// Writes the shortest decimal that reads back as the same double, always with a point or an
  /// exponent: otherwise readers take -0 for the integer 0 and lose the sign.
  void number(double value, std::string_view what) {
    if (!std::isfinite(value)) {
      if (error_.empty()) error_ = std::string(what) + ": is not finite";
      return;
    }
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    const std::string_view text(digits, static_cast<std::size_t>(end - digits));
    out_ += text;
    if (text.find_first_of(".e") == std::string_view::npos) out_ += ".0";
  }

  void text(std::string_view value) {
    out_ += nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }

  template <typename Vector>
  void vector(const Vector& v, std::string_view what) {
    out_ += '[';
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (i > 0) out_ += ", ";
      number(v[i], what);
    }
    out_ += ']';
  }

  template <typename Points>
  void points(const Points& points, std::string_view what) {
    out_ += '[';
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i > 0) out_ += ", ";
      vector(points[i], what);
    }
    out_ += ']';
  }

  /// Writes an array with one item on each line.
  template <typename List, typename WriteItem>
  void list(const List& items, WriteItem write_item) {
    bool first = true;
    out_ += '[';
    for (const auto& item : items) {
      out_ += first ? "\n    " : ",\n    ";
      first = false;
      write_item(item);
    }
    out_ += first ? "]" : "\n  ]";
  }

  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  std::string& out_;
  std::string error_;
};

void write_segment(Writer& w, const motion::Segment& segment) {
  w.raw("{\"t0\": ");
  w.number(segment.t0_s, "segments[].t0");
  w.raw(", \"t1\": ");
  w.number(segment.t1_s, "segments[].t1");
  w.raw(",\n     \"position\": ");
  w.points(segment.position, "segments[].position");
  w.raw(",\n     \"orientation\": ");
  w.points(segment.orientation, "segments[].orientation");
  w.raw("}");
}

void write_keyframe(Writer& w, const Keyframe& keyframe) {
  w.raw("{\"time\": ");
  w.number(keyframe.time_s, "keyframes[].time");
  w.raw(", \"position\": ");
  w.vector(keyframe.pose.position, "keyframes[].position");
  w.raw(", \"orientation\": ");
  w.vector(geometry::wxyz(keyframe.pose.orientation), "keyframes[].orientation");
  const bool inserted = keyframe.origin == motion::KeyframeOrigin::kInserted;
  w.raw(inserted ? ", \"origin\": \"inserted\"" : ", \"origin\": \"given\"");
  w.raw(keyframe.is_repaired ? ", \"repaired\": true}" : "}");
}

void write_witness(Writer& w, const collision::Witness& witness,
                   const planning::WitnessNames& names, std::string_view what) {
  w.raw(",\n     \"witness\": {\"time\": ");
  w.number(witness.time_s, what);
  w.raw(", \"object\": ");
  w.text(names.object);
  w.raw(", \"triangle\": " + std::to_string(collision::Obstacles::signed_number(witness.triangle)) +
        ", \"feature\": ");
  w.text(names.feature);
  w.raw(", \"depth\": ");
  w.number(witness.depth_m, what);
  w.raw(", \"point\": ");
  w.vector(witness.point_W, what);
  w.raw("}");
}

/// Writes collision intervals. `names` may be shorter than `intervals` if witnesses have no names.
void write_intervals(Writer& w, const std::vector<collision::CollisionInterval>& intervals,
                     const std::vector<planning::WitnessNames>& names, std::string_view what) {
  std::size_t i = 0;
  w.list(intervals, [&](const collision::CollisionInterval& interval) {
    w.raw("{\"t_begin\": ");
    w.number(interval.t_begin_s, what);
    w.raw(", \"t_end\": ");
    w.number(interval.t_end_s, what);
    if (interval.witness) {
      write_witness(w, *interval.witness, i < names.size() ? names[i] : planning::WitnessNames{},
                    what);
    }
    w.raw("}");
    ++i;
  });
}

/// Writes an object with finite values on one line.
void write_numbers(Writer& w, std::initializer_list<std::pair<const char*, double>> members,
                   std::string_view what) {
  bool first = true;
  w.raw("{");
  for (const auto& [name, value] : members) {
    if (!first) w.raw(", ");
    first = false;
    w.raw("\"");
    w.raw(name);
    w.raw("\": ");
    w.number(value, what);
  }
  w.raw("}");
}

void write_effort(Writer& w, const correction::Effort& effort) {
  w.raw(",\n     \"tried\": {\"directions\": " + std::to_string(effort.directions) +
        ", \"paths\": " + std::to_string(effort.paths) +
        ", \"lattice_points\": " + std::to_string(effort.lattice_points) +
        ", \"tree_samples\": " + std::to_string(effort.tree_samples) + "}");
}

void write_correction(Writer& w, const correction::Correction& correction) {
  constexpr std::string_view kWhat = "corrections";
  w.raw("{\"t_begin\": ");
  w.number(correction.interval.t_begin_s, kWhat);
  w.raw(", \"t_end\": ");
  w.number(correction.interval.t_end_s, kWhat);
  w.raw(", \"method\": ");
  w.text(correction::to_string(correction.kind));
  w.raw(", \"changed\": [");
  w.number(correction.t_begin_s, kWhat);
  w.raw(", ");
  w.number(correction.t_end_s, kWhat);
  w.raw("], \"moved_m\": ");
  w.number(correction.moved_m, kWhat);
  w.raw(", \"turned_deg\": ");
  w.number(degrees(correction.turned_rad), kWhat);
  if (correction.kind == correction::CorrectionKind::kNone) write_effort(w, correction.tried);
  w.raw("}");
}

void write_slowed(Writer& w, const planning::SlowedStretch& stretch) {
  constexpr std::string_view kWhat = "slowed";
  w.raw("{\"t_begin\": ");
  w.number(stretch.t_begin_s, kWhat);
  w.raw(", \"t_end\": ");
  w.number(stretch.t_end_s, kWhat);
  w.raw(", \"given\": [");
  w.number(stretch.given_t_begin_s, kWhat);
  w.raw(", ");
  w.number(stretch.given_t_end_s, kWhat);
  w.raw("]}");
}

void write_measures(Writer& w, const motion::PathMeasures& measures) {
  write_numbers(w,
                {{"length_m", measures.length_m},
                 {"largest_deviation_m", measures.largest_deviation_m},
                 {"bending_energy_m2_per_s3", measures.bending_energy_m2_per_s3},
                 {"largest_speed_m_per_s", measures.largest_speed_m_per_s},
                 {"largest_acceleration_m_per_s2", measures.largest_acceleration_m_per_s2},
                 {"largest_turn_rate_deg_per_s", degrees(measures.largest_turn_rate_rad_per_s)},
                 {"largest_turn_acceleration_deg_per_s2",
                  degrees(measures.largest_turn_acceleration_rad_per_s2)},
                 {"clearance_lower_bound_m", measures.clearance_lower_bound_m}},
                "measures");
}

void write_both_measures(Writer& w, const planning::PlanResult& result) {
  if (!result.measures_before && !result.measures) return;
  w.raw(",\n  \"measures\": {");
  if (result.measures_before) {
    w.raw("\n    \"before\": ");
    write_measures(w, *result.measures_before);
  }
  if (result.measures) {
    w.raw(result.measures_before ? ",\n    \"after\": " : "\n    \"after\": ");
    write_measures(w, *result.measures);
  }
  w.raw("\n  }");
}

void write_keyframe_fault(Writer& w, const planning::KeyframeFault& fault) {
  constexpr std::string_view kWhat = "keyframe_faults";
  w.raw("{\"keyframe\": " + std::to_string(fault.keyframe) + ", \"depth\": ");
  w.number(fault.depth_m, kWhat);
  if (fault.free_pose) {
    w.raw(", \"free_pose\": {\"position\": ");
    w.vector(fault.free_pose->position, kWhat);
    w.raw(", \"orientation\": ");
    w.vector(geometry::wxyz(fault.free_pose->orientation), kWhat);
    w.raw("}");
  }
  w.raw("}");
}

void write_cage(Writer& w, const correction::CageBox& cage) {
  constexpr std::string_view kWhat = "infeasibility.cage";
  w.raw("\"cage\": {\"orientation\": ");
  w.vector(geometry::wxyz(cage.orientation), kWhat);
  w.raw(", \"min\": ");
  w.vector(cage.box.min(), kWhat);
  w.raw(", \"max\": ");
  w.vector(cage.box.max(), kWhat);
  w.raw(",\n      \"widest_hole_m\": ");
  w.number(cage.widest_hole_m, kWhat);
  w.raw(", \"shortest_chord_m\": ");
  w.number(cage.shortest_chord_m, kWhat);
  w.raw("},\n    ");
}

void write_infeasibility(Writer& w, const planning::Infeasibility& proof) {
  w.raw(",\n  \"infeasibility\": {\"keyframe_inside\": " + std::to_string(proof.keyframe_inside) +
        ", \"keyframe_outside\": " + std::to_string(proof.keyframe_outside) + ",\n    ");
  if (proof.cage) write_cage(w, *proof.cage);
  w.raw("\"triangles\": [");
  bool first = true;
  for (const std::uint32_t triangle : proof.triangles) {
    if (!first) w.raw(", ");
    first = false;
    w.raw(std::to_string(triangle));
  }
  w.raw("]}");
}

/// Writes a corner of bounds, with null for a side without a limit.
void write_corner(Writer& w, const geometry::Vec3& corner_W) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    w.raw(axis == 0 ? "[" : ", ");
    if (std::isfinite(corner_W[axis])) {
      w.number(corner_W[axis], "bounds");
    } else {
      w.raw("null");
    }
  }
  w.raw("]");
}

void write_bounds(Writer& w, const geometry::Bounds& bounds) {
  if (!bounds.any()) return;
  w.raw(",\n  \"bounds\": {\"min\": ");
  write_corner(w, bounds.min_W);
  w.raw(", \"max\": ");
  write_corner(w, bounds.max_W);
  w.raw("}");
}

/// Writes the corrections, measures and faults.
void write_report(Writer& w, const planning::PlanResult& result) {
  w.raw(",\n  \"corrections\": ");
  w.list(result.corrections, [&](const correction::Correction& c) { write_correction(w, c); });
  write_both_measures(w, result);
  write_bounds(w, result.bounds);
  if (result.near_scale != 1.0) {
    w.raw(",\n  \"near_scale\": ");
    w.number(result.near_scale, "near_scale");
  }
  if (result.time_scale != 1.0) {
    w.raw(",\n  \"time_scale\": ");
    w.number(result.time_scale, "time_scale");
  }
  if (result.deadline_reached) w.raw(",\n  \"deadline_reached\": true");
  if (!result.slowed.empty()) {
    w.raw(",\n  \"slowed\": ");
    w.list(result.slowed, [&](const planning::SlowedStretch& s) { write_slowed(w, s); });
  }
  if (!result.keyframe_faults.empty()) {
    w.raw(",\n  \"keyframe_faults\": ");
    w.list(result.keyframe_faults,
           [&](const planning::KeyframeFault& fault) { write_keyframe_fault(w, fault); });
  }
  if (result.infeasibility) write_infeasibility(w, *result.infeasibility);
}

void write_timing(Writer& w, const planning::Timing& timing) {
  w.raw(",\n  \"timing_ms\": ");
  write_numbers(w,
                {{"load_scene", timing.load_scene_ms},
                 {"motion", timing.motion_ms},
                 {"detect", timing.detect_ms},
                 {"correct", timing.correct_ms},
                 {"certify", timing.certify_ms},
                 {"total", timing.total_ms}},
                "timing_ms");
}

void write_head(Writer& w, const planning::PlanResult& result, const ResponseFormat& format) {
  w.raw("{\n  \"status\": ");
  w.text(planning::to_string(result.status));
  w.raw(",\n  \"message\": ");
  w.text(result.message);
  if (result.keyframe) w.raw(",\n  \"keyframe\": " + std::to_string(*result.keyframe));
  if (!format.scene.empty()) {
    w.raw(",\n  \"scene\": ");
    w.text(format.scene);
  }
  if (!format.scene_digest.empty()) {
    w.raw(",\n  \"scene_digest\": ");
    w.text(format.scene_digest);
  }
  if (!format.warnings.empty()) {
    w.raw(",\n  \"warnings\": ");
    w.list(format.warnings, [&](const std::string& warning) { w.text(warning); });
  }
}

}  // namespace

Parsed<std::string> write_plan_response(const planning::PlanResult& result,
                                        const ResponseFormat& format) {
  std::string out;
  Writer w(out);
  write_head(w, result, format);
  w.raw(",\n  \"segments\": ");
  w.list(result.path.segments(), [&](const motion::Segment& s) { write_segment(w, s); });
  w.raw(",\n  \"keyframes\": ");
  w.list(result.keyframes, [&](const Keyframe& k) { write_keyframe(w, k); });
  w.raw(",\n  \"collisions\": ");
  write_intervals(w, result.collisions, result.collision_names, "collisions");
  w.raw(",\n  \"remaining_collisions\": ");
  write_intervals(w, result.remaining_collisions, result.remaining_names, "remaining_collisions");
  w.raw(",\n  \"certificate\": {\"certified\": ");
  w.raw(result.certificate.certified ? "true" : "false");
  w.raw(", \"clearance_lower_bound\": ");
  w.number(result.certificate.clearance_lower_bound_m, "certificate.clearance_lower_bound");
  w.raw("}");
  write_report(w, result);
  if (format.timing == TimingField::kWritten) write_timing(w, result.timing);
  w.raw("\n}\n");
  if (!w.error().empty()) return {{}, w.error()};
  return {std::move(out), {}};
}

}  // namespace camway::tools
