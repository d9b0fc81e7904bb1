// SPDX-License-Identifier: MIT
#include <charconv>
#include <cmath>

#include "tools/json_io.h"

namespace camway::tools {
namespace {

using motion::Keyframe;

/// Builds the text of a response. Objects that are one thing (a keyframe, an interval) stand on one
/// line, so that a person can read a long path and `diff` can compare two.
class Writer {
 public:
  explicit Writer(std::string& out) : out_(out) {}

  void raw(std::string_view text) { out_ += text; }

  /// The shortest decimal that reads back as the same double, always with a point or an exponent:
  /// without one a reader takes -0 for the integer 0 and loses the sign.
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

  /// `[` item `,` item ... `]`, one item a line.
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
  w.raw(inserted ? ", \"origin\": \"inserted\"}" : ", \"origin\": \"given\"}");
}

void write_witness(Writer& w, const collision::Witness& witness,
                   const planning::WitnessNames& names, std::string_view what) {
  w.raw(",\n     \"witness\": {\"time\": ");
  w.number(witness.time_s, what);
  w.raw(", \"object\": ");
  w.text(names.object);
  w.raw(", \"triangle\": " + std::to_string(witness.triangle) + ", \"feature\": ");
  w.text(names.feature);
  w.raw(", \"depth\": ");
  w.number(witness.depth_m, what);
  w.raw(", \"point\": ");
  w.vector(witness.point_W, what);
  w.raw("}");
}

/// `names` may be fewer than the intervals: nobody named the witnesses then.
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

void write_timing(Writer& w, const planning::Timing& timing) {
  const std::pair<const char*, double> members[] = {
      {"load_scene", timing.load_scene_ms}, {"motion", timing.motion_ms},
      {"detect", timing.detect_ms},         {"correct", timing.correct_ms},
      {"certify", timing.certify_ms},       {"total", timing.total_ms}};
  bool first = true;
  w.raw(",\n  \"timing_ms\": {");
  for (const auto& [name, value] : members) {
    if (!first) w.raw(", ");
    first = false;
    w.raw("\"");
    w.raw(name);
    w.raw("\": ");
    w.number(value, "timing_ms");
  }
  w.raw("}");
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
  if (format.timing == TimingField::kWritten) write_timing(w, result.timing);
  w.raw("\n}\n");
  if (!w.error().empty()) return {{}, w.error()};
  return {std::move(out), {}};
}

}  // namespace camway::tools
