// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/separation.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "daemon/correction/infeasibility/surface_parity.h"
#include "daemon/geometry/ray_crossing.h"
#include "daemon/geometry/triangle_distance.h"

namespace camway::correction {
namespace {

using geometry::Triangle;
using geometry::Vec3;

/// In scenes with too many seams to find all closed surfaces: the number of points around which
/// surfaces are searched one by one.
constexpr std::size_t kMaxPointsToLookAround = 8;

bool is_clear(const scene::Mesh& mesh, const std::vector<std::uint32_t>& triangles,
              const geometry::LineSegment& segment, double within_m) {
  const Triangle flat = {segment.from, segment.from, segment.to};
  return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
    const Triangle triangle = mesh.triangle(t);
    return geometry::triangle_distance(flat, triangle) >
           within_m + geometry::triangle_distance_error_m(flat, triangle);
  });
}

class Search {
 public:
  Search(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
         std::span<const Vec3> points_W, double within_m)
      : mesh_(mesh), surfaces_(surfaces), points_(points_W), within_m_(within_m) {
    count_hits();
  }

  [[nodiscard]] std::optional<Separation> run() const {
    if (std::optional<Separation> found = among(surfaces_.surfaces)) return found;
    if (surfaces_.complete) return std::nullopt;
    const std::size_t last = std::min(points_.size(), kMaxPointsToLookAround);
    for (std::size_t i = 0; i < last; ++i) {
      const scene::ReducedPatches near =
          reduce_patches(surfaces_.complex, surfaces_.seams_of, nearest_first(points_[i]),
                         scene::kMaxEliminationStepsNear);
      if (std::optional<Separation> found = among(near.surfaces)) return found;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::optional<Separation> among(
      const std::vector<scene::IndexSet>& surfaces) const {
    std::vector<const scene::IndexSet*> separating;
    for (const scene::IndexSet& surface : surfaces) {
      if (separates(surface)) separating.push_back(&surface);
    }
    std::stable_sort(
        separating.begin(), separating.end(),
        [&](const scene::IndexSet* a, const scene::IndexSet* b) { return size(*a) < size(*b); });
    for (const scene::IndexSet* surface : separating) {
      if (std::optional<Separation> found = proof(*surface)) return found;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::uint32_t> nearest_first(const Vec3& point) const {
    const scene::Lists& patches = surfaces_.complex.patches;
    std::vector<double> distance2(patches.size(), std::numeric_limits<double>::infinity());
    for (std::size_t patch = 0; patch < patches.size(); ++patch) {
      for (const std::uint32_t t : patches[patch]) {
        const geometry::Box box = geometry::bounds(mesh_.triangle(t));
        distance2[patch] = std::min(distance2[patch], box.squaredExteriorDistance(point));
      }
    }
    std::vector<std::uint32_t> order(patches.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return distance2[a] < distance2[b]; });
    return order;
  }

  /// For each patch: the points from which a ray meets it an odd number of times, increasing.
  void count_hits() {
    odd_points_.resize(surfaces_.complex.patches.size());
    std::vector<std::uint32_t> by_y(points_.size());
    std::iota(by_y.begin(), by_y.end(), 0U);
    std::stable_sort(by_y.begin(), by_y.end(), [&](std::uint32_t a, std::uint32_t b) {
      return points_[a].y() < points_[b].y();
    });
    for (std::size_t patch = 0; patch < odd_points_.size(); ++patch) {
      for (const std::uint32_t t : surfaces_.complex.patches[patch]) {
        count_hits(by_y, mesh_.triangle(t), odd_points_[patch]);
      }
      scene::IndexSet& hits = odd_points_[patch];
      std::sort(hits.begin(), hits.end());
      cancel_pairs(hits);
    }
  }

  void count_hits(const std::vector<std::uint32_t>& by_y, const Triangle& triangle,
                  scene::IndexSet& hits) const {
    const auto [low, high] = std::minmax({triangle[0].y(), triangle[1].y(), triangle[2].y()});
    auto point = std::lower_bound(by_y.begin(), by_y.end(), low,
                                  [&](std::uint32_t i, double y) { return points_[i].y() < y; });
    for (; point != by_y.end() && points_[*point].y() <= high; ++point) {
      // The point is on a triangle; `proof` finds that the distance is 0.
      if (geometry::passes_through(geometry::ray_hit(points_[*point], triangle)))
        hits.push_back(*point);
    }
  }

  static void cancel_pairs(scene::IndexSet& sorted) {
    std::size_t kept = 0;
    for (const std::uint32_t i : sorted) {
      if (kept > 0 && sorted[kept - 1] == i) {
        --kept;
      } else {
        sorted[kept++] = i;
      }
    }
    sorted.resize(kept);
  }

  [[nodiscard]] scene::IndexSet odd_points(const scene::IndexSet& surface) const {
    scene::IndexSet odd;
    for (const std::uint32_t patch : surface) {
      odd.insert(odd.end(), odd_points_[patch].begin(), odd_points_[patch].end());
    }
    std::sort(odd.begin(), odd.end());
    cancel_pairs(odd);
    return odd;
  }

  [[nodiscard]] bool separates(const scene::IndexSet& surface) const {
    const std::size_t odd = odd_points(surface).size();
    return odd > 0 && odd < points_.size();
  }

  [[nodiscard]] std::size_t size(const scene::IndexSet& surface) const {
    std::size_t triangles = 0;
    for (const std::uint32_t patch : surface) triangles += surfaces_.complex.patches[patch].size();
    return triangles;
  }

  /// Returns the surface and the first point on either side that is clear of it, checked from
  /// scratch.
  [[nodiscard]] std::optional<Separation> proof(const scene::IndexSet& surface) const {
    Separation result;
    for (const std::uint32_t patch : surface) {
      const std::span<const std::uint32_t> triangles = surfaces_.complex.patches[patch];
      result.triangles.insert(result.triangles.end(), triangles.begin(), triangles.end());
    }
    std::sort(result.triangles.begin(), result.triangles.end());
    if (!is_closed(mesh_, result.triangles)) return std::nullopt;
    std::optional<std::size_t> inside;
    std::optional<std::size_t> outside;
    for (std::size_t i = 0; i < points_.size() && !(inside && outside); ++i) {
      const std::optional<bool> odd = is_odd(points_[i], mesh_, result.triangles);
      if (!odd) continue;
      std::optional<std::size_t>& side = *odd ? inside : outside;
      if (!side && is_clear(mesh_, result.triangles, {points_[i], points_[i]}, within_m_)) side = i;
    }
    if (!inside || !outside) return std::nullopt;
    result.inside = *inside;
    result.outside = *outside;
    return result;
  }

  const scene::Mesh& mesh_;
  const scene::ClosedSurfaces& surfaces_;
  std::span<const Vec3> points_;
  double within_m_;
  std::vector<scene::IndexSet> odd_points_;  ///< by patch
};

}  // namespace

std::optional<Separation> find_separation(const scene::Mesh& mesh,
                                          const scene::ClosedSurfaces& surfaces,
                                          std::span<const Vec3> points_W, double within_m) {
  if (points_W.size() < 2) return std::nullopt;
  return Search(mesh, surfaces, points_W, within_m).run();
}

bool keeps_clear(const Separation& surface, const scene::Mesh& mesh,
                 const geometry::LineSegment& inside_W, const geometry::LineSegment& outside_W,
                 double within_m) {
  return is_clear(mesh, surface.triangles, inside_W, within_m) &&
         is_clear(mesh, surface.triangles, outside_W, within_m);
}

}  // namespace camway::correction
