// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tools/drawing/floor_section.h"

namespace camway::draw {

/// The storeys that a path visits.
struct VisitedStoreys {
  std::vector<double> floors_m;  ///< heights of their floors, lowest first; empty if none was found
  /// The storey of each point, as an index into `floors_m`; 0 everywhere if that is empty.
  std::vector<std::size_t> of_point;
};

/// Returns the storeys that a path visits, given as points in the order of time. The floor below a
/// point is the highest surface that rays downwards from the point and from a ring about it meet
/// often, so a table or a tread is no floor. A level as small as a landing of stairs is no storey.
/// Floors that differ by less than 1.8 m are one. Storeys are left out that never have three points
/// in a row nor one of the first `certain` points. Where floors are of all heights, as on a hill,
/// there is one storey.
VisitedStoreys visited_storeys(const scene::Mesh& mesh, SceneUp up,
                               const std::vector<geometry::Vec3>& points_W, std::size_t certain);

/// Returns the height of the lowest surface above one of `points_W` that is so far above
/// the floor that people can stand below it; nothing if there is none.
std::optional<double> ceiling_above(const scene::Mesh& mesh, SceneUp up,
                                    const std::vector<geometry::Vec3>& points_W, double floor_m);

/// Height above a floor at which a storey is cut if no path says otherwise: doors and windows are
/// open there, and most furniture is lower.
inline constexpr double kEyes_m = 1.5;

/// Returns the heights of the floors of a scene, lowest first: large level areas at least 1.8 m
/// apart with walls above them. Empty if there is none, and for a scene that is mostly sloped, as a
/// landscape is.
std::vector<double> storeys_of(const scene::Mesh& mesh, SceneUp up);

/// Returns the axis that points up in a scene, as its faces show it: seen along it, floors,
/// ceilings and tables have more area than the walls have that are seen along another axis.
SceneUp up_of(const scene::Mesh& mesh);

}  // namespace camway::draw
