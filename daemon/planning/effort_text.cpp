// SPDX-License-Identifier: MIT
#include "daemon/planning/effort_text.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string_view>

namespace camway::planning {

namespace {

using correction::Correction;
using correction::Effort;

// Cameras are seldom rolled by so much: 30 degrees.
constexpr double kNotableTilt_rad = 0.5236;

void add(std::string& list, std::string_view item) {
  if (!list.empty()) list += ", ";
  list += item;
}

}  // namespace

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string effort_text(const Effort& effort) {
  std::string text;
  const auto add_some = [&](std::int32_t count, std::string_view noun) {
    if (count > 0) add(text, counted(static_cast<std::size_t>(count), noun));
  };
  add_some(effort.directions, "direction");
  add_some(effort.paths, "changed path");
  add_some(effort.lattice_points, "lattice point");
  add_some(effort.tree_samples, "tree sample");
  return text;
}

std::string note_of_effort(const std::vector<Correction>& corrections) {
  Effort sum;
  for (const Correction& correction : corrections) {
    if (correction.rung == correction::Rung::kNone) sum += correction.tried;
  }
  const std::string text = effort_text(sum);
  return text.empty() ? text : "; tried without success: " + text;
}

std::string note_of_method(const PlanRequest& request) {
  if (request.options.method != Method::kKeyframeInsertion) return {};
  const PlanOptions usual;
  std::string unused;
  if (request.options.objective != usual.objective) add(unused, "options.objective");
  if (!(request.options.orientation == usual.orientation)) add(unused, "options.orientation");
  if (request.options.seed != usual.seed) add(unused, "options.seed");
  std::string note;
  if (!unused.empty()) note = "; note: keyframe_insertion does not look at " + unused;
  if (request.options.bounds.any())
    note += "; note: keyframe_insertion corrects without regard to options.bounds, and is checked";
  if (request.body) note += "; note: keyframe_insertion corrects paths of cameras alone";
  return note;
}

std::string note_of_tilt(const PlanRequest& request) {
  const correction::OrientationPolicy& policy = request.options.orientation;
  if (policy.rule != correction::OrientationRule::kLevel) return {};
  for (std::size_t i = 0; i < request.keyframes.size(); ++i) {
    const geometry::Vec3 across_W =
        request.keyframes[i].pose.orientation.normalized() * geometry::Vec3::UnitX();
    const double tilt_rad =
        std::atan2(std::abs(policy.up_W.dot(across_W)), policy.up_W.cross(across_W).norm());
    if (tilt_rad < kNotableTilt_rad) continue;
    return fmt::format(
        "; note: keyframe {} is tilted by {:.0f} degrees, check options.orientation.up", i,
        tilt_rad * 180.0 / std::numbers::pi);
  }
  return {};
}

std::string why_infeasible(const Infeasibility& proof, bool may_shrink) {
  if (proof.cage) {
    const geometry::Vec3 center =
        proof.cage->orientation * geometry::Vec3(proof.cage->box.center());
    return fmt::format(
        "there is no path: keyframe {} is inside a cage about ({:.4g}, {:.4g}, {:.4g}) with no "
        "hole wider than {:.3g} m, keyframe {} outside; the smaller side of the near "
        "quadrilateral is {:.3g} m{}",
        proof.keyframe_inside, center.x(), center.y(), center.z(), proof.cage->widest_hole_m,
        proof.keyframe_outside, proof.cage->shortest_chord_m, may_shrink ? " at its smallest" : "");
  }
  return fmt::format(
      "there is no path: keyframe {} is inside a closed surface of {} triangles of the scene, "
      "keyframe {} outside",
      proof.keyframe_inside, proof.triangles.size(), proof.keyframe_outside);
}

}  // namespace camway::planning
