// SPDX-License-Identifier: MIT
#include "tools/camway/plan_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "daemon/planning/effort_text.h"
#include "tools/json_angle.h"

namespace camway::tools {
namespace {

using correction::Correction;
using correction::Rung;
using planning::PlanResult;
using planning::Status;

/// Of each kind; the response has them all.
constexpr std::size_t kMostLines = 20;
constexpr std::size_t kMostObjects = 3;
constexpr std::size_t kMostStretches = 5;

/// Less than this is rounding, or nothing that a person would see.
constexpr double kLeastMove_m = 1e-4;
constexpr double kLeastTurn_deg = 0.01;

/// Two digits, none behind the point from 10 on.
std::string two_digits(double value) {
  return value < 10.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// ", moved 0.12 m, turned 3 degrees", or what of that there is to see.
std::string extent(const Correction& correction) {
  std::string text;
  if (correction.moved_m >= kLeastMove_m)
    text += ", moved " + two_digits(correction.moved_m) + " m";
  const double turned_deg = degrees(correction.turned_rad);
  if (turned_deg >= kLeastTurn_deg) text += ", turned " + two_digits(turned_deg) + " degrees";
  return text;
}

std::string deed(const Correction& correction) {
  const std::string text = extent(correction);
  switch (correction.rung) {
    case Rung::kMove:
      return text.empty() ? "moved" : text.substr(2);
    case Rung::kTurn:
      return text.empty() ? "turned" : text.substr(2);
    case Rung::kGoRound:
      return "goes round" + text;
    case Rung::kShrink:
      return "near distance made smaller" + text;
    case Rung::kNone:
      break;
  }
  return "not corrected";
}

/// "2.31-2.65", or "2.31" where that is all to a hundredth.
std::string span(const collision::CollisionInterval& interval) {
  const std::string begin = fmt::format("{:.2f}", interval.t_begin_s);
  const std::string end = fmt::format("{:.2f}", interval.t_end_s);
  return begin == end ? begin : begin + "-" + end;
}

/// "edge 2", "the inside".
std::string part_of_body(const std::string& feature) {
  if (feature.empty()) return "it";
  return feature == "inside" || feature == "surface" ? "the " + feature : feature;
}

/// "edge 2 met sofa_04", or nothing if nobody saw what collided.
std::string meeting(const PlanResult& result, std::size_t collision) {
  if (collision >= result.collisions.size() || collision >= result.collision_names.size())
    return {};
  if (!result.collisions[collision].witness) return {};
  const planning::WitnessNames& names = result.collision_names[collision];
  return fmt::format("{} met {}", part_of_body(names.feature),
                     names.object.empty() ? "the scene" : names.object);
}

/// Whether one change of the path is what became of both.
bool is_same_change(const Correction& a, const Correction& b) {
  return a.rung != Rung::kNone && a.rung == b.rung && a.t_begin_s == b.t_begin_s &&
         a.t_end_s == b.t_end_s && a.moved_m == b.moved_m && a.turned_rad == b.turned_rad;
}

/// The collisions that each change of the path was for, in order.
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

/// "2.31-2.65, 2.80-2.91 s: goes round, moved 1.3 m (edge 2 met sofa_04, corner 0 met lamp)".
std::string change_line(const PlanResult& result, const std::vector<std::size_t>& change) {
  std::string spans;
  std::vector<std::string> meetings;
  for (const std::size_t i : change) {
    spans += (spans.empty() ? "" : ", ") + span(result.corrections[i].interval);
    const std::string met = meeting(result, i);
    if (!met.empty() && std::ranges::count(meetings, met) == 0) meetings.push_back(met);
  }
  const Correction& correction = result.corrections[change.front()];
  std::string line = spans + " s: " + deed(correction);
  const std::size_t shown = std::min(meetings.size(), kMostObjects);
  for (std::size_t i = 0; i < shown; ++i) line += (i == 0 ? " (" : ", ") + meetings[i];
  if (shown > 0) line += shown < meetings.size() ? ", ...)" : ")";
  const std::string effort = planning::effort_text(correction.tried);
  if (!effort.empty()) line += "; tried " + effort;
  return line;
}

void add_corrections(const PlanResult& result, std::vector<std::string>& lines) {
  const std::vector<std::vector<std::size_t>> all = changes(result.corrections);
  const std::size_t shown = std::min(all.size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) lines.push_back(change_line(result, all[i]));
  if (shown < all.size()) lines.push_back(fmt::format("and {} more", all.size() - shown));
}

void add_keyframe_faults(const PlanResult& result, std::vector<std::string>& lines) {
  const bool repaired = result.status != Status::kInvalid;
  const std::size_t shown = std::min(result.keyframe_faults.size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) {
    const planning::KeyframeFault& fault = result.keyframe_faults[i];
    std::string line = fmt::format("keyframe {}: {:.2g} m too deep", fault.keyframe, fault.depth_m);
    if (fault.free_pose) {
      const geometry::Vec3& p = fault.free_pose->position;
      line += fmt::format(", {} [{:.4g}, {:.4g}, {:.4g}]", repaired ? "moved to" : "free at", p.x(),
                          p.y(), p.z());
    } else {
      line += ", no free pose was found near it";
    }
    lines.push_back(std::move(line));
  }
  if (shown < result.keyframe_faults.size()) {
    lines.push_back(fmt::format("and {} more keyframes", result.keyframe_faults.size() - shown));
  }
}

/// The names of the objects that the triangles belong to, each once, in the order of the mesh.
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

/// What one keyframe is inside of and another outside.
std::string what_separates(const planning::Infeasibility& proof) {
  const std::string triangles = plural(proof.triangles.size(), "triangle");
  if (!proof.cage) return "a closed surface of " + triangles;
  const geometry::Vec3 size_m = proof.cage->box.sizes();
  return fmt::format(
      "a cage of {:.3g} x {:.3g} x {:.3g} m made of {}, its holes at most {:.3g} m wide and the "
      "camera {:.3g} m",
      size_m.x(), size_m.y(), size_m.z(), triangles, proof.cage->widest_hole_m,
      proof.cage->shortest_chord_m);
}

void add_proof(const PlanResult& result, const scene::Mesh* mesh, std::vector<std::string>& lines) {
  if (!result.infeasibility) return;
  const planning::Infeasibility& proof = *result.infeasibility;
  std::string line =
      fmt::format("keyframe {} is inside and keyframe {} outside of {}", proof.keyframe_inside,
                  proof.keyframe_outside, what_separates(proof));
  const auto names =
      mesh != nullptr ? objects_of(proof.triangles, *mesh) : std::vector<std::string>();
  for (std::size_t i = 0; i < std::min(names.size(), kMostObjects); ++i) {
    line += (i == 0 ? ": " : ", ") + names[i];
  }
  if (names.size() > kMostObjects) line += ", ...";
  lines.push_back(std::move(line));
}

void add_scales(const PlanResult& result, std::vector<std::string>& lines) {
  if (result.near_scale != 1.0) {
    lines.push_back(
        fmt::format("the near distance is {:.3g} of the one asked for", result.near_scale));
  }
  if (result.time_scale != 1.0) {
    std::string line =
        fmt::format("to meet the limits it takes {:.4g} times as long", result.time_scale);
    const std::size_t shown = std::min(result.slowed.size(), kMostStretches);
    for (std::size_t i = 0; i < shown; ++i) {
      line += fmt::format("{}{:.4g}-{:.4g} s", i == 0 ? ", slowed at " : ", ",
                          result.slowed[i].t_begin_s, result.slowed[i].t_end_s);
    }
    if (shown < result.slowed.size()) line += ", ...";
    lines.push_back(std::move(line));
  }
}

std::string headline(const PlanResult& result) {
  if (result.status == Status::kInvalid) return result.message;
  return fmt::format(
      "{}: {} before correction, {} inserted, {} remaining, planned in {:.1f} ms, scene loaded in "
      "{:.1f} ms: {}",
      planning::to_string(result.status), plural(result.collisions.size(), "collision"),
      plural(inserted_count(result), "keyframe"),
      plural(result.remaining_collisions.size(), "collision"), result.timing.total_ms,
      result.timing.load_scene_ms, result.message);
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
  add_keyframe_faults(result, lines);
  add_scales(result, lines);
  add_proof(result, mesh, lines);
  std::string text = headline(result);
  for (const std::string& line : lines) text += "\n  " + line;
  return text;
}

}  // namespace camway::tools
