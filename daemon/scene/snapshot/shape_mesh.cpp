// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/shape_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/voxels/voxel_faces.h"

namespace camway::scene {
namespace {

using geometry::Vec3;
using Corners = std::array<std::uint32_t, 3>;

/// Vertices are moved outwards by this factor, so that the mesh encloses the shape in spite of
/// rounding: a vertex takes fewer than 16 operations.
constexpr double kOutwards = 1.0 + 32.0 * geometry::kUnitRoundoff;

/// Why a length is invalid, or an empty text. NaN is invalid.
std::string length_fault(const char* name, double value_m) {
  if (value_m > 0.0 && value_m <= kLargestShapeM) return {};
  return std::string(name) + ": must be above 0 and at most 1e9 m";
}

base::Failure too_fine(double chord_error_m) {
  return {fmt::format("chord_error_m: {:g} m needs more than {} triangles", chord_error_m,
                      kMaxShapeTriangles)};
}

Mesh finished(Mesh mesh) {
  mesh.objects.push_back({"", 0, static_cast<std::uint32_t>(mesh.triangles.size())});
  return mesh;
}

/// The faces of an icosahedron about the origin, each divided into `frequency`² triangles of which
/// the vertices are on the unit sphere. Vertices are shared.
class Geodesic {
 public:
  explicit Geodesic(std::uint32_t frequency) : frequency_(frequency) {
    const double g = std::numbers::phi;
    for (const Vec3& v : {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0),
                          Vec3(0, -1, g), Vec3(0, 1, g), Vec3(0, -1, -g), Vec3(0, 1, -g),
                          Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)}) {
      corners_.push_back(v);
    }
  }

  Mesh build(std::size_t faces = kFaces.size()) && {
    for (std::size_t i = 0; i < faces; ++i) divide(kFaces[i]);
    return std::move(mesh_);
  }

 private:
  static constexpr std::array<Corners, 20> kFaces{
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

  /// Steps towards two or three of the twelve corners: a key of the vertex that is the same on
  /// every face that has it.
  using Steps = std::array<std::pair<std::uint32_t, std::uint32_t>, 3>;

  void divide(const Corners& face) {
    for (std::uint32_t i = 0; i < frequency_; ++i) {
      for (std::uint32_t j = 0; j + i < frequency_; ++j) {
        mesh_.triangles.push_back(
            {vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)});
        if (i + j + 2 > frequency_) continue;
        mesh_.triangles.push_back(
            {vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1)});
      }
    }
  }

  std::uint32_t vertex(const Corners& face, std::uint32_t i, std::uint32_t j) {
    Steps steps{{{face[0], frequency_ - i - j}, {face[1], i}, {face[2], j}}};
    for (auto& [corner, count] : steps) {
      if (count == 0) corner = 0;
    }
    std::ranges::sort(steps);
    const auto [found, is_new] =
        known_.try_emplace(steps, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) {
      Vec3 sum = Vec3::Zero();
      for (const auto& [corner, count] : steps)
        sum += static_cast<double>(count) * corners_[corner];
      mesh_.vertices.push_back(sum.normalized());
    }
    return found->second;
  }

  std::uint32_t frequency_;
  std::vector<Vec3> corners_;
  std::map<Steps, std::uint32_t> known_;
  Mesh mesh_;
};

/// The least distance of a face's plane from the centre of the unit sphere. All faces of the
/// icosahedron are divided alike.
double inner_radius(std::uint32_t frequency) {
  const Mesh face = Geodesic(frequency).build(1);
  double least = 1.0;
  for (std::size_t i = 0; i < face.triangles.size(); ++i) {
    const geometry::Triangle t = face.triangle(i);
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    least = std::min(least, std::abs(normal.dot(t[0])));
  }
  return least;
}

}  // namespace

base::Result<Mesh> box_mesh(const Vec3& size_m) {
  for (const double side_m : size_m) {
    if (std::string fault = length_fault("size_m", side_m); !fault.empty()) {
      return base::Failure{std::move(fault)};
    }
  }
  Mesh mesh;
  const Vec3 half_m = 0.5 * size_m;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1U) != 0 ? half_m.x() : -half_m.x(),
                               (i & 2U) != 0 ? half_m.y() : -half_m.y(),
                               (i & 4U) != 0 ? half_m.z() : -half_m.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return finished(std::move(mesh));
}

base::Result<Mesh> sphere_mesh(double radius_m, double chord_error_m) {
  for (std::string fault :
       {length_fault("radius_m", radius_m), length_fault("chord_error_m", chord_error_m)}) {
    if (!fault.empty()) return base::Failure{std::move(fault)};
  }
  // A face is about 1.1/n wide and its corners some 0.25/n² above it; the loop verifies that.
  const double wanted = std::sqrt(0.2 * radius_m / chord_error_m);
  for (double next = std::max(1.0, wanted);; next = std::max(next + 1.0, 1.05 * next)) {
    if (20.0 * next * next > static_cast<double>(kMaxShapeTriangles))
      return too_fine(chord_error_m);
    const auto frequency = static_cast<std::uint32_t>(next);
    const double scale = radius_m / inner_radius(frequency) * kOutwards;
    if (scale - radius_m > chord_error_m) continue;
    Mesh mesh = Geodesic(frequency).build();
    for (Vec3& vertex : mesh.vertices) vertex *= scale;
    return finished(std::move(mesh));
  }
}

base::Result<Mesh> cylinder_mesh(double radius_m, double height_m, double chord_error_m) {
  for (std::string fault : {length_fault("radius_m", radius_m), length_fault("height_m", height_m),
                            length_fault("chord_error_m", chord_error_m)}) {
    if (!fault.empty()) return base::Failure{std::move(fault)};
  }
  // The corners of n sides about a circle are r/cos(π/n) from its centre.
  const double half_angle_rad = std::acos(radius_m / (radius_m + chord_error_m));
  const double sides = std::max(3.0, std::ceil(std::numbers::pi / half_angle_rad) + 1.0);
  if (!(4.0 * sides < static_cast<double>(kMaxShapeTriangles))) return too_fine(chord_error_m);
  const auto n = static_cast<std::uint32_t>(sides);
  const double out_m = radius_m / std::cos(std::numbers::pi / sides) * kOutwards;
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / sides;
    const double x_m = out_m * std::cos(angle_rad);
    const double y_m = out_m * std::sin(angle_rad);
    mesh.vertices.emplace_back(x_m, y_m, -0.5 * height_m);
    mesh.vertices.emplace_back(x_m, y_m, 0.5 * height_m);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t low = 2 * i;
    const std::uint32_t next = 2 * ((i + 1) % n);
    mesh.triangles.push_back({low, next, next + 1});
    mesh.triangles.push_back({low, next + 1, low + 1});
    if (i == 0 || i + 1 == n) continue;
    mesh.triangles.push_back({0, next, low});
    mesh.triangles.push_back({1, low + 1, next + 1});
  }
  return finished(std::move(mesh));
}

namespace {

/// The cell of a point, or nothing if it is beyond the grid or not finite.
std::optional<Voxel> cell_at(const Vec3& point, double cell_m) {
  Voxel cell{};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double number = std::floor(point[k] / cell_m);
    if (!(std::abs(number) < kMaxCloudCells)) return std::nullopt;
    cell[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(number);
  }
  return cell;
}

}  // namespace

base::Result<Mesh> cloud_mesh(std::span<const Vec3> points, double cell_m) {
  if (std::string fault = length_fault("cell_m", cell_m); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  VoxelSet cells;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::optional<Voxel> cell = cell_at(points[i], cell_m);
    if (!cell) {
      return base::Failure{"points_m[" + std::to_string(i) + "]: is not finite or more than " +
                           std::to_string(kMaxCloudCells) + " cells from the origin"};
    }
    cells.insert(*cell);
  }
  std::optional<Mesh> mesh = faces_of(cells, cell_m, kMaxShapeTriangles);
  if (!mesh) {
    return base::Failure{"cell_m: the points need more than " + std::to_string(kMaxShapeTriangles) +
                         " triangles"};
  }
  return *std::move(mesh);
}

}  // namespace camway::scene
