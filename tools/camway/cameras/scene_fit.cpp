// SPDX-License-Identifier: MIT
#include "tools/camway/cameras/scene_fit.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/scene/import/import.h"

namespace camway::tools {
namespace {

/// The unit that a file states: glTF has metres by its specification, without a word in the file.
double stated_unit_m(const scene::ImportReport& report) {
  if (report.unit_m != 0.0) return report.unit_m;
  return report.format.find("glTF") != std::string::npos ? 1.0 : 0.0;
}

/// Says what a scale comes to where one of both files states its unit and the other one does not:
/// the number is a unit there and a factor here.
std::string unit_warning(const std::string& scene, const scene::ImportOptions& options,
                         const scene::ImportReport& report, const PlacedPath& path) {
  const double unit_m = stated_unit_m(report);
  if (options.scale == 1.0 || (unit_m != 0.0) == path.has_unit) return "";
  if (path.has_unit) {
    return fmt::format(
        "{0} states its unit, so --scale makes it {1:g} times as large; a unit of {2} is {3:g} m: "
        "--camera-scale 1 keeps the former as it is",
        path.file, path.scale, scene, report.scale);
  }
  return fmt::format(
      "{0} states its unit, {1:g} m, so --scale makes it {2:g} m; a unit of {3} is {4:g} m: "
      "--camera-scale {4:g} instead of --scale keeps the former as it is",
      scene, unit_m, unit_m * options.scale, path.file, path.scale);
}

}  // namespace

std::vector<std::string> scene_warnings(const std::string& scene,
                                        const scene::ImportOptions& options,
                                        const PlacedPath& path) {
  const scene::ImportResult read = scene::import_mesh(scene, options);
  if (!read.error.empty()) return {read.error};
  std::vector<std::string> warnings;
  if (std::string words = unit_warning(scene, options, read.report, path); !words.empty()) {
    warnings.push_back(std::move(words));
  }
  const geometry::Box& bounds_W = read.report.bounds_m;
  const bool is_inside = std::ranges::any_of(
      path.keyframes_W, [&](const geometry::Vec3& place) { return bounds_W.contains(place); });
  if (!is_inside && !bounds_W.isEmpty()) {
    const geometry::Vec3 size = bounds_W.sizes();
    warnings.push_back(
        fmt::format("no keyframe lies within the bounds of the scene, which is {:.3g} x {:.3g} x "
                    "{:.3g} m large; check its scale and axes",
                    size.x(), size.y(), size.z()));
  }
  return warnings;
}

}  // namespace camway::tools
