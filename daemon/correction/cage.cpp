// SPDX-License-Identifier: MIT
#include "daemon/correction/cage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/correction/face_grid.h"
#include "daemon/correction/surface_parity.h"
#include "daemon/geometry/triangle_distance.h"

namespace camway::correction {
namespace {

using geometry::Box;
using geometry::Vec3;

/// A bar is at least this many times as long as it is thick.
constexpr double kLeastSlenderness = 3.0;
/// Cells across a bar: the outer ones touch its surface, whatever the grid's offset.
constexpr double kCellsAcrossBar = 5.0;
/// Of one face, for time and memory: a tenth of a second for all six.
constexpr double kMaxCells = 4e6;
/// Cells and triangles of all boxes that are looked at, and boxes: about half a second.
constexpr std::size_t kMaxSteps = 50'000'000;
constexpr int kMaxBoxes = 8;
/// A face is the nearest plane with this share of the bars of the plane with the most; tried one
/// after the other, as behind a cage there may be a larger one, and within it shelves.
constexpr std::array<double, 3> kShares = {0.7, 0.4, 0.2};
/// Bars whose middles differ by less than this share of their thickness are in one plane.
constexpr double kPlaneShare = 0.1;
/// What the sides of a near quadrilateral may be off by, for rounding, is far below this share.
constexpr double kChordRounding = 1e-9;

struct Bar {
  std::vector<std::uint32_t> triangles;
  Box box;
  double thickness_m = 0.0;
};

/// The middles of bars that lie in one plane.
struct Plane {
  double at = 0.0;
  std::size_t bars = 0;
};

class CageSearch {
 public:
  CageSearch(const scene::Mesh& mesh, const ClosedSurfaces& surfaces,
             std::span<const Vec3> centers_W, double shortest_chord_m, double within_m)
      : mesh_(mesh), centers_(centers_W), chord_m_(shortest_chord_m), within_m_(within_m) {
    for (const IndexSet& surface : surfaces.surfaces) add_bar(surfaces.complex, surface);
    for (int axis = 0; axis < 3; ++axis) {
      planes_[static_cast<std::size_t>(axis)] = planes(axis);
    }
  }

  [[nodiscard]] std::optional<Cage> run() {
    int boxes = 0;
    for (std::size_t i = 0; i < centers_.size(); ++i) {
      std::optional<Box> last;
      for (const double share : kShares) {
        const std::optional<Box> box = box_around(centers_[i], share);
        if (!box || (last && last->min() == box->min() && last->max() == box->max()) ||
            !is_inside(*box, i))
          continue;
        last = box;
        const std::optional<std::size_t> outside = first_outside(*box);
        if (!outside) continue;
        if (std::optional<Cage> cage = verified(*box, i, *outside)) return cage;
        if (++boxes == kMaxBoxes || steps_ > kMaxSteps) return std::nullopt;
      }
    }
    return std::nullopt;
  }

 private:
  void add_bar(const PatchComplex& complex, const IndexSet& surface) {
    Bar bar;
    for (const std::uint32_t patch : surface) {
      for (const std::uint32_t t : complex.patches[patch]) {
        bar.triangles.push_back(t);
        bar.box.extend(geometry::bounds(mesh_.triangle(t)));
      }
    }
    Vec3 size = bar.box.sizes();
    std::sort(size.begin(), size.end());
    bar.thickness_m = size[0];
    if (size[0] > 0.0 && size[0] < chord_m_ && size[2] >= kLeastSlenderness * size[0]) {
      bars_.push_back(std::move(bar));
    }
  }

  /// In order of their coordinates.
  [[nodiscard]] std::vector<Plane> planes(int axis) const {
    std::vector<std::array<double, 2>> middles;
    for (const Bar& bar : bars_) {
      // Not across the bar: no plane of a face.
      if (bar.box.sizes()[axis] > 2.0 * bar.thickness_m) continue;
      middles.push_back({bar.box.center()[axis], bar.thickness_m});
    }
    std::sort(middles.begin(), middles.end());
    std::vector<Plane> result;
    for (const auto& [middle, thickness_m] : middles) {
      if (result.empty() || middle - result.back().at > kPlaneShare * thickness_m) {
        result.push_back({.at = middle, .bars = 0});
      }
      ++result.back().bars;
    }
    return result;
  }

  /// The nearest plane on either side of `center` with at least this share of the bars of the one
  /// with the most, along each axis.
  [[nodiscard]] std::optional<Box> box_around(const Vec3& center, double share) const {
    Box box;
    box.min() = center;
    box.max() = center;
    for (int axis = 0; axis < 3; ++axis) {
      std::array<std::size_t, 2> most = {0, 0};
      const std::vector<Plane>& candidates = planes_[static_cast<std::size_t>(axis)];
      for (const Plane& plane : candidates) {
        std::size_t& side = most[plane.at < center[axis] ? 0 : 1];
        side = std::max(side, plane.bars);
      }
      if (most[0] == 0 || most[1] == 0) return std::nullopt;
      for (const Plane& plane : candidates) {  // the last one below stays
        if (plane.at < center[axis] && enough(plane, share, most[0])) box.min()[axis] = plane.at;
      }
      for (auto plane = candidates.rbegin(); plane != candidates.rend(); ++plane) {
        if (plane->at > center[axis] && enough(*plane, share, most[1])) box.max()[axis] = plane->at;
      }
    }
    return box;
  }

  [[nodiscard]] static bool enough(const Plane& plane, double share, std::size_t most) {
    return static_cast<double>(plane.bars) >= share * static_cast<double>(most);
  }

  [[nodiscard]] std::optional<std::size_t> first_outside(const Box& box) const {
    for (std::size_t i = 0; i < centers_.size(); ++i) {
      if (is_outside(box, i)) return i;
    }
    return std::nullopt;
  }
  [[nodiscard]] bool is_inside(const Box& box, std::size_t i) const {
    const Vec3 room_m = (centers_[i] - box.min()).cwiseMin(box.max() - centers_[i]);
    return room_m.minCoeff() > margin_m(box, i);
  }
  [[nodiscard]] bool is_outside(const Box& box, std::size_t i) const {
    const Vec3 room_m = (box.min() - centers_[i]).cwiseMax(centers_[i] - box.max());
    return room_m.maxCoeff() > margin_m(box, i);
  }
  /// A difference is rounded by one part in 2^53 of itself, far less than this.
  [[nodiscard]] double margin_m(const Box& box, std::size_t i) const {
    return within_m_ + kChordRounding * (box.sizes().norm() + (centers_[i] - box.min()).norm());
  }

  /// The parity of the body with regard to a bar; nothing where the body is too near to tell.
  [[nodiscard]] std::optional<bool> parity(const Bar& bar, const Vec3& center) const {
    const geometry::Triangle point = {center, center, center};
    for (const std::uint32_t t : bar.triangles) {
      const geometry::Triangle triangle = mesh_.triangle(t);
      if (!(geometry::triangle_distance(point, triangle) >
            within_m_ + geometry::triangle_distance_error_m(point, triangle))) {
        return std::nullopt;
      }
    }
    return is_odd(center, mesh_, bar.triangles);
  }

  [[nodiscard]] static bool meets(const Box& bar, const Box& box, int axis, double at) {
    Box face = box;
    face.min()[axis] = at;
    face.max()[axis] = at;
    return face.intersects(bar);
  }

  /// Cells of a size for the thinnest of the bars on any face; 0 if there are too many.
  [[nodiscard]] double cell_size_m(const Box& box) const {
    double cell_m = chord_m_;
    for (const Bar& bar : bars_) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double at : {box.min()[axis], box.max()[axis]}) {
          if (meets(bar.box, box, axis, at)) {
            cell_m = std::min(cell_m, bar.thickness_m / kCellsAcrossBar);
          }
        }
      }
    }
    const Vec3 size = box.sizes();
    const double area_m2 = size.prod() / size.minCoeff();
    return area_m2 / (cell_m * cell_m) <= kMaxCells ? cell_m : 0.0;
  }

  [[nodiscard]] std::optional<Cage> verified(const Box& box, std::size_t inside,
                                             std::size_t outside) {
    const double cell_m = cell_size_m(box);
    if (!(cell_m > 0.0)) return std::nullopt;
    Cage cage{
        .inside = inside, .outside = outside, .box = box, .widest_hole_m = 0, .triangles = {}};
    for (int axis = 0; axis < 3; ++axis) {
      for (const double at : {box.min()[axis], box.max()[axis]}) {
        FaceGrid face(box, axis, at, cell_m);
        for (const Bar& bar : bars_) {
          if (!meets(bar.box, box, axis, at)) continue;
          const std::optional<bool> odd = parity(bar, centers_[inside]);
          if (!odd) continue;
          steps_ += face.block(mesh_, bar.triangles, *odd);
          if (steps_ > kMaxSteps) return std::nullopt;
          cage.triangles.insert(cage.triangles.end(), bar.triangles.begin(), bar.triangles.end());
        }
        const std::optional<double> hole_m = face.widest_hole_m();
        if (!hole_m || !(*hole_m < chord_m_ * (1.0 - kChordRounding))) return std::nullopt;
        cage.widest_hole_m = std::max(cage.widest_hole_m, *hole_m);
      }
    }
    std::sort(cage.triangles.begin(), cage.triangles.end());
    cage.triangles.erase(std::unique(cage.triangles.begin(), cage.triangles.end()),
                         cage.triangles.end());
    return cage;
  }

  const scene::Mesh& mesh_;
  std::span<const Vec3> centers_;
  double chord_m_;
  double within_m_;
  std::vector<Bar> bars_;
  std::array<std::vector<Plane>, 3> planes_;
  std::size_t steps_ = 0;
};

}  // namespace

std::optional<Cage> find_cage(const scene::Mesh& mesh, const ClosedSurfaces& surfaces,
                              std::span<const Vec3> centers_W, double shortest_chord_m,
                              double within_m) {
  return CageSearch(mesh, surfaces, centers_W, shortest_chord_m, within_m).run();
}

}  // namespace camway::correction
