// SPDX-License-Identifier: MIT
#include "tools/camway/plan/plan_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "daemon/planning/stages/sentences.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using correction::Correction;
using correction::CorrectionKind;
using planning::PlanResult;
using planning::Status;

/// Most lines of each kind; the response has all of them.
constexpr std::size_t kMostLines = 20;
constexpr std::size_t kMostObjects = 3;
constexpr std::size_t kMostStretches = 5;

/// Smaller changes are rounding, or too small to see.
constexpr double kLeastMove_m = 1e-4;
constexpr double kLeastTurn_deg = 0.01;

/// Formats a number with two digits, without decimals from 10 on.
std::string two_digits(double value) {
  return value < 10.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// Returns ", moved up to 0.12 m, turned up to 3 degrees", without the part that is too small.
std::string extent(const Correction& correction) {
  std::string text;
  if (correction.moved_m >= kLeastMove_m)
    text += ", moved up to " + two_digits(correction.moved_m) + " m";
  const double turned_deg = degrees(correction.turned_rad);
  if (turned_deg >= kLeastTurn_deg) text += ", turned up to " + two_digits(turned_deg) + " degrees";
  return text;
}

std::string deed(const Correction& correction) {
  const std::string text = extent(correction);
  switch (correction.kind) {
    case CorrectionKind::kMove:
      return text.empty() ? "moved" : text.substr(2);
    case CorrectionKind::kTurn:
      return text.empty() ? "turned" : text.substr(2);
    case CorrectionKind::kGoRound:
      return "goes another way" + text;
    case CorrectionKind::kShrink:
      return "near distance made smaller" + text;
    case CorrectionKind::kNone:
      break;
  }
  return "not corrected";
}

/// Returns "2.31-2.65", or "2.31" if both ends are equal to a hundredth.
std::string span(double begin_s, double end_s) {
  const std::string begin = fmt::format("{:.2f}", begin_s);
  const std::string end = fmt::format("{:.2f}", end_s);
  return begin == end ? begin : begin + "-" + end;
}

/// Returns "2.31-2.65, 2.80 s"; for many intervals only their range and number.
std::string spans(const PlanResult& result, const std::vector<std::size_t>& change) {
  const auto interval = [&](std::size_t i) { return result.corrections[change[i]].interval; };
  if (change.size() > kMostStretches) {
    return fmt::format("{} s, {}", span(interval(0).t_begin_s, interval(change.size() - 1).t_end_s),
                       plural(change.size(), "time"));
  }
  std::string text;
  for (std::size_t i = 0; i < change.size(); ++i) {
    text += (i == 0 ? "" : ", ") + span(interval(i).t_begin_s, interval(i).t_end_s);
  }
  return text + " s";
}

/// Returns "collides with sofa_04, lamp". The response has the part of the body.
std::string meetings(const PlanResult& result, const std::vector<std::size_t>& change) {
  std::vector<std::string> names;
  for (const std::size_t i : change) {
    if (i >= result.collisions.size() || i >= result.collision_names.size()) continue;
    if (!result.collisions[i].witness) continue;
    const std::string& object = result.collision_names[i].object;
    const std::string name = object.empty() ? "the scene" : object;
    if (std::ranges::count(names, name) == 0) names.push_back(name);
  }
  std::string text = names.empty() ? "collides" : "collides with ";
  for (std::size_t i = 0; i < std::min(names.size(), kMostObjects); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() > kMostObjects ? text + ", ..." : text;
}

/// Returns whether one change of the path corrected both collisions. Corrections of several kinds
/// that touch are drawn as one change.
bool is_same_change(const Correction& a, const Correction& b) {
  return a.kind != CorrectionKind::kNone && b.kind != CorrectionKind::kNone &&
         a.t_begin_s == b.t_begin_s && a.t_end_s == b.t_end_s && a.moved_m == b.moved_m &&
         a.turned_rad == b.turned_rad;
}

/// Groups the collisions by the change of the path that corrected them, in order.
std::vector<std::vector<std::size_t>> changes(const std::vector<Correction>& corrections) {
  std::vector<std::vector<std::size_t>> changes;
  for (std::size_t i = 0; i < corrections.size(); ++i) {
    const auto same = std::ranges::find_if(changes, [&](const std::vector<std::size_t>& change) {
      return is_same_change(corrections[change.front()], corrections[i]);
    });
    if (same == changes.end()) {
      changes.push_back({i});
    } else {
      same->push_back(i);
    }
  }
  return changes;
}

/// Returns "2.31-2.65, 2.80-2.91 s: collides with sofa_04, lamp; goes another way, moved up to 1.3
/// m".
std::string change_line(const PlanResult& result, const std::vector<std::size_t>& change) {
  const auto kind = [&](std::size_t i) { return result.corrections[i].kind; };
  const Correction& correction = result.corrections[*std::ranges::max_element(change, {}, kind)];
  std::string line =
      spans(result, change) + ": " + meetings(result, change) + "; " + deed(correction);
  const std::string effort = planning::effort_text(correction.tried);
  if (!effort.empty()) line += ", tried " + effort;
  return line;
}

void add_corrections(const PlanResult& result, std::vector<std::string>& lines) {
  const std::vector<std::vector<std::size_t>> all = changes(result.corrections);
  const std::size_t shown = std::min(all.size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) lines.push_back(change_line(result, all[i]));
  if (shown < all.size()) lines.push_back(fmt::format("and {} more", all.size() - shown));
}

void add_shift(const PlanResult& result, std::vector<std::string>& lines) {
  if (!result.measures || !result.viewing_distance_m) return;
  const double shift_deg = degrees(result.measures->largest_shift_rad);
  lines.push_back("shifted up to " + two_digits(shift_deg) + " degrees at a viewing distance of " +
                  two_digits(*result.viewing_distance_m) + " m");
}

void add_keyframe_faults(const PlanResult& result, std::vector<std::string>& lines) {
  const bool repaired = result.status != Status::kInvalid;
  if (!repaired && result.keyframe_faults.size() == 1) return;  // the message says all
  const std::size_t shown = std::min(result.keyframe_faults.size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) {
    const planning::KeyframeFault& fault = result.keyframe_faults[i];
    std::string line = fmt::format("keyframe {}: {}", fault.keyframe,
                                   fault.leaves_bounds ? "leaves the bounds" : "collides");
    if (fault.depth_m > 0.0) line += fmt::format(" by {:.2g} m", fault.depth_m);
    if (fault.free_pose) {
      const geometry::Vec3& p = fault.free_pose->position;
      line += fmt::format("; {} [{:.4g}, {:.4g}, {:.4g}]", repaired ? "moved to" : "free at", p.x(),
                          p.y(), p.z());
    } else {
      line += "; no free pose was found near it";
    }
    lines.push_back(std::move(line));
  }
  if (shown < result.keyframe_faults.size()) {
    lines.push_back(fmt::format("and {} more keyframes", result.keyframe_faults.size() - shown));
  }
}

/// Returns the names of the triangles' objects, each once, in the order of the mesh.
std::vector<std::string> objects_of(const std::vector<std::uint32_t>& triangles,
                                    const scene::Mesh& mesh) {
  std::vector<std::string> names;
  for (const scene::MeshObject& object : mesh.objects) {
    const auto first = std::ranges::lower_bound(triangles, object.first_triangle);
    const bool has_some =
        first != triangles.end() && *first - object.first_triangle < object.triangle_count;
    if (has_some && !object.name.empty() && std::ranges::count(names, object.name) == 0) {
      names.push_back(object.name);
    }
    if (names.size() > kMostObjects) break;
  }
  return names;
}

/// Returns the line with the objects of the proof; the message has the rest.
void add_proof(const PlanResult& result, const scene::Mesh* mesh, std::vector<std::string>& lines) {
  if (!result.infeasibility || mesh == nullptr) return;
  const std::vector<std::string> names = objects_of(result.infeasibility->triangles, *mesh);
  if (names.empty()) return;
  std::string line = result.infeasibility->cage ? "the box is made of" : "the surface belongs to";
  for (std::size_t i = 0; i < std::min(names.size(), kMostObjects); ++i) {
    line += (i == 0 ? " " : ", ") + names[i];
  }
  if (names.size() > kMostObjects) line += ", ...";
  lines.push_back(std::move(line));
}

/// Returns the lines with the slowed parts; the message has the total duration.
void add_slowed(const PlanResult& result, std::vector<std::string>& lines) {
  if (result.slowed.empty()) return;
  std::string line = "slowed at ";
  const std::size_t shown = std::min(result.slowed.size(), kMostStretches);
  for (std::size_t i = 0; i < shown; ++i) {
    line += fmt::format("{}{} s", i == 0 ? "" : ", ",
                        span(result.slowed[i].t_begin_s, result.slowed[i].t_end_s));
  }
  lines.push_back(shown < result.slowed.size() ? line + ", ..." : line);
}

/// Formats a duration: "0.9 ms", "1.23 s".
std::string duration(double ms) {
  return ms < 1000.0 ? fmt::format("{:.1f} ms", ms) : fmt::format("{:.2f} s", ms / 1000.0);
}

std::string headline(const PlanResult& result) {
  if (result.status == Status::kInvalid) return result.message;
  // A daemon has read the scene before.
  const double load_ms = result.timing.load_scene_ms;
  return fmt::format("{}: {} ({}planned in {})", planning::to_string(result.status), result.message,
                     load_ms > 0.0 ? "scene read in " + duration(load_ms) + ", " : "",
                     duration(result.timing.total_ms));
}

}  // namespace

std::string plural(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::size_t inserted_count(const PlanResult& result) {
  return static_cast<std::size_t>(std::count_if(
      result.keyframes.begin(), result.keyframes.end(), [](const motion::Keyframe& keyframe) {
        return keyframe.origin == motion::KeyframeOrigin::kInserted;
      }));
}

std::string plan_summary(const PlanResult& result, const scene::Mesh* mesh) {
  std::vector<std::string> lines;
  add_corrections(result, lines);
  add_shift(result, lines);
  add_keyframe_faults(result, lines);
  add_slowed(result, lines);
  add_proof(result, mesh, lines);
  std::string text = headline(result);
  for (const std::string& line : lines) text += "\n  " + line;
  return text;
}

}  // namespace camway::tools
