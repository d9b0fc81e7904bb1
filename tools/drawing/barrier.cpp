// SPDX-License-Identifier: MIT
#include "tools/drawing/barrier.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace camway::draw {
namespace {

/// Returns the corner of a box whose bits say at which end it is on each axis.
geometry::Vec3 corner_of(const geometry::Box& box, unsigned bits) {
  geometry::Vec3 corner = box.min();
  for (int axis = 0; axis < 3; ++axis) {
    if ((bits >> static_cast<unsigned>(axis) & 1U) != 0U) corner[axis] = box.max()[axis];
  }
  return corner;
}

scene::Mesh mesh_of(const correction::CageBox& cage) {
  constexpr unsigned kCorners = 8;
  scene::Mesh mesh;
  for (unsigned bits = 0; bits < kCorners; ++bits) {
    mesh.vertices.emplace_back(cage.orientation * corner_of(cage.box, bits));
  }
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned side = 1U << axis;
    const unsigned u = 1U << (axis + 1) % 3;
    const unsigned v = 1U << (axis + 2) % 3;
    mesh.triangles.push_back({0, v, u | v});
    mesh.triangles.push_back({0, u | v, u});
    mesh.triangles.push_back({side, side | u, side | u | v});
    mesh.triangles.push_back({side, side | u | v, side | v});
  }
  return mesh;
}

}  // namespace

Barrier barrier_of(const planning::Infeasibility& proof, const scene::Mesh& mesh) {
  Barrier barrier{{}, proof.keyframe_inside, proof.keyframe_outside};
  if (proof.cage) {
    barrier.surface = mesh_of(*proof.cage);
  } else {
    barrier.surface.vertices = mesh.vertices;
    for (const std::uint32_t index : proof.triangles) {
      if (index < mesh.triangles.size()) {
        barrier.surface.triangles.push_back(mesh.triangles[index]);
      }
    }
  }
  const auto count = static_cast<std::uint32_t>(barrier.surface.triangles.size());
  barrier.surface.objects.push_back({"barrier", 0, count});
  return barrier;
}

std::vector<SectionLine> barrier_section(const Barrier& barrier, SceneUp up,
                                         const FloorSection& storey) {
  constexpr double kInside_m = 1e-3;  // a section along a face would be no line
  Eigen::AlignedBox1d heights;
  for (std::size_t i = 0; i < barrier.surface.triangles.size(); ++i) {
    for (const geometry::Vec3& corner : barrier.surface.triangle(i)) {
      heights.extend(Eigen::Matrix<double, 1, 1>(height_of(corner, up)));
    }
  }
  const double low_m = heights.min()[0] + kInside_m;
  const double high_m = heights.max()[0] - kInside_m;
  if (heights.isEmpty() || low_m > high_m || high_m < storey.floor_m || low_m > storey.height_m) {
    return {};
  }
  const double height_m = std::clamp(storey.height_m, low_m, high_m);
  std::vector<SectionLine> lines;
  for (std::vector<SectionLine>& object :
       cut_floor(barrier.surface, up, height_m, storey.floor_m).cut) {
    for (SectionLine& line : object) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace camway::draw
