// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "daemon/geometry/types.h"
#include "daemon/scene/mesh/mesh.h"

/// Pictures for people: floor plans of scenes and paths.
namespace camway::draw {

/// Which axis of a scene points up.
enum class SceneUp { kY, kZ };

/// A point on paper: metres, x to the right, y down. A scene is seen from above.
using PlanPoint = Eigen::Vector2d;

PlanPoint to_plan(const geometry::Vec3& p_W, SceneUp up);
double height_of(const geometry::Vec3& p_W, SceneUp up);

/// A chain of section lines. A closed one bounds something solid.
struct SectionLine {
  std::vector<PlanPoint> points;
  bool closed = false;
};

/// What an architect's plan shows of one storey.
struct FloorSection {
  double height_m = 0.0;                           ///< where it is cut
  double floor_m = 0.0;                            ///< the floor below the cut
  std::vector<std::vector<SectionLine>> cut;       ///< per object of the mesh
  std::vector<std::array<PlanPoint, 3>> tops;      ///< faces between floor and cut, lowest first
  std::vector<std::array<PlanPoint, 2>> outlines;  ///< their borders and creases
};

/// The level of the floor below `height_m`: the highest level, 0.3 to 4 m below, that has nearly as
/// much level area as any; 2 m below if there is none.
double find_floor_m(const scene::Mesh& mesh, SceneUp up, double height_m);

/// Cuts `mesh` at `height_m` and collects what lies between the cut and the floor below it.
FloorSection cut_floor(const scene::Mesh& mesh, SceneUp up, double height_m);

}  // namespace camway::draw
