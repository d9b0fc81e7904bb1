// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/vertical_axis.h"
#include "daemon/scene/mesh/mesh.h"

/// Floor plans of scenes and paths.
namespace camway::draw {

/// The axis of a scene that points up.
using SceneUp = scene::VerticalAxis;

/// A point on paper, with the scene seen from above: x to the right, y down. [Units: metres]
using PlanPoint = Eigen::Vector2d;

/// Returns the place of a point on paper.
PlanPoint to_plan(const geometry::Vec3& p_W, SceneUp up);
/// Returns the height of a point along the axis that points up. [Units: metres]
double height_of(const geometry::Vec3& p_W, SceneUp up);

/// A polyline of a section.
struct SectionLine {
  std::vector<PlanPoint> points;
  bool closed = false;  ///< whether the last point joins the first: the outline of a solid
};

/// The floor plan of one storey: the section of a scene at a height, and the faces below it that
/// are seen from above.
struct FloorSection {
  double height_m = 0.0;                           ///< height of the cut
  double floor_m = 0.0;                            ///< height of the floor below the cut
  std::vector<std::vector<SectionLine>> cut;       ///< section lines of each object of the mesh
  std::vector<std::array<PlanPoint, 3>> tops;      ///< faces between floor and cut, lowest first
  std::vector<std::array<PlanPoint, 2>> outlines;  ///< borders and creases of these faces
};

/// Returns the height of the floor below `height_m`: of the levels 0.3 to 4 m below it, the highest
/// whose horizontal area is nearly the largest. Returns `height_m` - 2 m if there is no level.
double find_floor_m(const scene::Mesh& mesh, SceneUp up, double height_m);

/// Cuts `mesh` at `height_m` and collects the faces between the cut and the floor below it, which
/// is at `floor_m`; by default, it is searched.
FloorSection cut_floor(const scene::Mesh& mesh, SceneUp up, double height_m,
                       std::optional<double> floor_m = std::nullopt);

/// Tells apart a room from a solid. Where an odd number of outlines of an object has all of
/// `places`, which are not in a solid, the largest one is the wall of a room without a thickness:
/// it counts as not closed. Does nothing without places.
void open_room_about(std::span<const PlanPoint> places, FloorSection& section);

}  // namespace camway::draw
