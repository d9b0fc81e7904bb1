// SPDX-License-Identifier: MIT
#include "daemon/planning/effort_text.h"

#include <fmt/format.h>

#include <string_view>

namespace camway::planning {

namespace {

using correction::Correction;
using correction::Effort;

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
  const auto add_name = [&](std::string_view path) { add(unused, request.name_of(path)); };
  if (request.options.objective != usual.objective) add_name("options.objective");
  if (!(request.options.orientation == usual.orientation)) add_name("options.orientation");
  if (request.options.seed != usual.seed) add_name("options.seed");
  std::string note;
  if (!unused.empty()) note = "; note: keyframe_insertion does not look at " + unused;
  if (request.body) note += "; note: keyframe_insertion corrects paths of cameras alone";
  return note;
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
