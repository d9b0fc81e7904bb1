// SPDX-License-Identifier: MIT
#include "daemon/planning/effort_text.h"

#include <fmt/format.h>

#include <cmath>
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

std::string rounded_down(double value) {
  if (!(value > 0.0)) return "0";
  const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(value)));
  return fmt::format("{:.3g}", std::floor(value * scale) / scale);
}

std::string effort_text(const Effort& effort) {
  std::string text;
  const auto add_some = [&](std::int32_t count, std::string_view noun, std::string_view what_for) {
    if (count == 0) return;
    add(text, counted(static_cast<std::size_t>(count), noun) + std::string(what_for));
  };
  add_some(effort.directions, "direction", " to move or turn in");
  add_some(effort.paths, "changed path", "");
  add_some(effort.lattice_points, "place", " on a way round");
  add_some(effort.tree_samples, "pose", " on a way round that turns");
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
  if (request.body) note += "; note: keyframe_insertion corrects paths of cameras alone";
  return note;
}

std::string why_infeasible(const Infeasibility& proof, bool may_shrink) {
  if (!proof.cage) {
    return fmt::format(
        "no path exists: keyframe {} is inside a closed surface of {} of the scene, keyframe {} "
        "outside",
        proof.keyframe_inside, counted(proof.triangles.size(), "triangle"), proof.keyframe_outside);
  }
  const geometry::Vec3 center = proof.cage->orientation * geometry::Vec3(proof.cage->box.center());
  const geometry::Vec3 size_m = proof.cage->box.sizes();
  const std::string place =
      fmt::format("of {:.3g} x {:.3g} x {:.3g} m about ({:.4g}, {:.4g}, {:.4g})", size_m.x(),
                  size_m.y(), size_m.z(), center.x(), center.y(), center.z());
  const std::string camera =
      fmt::format("the camera's near quadrilateral ({:.3g} m{})", proof.cage->shortest_chord_m,
                  may_shrink ? " at its smallest" : "");
  const std::string holes =
      proof.cage->widest_hole_m > 0.0
          ? fmt::format("whose holes ({:.3g} m at most) are too narrow for {}",
                        proof.cage->widest_hole_m, camera)
          : "without holes";
  return fmt::format("no path exists: keyframe {} is inside a box {} {}, keyframe {} outside",
                     proof.keyframe_inside, place, holes, proof.keyframe_outside);
}

}  // namespace camway::planning
