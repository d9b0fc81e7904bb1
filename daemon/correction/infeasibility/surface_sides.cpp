// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/surface_sides.h"

#include <algorithm>

#include "daemon/geometry/ray_crossing.h"

namespace camway::correction {

using geometry::Vec3;

SurfaceSides::SurfaceSides(const scene::WholeMesh& mesh, const scene::SceneIndex& index)
    : mesh_(*mesh), index_(index), patch_of_(mesh->triangles.size(), scene::kNoIndex) {
  const scene::ClosedSurfaces& closed = mesh.closed_surfaces();
  const scene::Lists& patches = closed.complex.patches;
  for (std::uint32_t patch = 0; patch < patches.size(); ++patch) {
    for (const std::uint32_t t : patches[patch]) patch_of_[t] = patch;
  }
  surfaces_of_.resize(patches.size());
  for (std::uint32_t surface = 0; surface < closed.surfaces.size(); ++surface) {
    for (const std::uint32_t patch : closed.surfaces[surface]) {
      surfaces_of_[patch].push_back(surface);
    }
  }
}

std::optional<scene::IndexSet> SurfaceSides::around(const Vec3& point_W) const {
  // The box that the ray passes along x; the shift of `ray_hit` is smaller than any box.
  const Vec3 far_W(std::max(point_W.x(), index_.bounds().max().x()), point_W.y(), point_W.z());
  scene::IndexSet met;
  index_.for_each_touching(geometry::Box(point_W, far_W), [&](std::uint32_t t) {
    if (patch_of_[t] != scene::kNoIndex) met.push_back(t);
    return true;
  });
  std::ranges::sort(met);
  // Not std::ranges::unique: Clang 14 cannot compile that of GCC 12's library.
  met.erase(std::unique(met.begin(), met.end()), met.end());
  scene::IndexSet inside;
  for (const std::uint32_t t : met) {
    const geometry::RayHit hit = geometry::ray_hit(point_W, mesh_.triangle(t));
    if (hit == geometry::RayHit::kOnTriangle) return std::nullopt;
    if (geometry::passes_through(hit))
      inside = scene::sum_mod_2(inside, surfaces_of_[patch_of_[t]]);
  }
  return inside;
}

}  // namespace camway::correction
