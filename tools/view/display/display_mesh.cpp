// SPDX-License-Identifier: MIT
#include "tools/view/display/display_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace camway::view {
namespace {

using GridPoint = DisplayMesh::GridPoint;

/// The half extent of every object has at least so many steps.
constexpr double kFewestSteps = 4096.0;
/// Coordinates up to here are exact in single precision, in which pages and the simplifier compute.
constexpr double kMostSteps = 1 << 23;
/// Rounding of a coordinate in single precision, as a share of the half extent. [Units: 1]
constexpr double kFloatRounding = 0x1p-23;
/// A simplified mesh may have so many times the triangles that were asked for. Beyond, its surface
/// is not kept, but clustered.
constexpr double kSlack = 1.25;

/// Half the diagonal of a cell of the grid with edge 1.
constexpr double kHalfDiagonal = std::numbers::sqrt3 / 2.0;

/// Returns the step of the grid of a mesh with this half extent.
double step_for(double half_m) {
  const double fine_m = std::min(kDisplayError_m / kHalfDiagonal, half_m / kFewestSteps);
  return std::max(fine_m, half_m / kMostSteps);
}

std::int32_t nearest_step(double steps) {
  // Vertices that no triangle has may be anywhere.
  return static_cast<std::int32_t>(std::lround(std::clamp(steps, -kMostSteps, kMostSteps)));
}

/// Puts vertices and triangles on the grid, where equal vertices become one.
void put_on_grid(const scene::Mesh& mesh_O, DisplayMesh& display) {
  std::vector<GridPoint> points(mesh_O.vertices.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const geometry::Vec3 steps = (mesh_O.vertices[i] - display.centre_O) / display.step_m;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points[i].at(axis) = nearest_step(steps[static_cast<Eigen::Index>(axis)]);
    }
  }
  std::vector<std::uint32_t> remap(points.size());
  const std::size_t count = meshopt_generateVertexRemap(
      remap.data(), nullptr, points.size(), points.data(), points.size(), sizeof(GridPoint));
  display.vertices.resize(count);
  meshopt_remapVertexBuffer(display.vertices.data(), points.data(), points.size(),
                            sizeof(GridPoint), remap.data());
  display.indices.reserve(3 * mesh_O.triangles.size());
  for (const std::array<std::uint32_t, 3>& t : mesh_O.triangles) {
    const std::uint32_t a = remap[t[0]];
    const std::uint32_t b = remap[t[1]];
    const std::uint32_t c = remap[t[2]];
    if (a != b && b != c && c != a) display.indices.insert(display.indices.end(), {a, b, c});
  }
}

/// Leaves about `most_triangles`.
void simplify(DisplayMesh& display, std::size_t most_triangles) {
  constexpr std::size_t kStride = 3 * sizeof(float);
  constexpr float kAnyError = 1.0F;  // of the extent
  std::vector<float> positions;
  positions.reserve(3 * display.vertices.size());
  for (const GridPoint& point : display.vertices) {
    for (const std::int32_t x : point) positions.push_back(static_cast<float>(x));
  }
  const std::size_t vertices = display.vertices.size();
  const std::size_t target = 3 * std::max(most_triangles, std::size_t{1});
  std::vector<std::uint32_t> fewer(display.indices.size());
  float share = 0.0F;
  std::size_t left =
      meshopt_simplify(fewer.data(), display.indices.data(), display.indices.size(),
                       positions.data(), vertices, kStride, target, kAnyError, 0, &share);
  if (static_cast<double>(left) > kSlack * static_cast<double>(target)) {
    left = meshopt_simplifySloppy(fewer.data(), display.indices.data(), display.indices.size(),
                                  positions.data(), vertices, kStride, target, kAnyError, &share);
  }
  fewer.resize(left);
  display.indices.swap(fewer);
  const double extent_steps = meshopt_simplifyScale(positions.data(), vertices, kStride);
  display.is_simplified = true;
  display.error_m += static_cast<double>(share) * extent_steps * display.step_m;
}

/// Orders triangles and vertices so that neighbours are near each other; drops vertices that no
/// triangle has.
void put_in_order(DisplayMesh& display) {
  std::vector<std::uint32_t> ordered(display.indices.size());
  meshopt_optimizeVertexCacheStrip(ordered.data(), display.indices.data(), ordered.size(),
                                   display.vertices.size());
  std::vector<GridPoint> vertices(display.vertices.size());
  const std::size_t used =
      meshopt_optimizeVertexFetch(vertices.data(), ordered.data(), ordered.size(),
                                  display.vertices.data(), vertices.size(), sizeof(GridPoint));
  vertices.resize(used);
  display.indices.swap(ordered);
  display.vertices.swap(vertices);
}

}  // namespace

DisplayMesh display_mesh(const scene::Mesh& mesh_O, std::size_t most_triangles) {
  DisplayMesh display;
  display.triangles = mesh_O.triangles.size();
  if (mesh_O.triangles.empty()) return display;
  const geometry::Box bounds = mesh_O.bounds();
  display.centre_O = bounds.center();
  const double half_m = bounds.sizes().maxCoeff() / 2.0;
  if (!(half_m > 0.0)) return display;  // a point
  display.step_m = step_for(half_m);
  display.error_m = kHalfDiagonal * display.step_m + kFloatRounding * half_m;
  put_on_grid(mesh_O, display);
  if (display.shown() > most_triangles) simplify(display, most_triangles);
  put_in_order(display);
  return display;
}

}  // namespace camway::view
