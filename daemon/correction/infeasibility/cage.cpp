// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "daemon/base/budget.h"
#include "daemon/correction/infeasibility/cage_scene.h"
#include "daemon/correction/infeasibility/face_grid.h"
#include "daemon/correction/infeasibility/surface_parity.h"
#include "daemon/geometry/triangle_distance.h"

namespace camway::correction {
namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;

/// Cells across a bar, so many that inner ones do not touch its surface, whatever the grid's
/// offset.
constexpr double kCellsAcrossBar = 5.0;
/// Largest number of cells of a face, for time and memory: some hundredths of a second for all six
/// faces.
constexpr double kMaxCells = 2e5;
/// Largest number of lines along the surfaces of bars, per axis; beyond it only evenly spaced lines
/// are used.
constexpr std::size_t kMaxSurfaceLines = 1000;
/// Largest number of cells and triangles visited, and of boxes, for a few hundredths of a second:
/// most searches are in scenes without a cage.
constexpr std::int64_t kMaxSteps = 4'000'000;
constexpr int kMaxBoxes = 24;
/// Points around which boxes are tried, in each frame.
constexpr std::size_t kMaxPoints = 64;
/// Relative tolerance, far above the rounding of the sides of a near quadrilateral and of lengths
/// in a turned frame.
constexpr double kChordRounding = 1e-9;

/// A face of a box: where the coordinate `axis` is smallest or largest.
struct Face {
  int axis = 0;
  bool at_max = false;
  [[nodiscard]] std::size_t index() const {
    return 2 * static_cast<std::size_t>(axis) + (at_max ? 1 : 0);
  }
  [[nodiscard]] double at(const Box& box) const { return (at_max ? box.max() : box.min())[axis]; }
  [[nodiscard]] Box of(const Box& box) const {
    Box face = box;
    face.min()[axis] = face.max()[axis] = at(box);
    return face;
  }
};
constexpr std::array<Face, 6> kFaces{
    {{0, false}, {0, true}, {1, false}, {1, true}, {2, false}, {2, true}}};

class CageSearch {
 public:
  CageSearch(const CageScene& scene, std::span<const Vec3> centers_W, double shortest_chord_m,
             double within_m, base::Budget& budget)
      : scene_(scene), chord_m_(shortest_chord_m), budget_(budget) {
    for (const Vec3& center_W : centers_W) centers_.push_back(scene.in_frame(center_W));
    within_m_ = within_m + 2.0 * scene.margin_m().norm();
  }

  [[nodiscard]] std::optional<Cage> run() {
    const std::size_t points = std::min(centers_.size(), kMaxPoints);
    const CageBoxes boxes(scene_);
    std::vector<std::vector<Box>> around;
    for (std::size_t i = 0; i < points; ++i) around.push_back(boxes.around(centers_[i]));
    parities_of_.assign(points, {});
    int tried = 0;
    // Try the likeliest box of each point first: many points are in no cage and use up the steps.
    for (std::size_t rank = 0; rank < CageBoxes::kMost; ++rank) {
      for (std::size_t i = 0; i < points; ++i) {
        if (rank >= around[i].size()) continue;
        if (std::optional<Cage> cage = tried_as_cage(around[i][rank], i, tried)) return cage;
        if (tried == kMaxBoxes || budget_.is_overdrawn()) return std::nullopt;
      }
    }
    return std::nullopt;
  }

 private:
  enum class Parity : std::uint8_t { kNotAsked, kUnknown, kEven, kOdd };

  [[nodiscard]] std::optional<Cage> tried_as_cage(const Box& box, std::size_t inside, int& tried) {
    const std::optional<std::size_t> outside = first_outside(box);
    if (!outside || !is_inside(box, inside)) return std::nullopt;
    parities_of_[inside].resize(scene_.barriers().size(), Parity::kNotAsked);
    parities_ = parities_of_[inside];
    ++tried;
    return verified(box, inside, *outside);
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
  /// Whether all points within the uncertainty of the centre are beyond one side of the box.
  [[nodiscard]] bool is_outside(const Box& box, std::size_t i) const {
    const Vec3 room_m = (box.min() - centers_[i]).cwiseMax(centers_[i] - box.max());
    return room_m.maxCoeff() > margin_m(box, i);
  }
  /// Uncertainty of the centre, with far more than the rounding of a difference, 2^-53 of itself.
  [[nodiscard]] double margin_m(const Box& box, std::size_t i) const {
    return within_m_ + kChordRounding * (box.sizes().norm() + (centers_[i] - box.min()).norm());
  }

  /// Parity of the body relative to a closed surface; unknown if the body is too near to tell.
  [[nodiscard]] Parity parity(std::size_t barrier, const Vec3& center) {
    Parity& known = parities_[barrier];
    if (known == Parity::kNotAsked) known = found_parity(scene_.barriers()[barrier], center);
    return known;
  }
  [[nodiscard]] Parity found_parity(const Barrier& barrier, const Vec3& center) {
    spend(barrier.triangles.size());
    if (!is_closed(scene_.original(), barrier.triangles)) return Parity::kUnknown;
    const Triangle point = {center, center, center};
    for (const std::uint32_t t : barrier.triangles) {
      const Triangle triangle = scene_.mesh().triangle(t);
      if (!(geometry::triangle_distance(point, triangle) >
            within_m_ + geometry::triangle_distance_error_m(point, triangle))) {
        return Parity::kUnknown;
      }
    }
    const std::optional<bool> odd = is_odd(center, scene_.mesh(), barrier.triangles);
    if (!odd) return Parity::kUnknown;
    return *odd ? Parity::kOdd : Parity::kEven;
  }

  /// Closed surfaces that have a part of a face on the side opposite to the body's.
  [[nodiscard]] std::vector<std::size_t> barriers_at(const Box& box, const Vec3& center) {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < scene_.barriers().size(); ++i) {
      Box reach = scene_.barriers()[i].box;
      reach.min() -= 2.0 * scene_.margin_m();
      reach.max() += 2.0 * scene_.margin_m();
      const bool meets = std::any_of(kFaces.begin(), kFaces.end(), [&](const Face& face) {
        return face.of(box).intersects(reach);
      });
      if (!meets && !reach.contains(center)) continue;
      const Parity side = parity(i, center);
      if (side == Parity::kOdd || (side == Parity::kEven && meets)) result.push_back(i);
      if (budget_.is_overdrawn()) break;
    }
    return result;
  }

  /// Lines along the surfaces that are parallel to the axes; for others, lines fine enough for the
  /// thinnest.
  [[nodiscard]] std::array<FaceGrid::Lines, 3> lines(
      const Box& box, const std::vector<std::size_t>& barriers) const {
    const Vec3 size = box.sizes();
    const double area_m2 = size.prod() / size.minCoeff();
    double cell_m = box.diagonal().norm();
    std::array<FaceGrid::Lines, 3> result;
    const auto add = [&](const Vec3& point) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!(box.min()[axis] < point[axis] && point[axis] < box.max()[axis])) continue;
        result[static_cast<std::size_t>(axis)].push_back(point[axis]);
      }
    };
    for (const std::size_t i : barriers) {
      const Barrier& barrier = scene_.barriers()[i];
      add(barrier.box.min());
      add(barrier.box.max());
      if (!barrier.is_stepped) cell_m = std::min(cell_m, barrier.thickness_m() / kCellsAcrossBar);
      if (!barrier.is_stepped || barrier.triangles.size() == kTrianglesOfCuboid) continue;
      for (const std::uint32_t t : barrier.triangles) {
        for (const Vec3& corner : scene_.mesh().triangle(t)) add(corner);
      }
    }
    cell_m = std::max({cell_m, std::sqrt(area_m2 / kMaxCells), size.maxCoeff() / kMaxCells});
    for (int axis = 0; axis < 3; ++axis) {
      FaceGrid::Lines& along = result[static_cast<std::size_t>(axis)];
      std::sort(along.begin(), along.end());
      along.erase(std::unique(along.begin(), along.end()), along.end());
      if (along.size() > kMaxSurfaceLines) along.clear();
      const int cells = static_cast<int>(std::ceil(size[axis] / cell_m));
      for (int i = 1; i < cells; ++i) along.push_back(box.min()[axis] + size[axis] * i / cells);
      along.push_back(box.min()[axis]);
      along.push_back(box.max()[axis]);
      std::sort(along.begin(), along.end());
      along.erase(std::unique(along.begin(), along.end()), along.end());
      std::erase_if(along, [&](double x) { return x < box.min()[axis] || x > box.max()[axis]; });
    }
    return result;
  }

  /// Triangles in the plane of the face that meet it, grouped by surface, as a bar may stand on a
  /// floor.
  [[nodiscard]] std::map<std::uint32_t, std::vector<std::uint32_t>> flats_at(const Face& face,
                                                                             const Box& box) const {
    const std::vector<FlatTriangle>& flats = scene_.flats(face.axis);
    const double at = face.at(box);
    auto flat = std::lower_bound(flats.begin(), flats.end(), at,
                                 [](const FlatTriangle& a, double b) { return a.at < b; });
    std::map<std::uint32_t, std::vector<std::uint32_t>> result;
    for (; flat != flats.end() && flat->at == at; ++flat) {
      const Box bounds = geometry::bounds(scene_.mesh().triangle(flat->triangle));
      if (!face.of(box).intersects(bounds)) continue;
      result[scene_.barrier_of(flat->triangle)].push_back(flat->triangle);
    }
    return result;
  }

  [[nodiscard]] std::optional<Cage> verified(const Box& box, std::size_t inside,
                                             std::size_t outside) {
    const std::vector<std::size_t> barriers = barriers_at(box, centers_[inside]);
    const std::array<FaceGrid::Lines, 3> along = lines(box, barriers);
    // A face may have many lines on both sides: along surfaces on one, and evenly spaced on a long
    // other.
    std::size_t cells = 0;
    for (std::size_t k = 0; k < 3; ++k) cells += 2 * along[k].size() * along[(k + 1) % 3].size();
    if (!budget_.covers(static_cast<std::int64_t>(cells))) return std::nullopt;
    Cage cage{.inside = inside,
              .outside = outside,
              .box = {.box = box,
                      .orientation = scene_.orientation(),
                      .widest_hole_m = 0.0,
                      .shortest_chord_m = chord_m_},
              .triangles = {}};
    std::vector<FaceGrid> grids;
    for (const Face& face : kFaces) {
      grids.emplace_back(face.axis, face.at(box),
                         std::array{along[static_cast<std::size_t>((face.axis + 1) % 3)],
                                    along[static_cast<std::size_t>((face.axis + 2) % 3)]},
                         scene_.margin_m());
      spend(grids.back().cells());
      block(face, box, barriers, grids.back(), cage.triangles);
      if (budget_.is_overdrawn()) return std::nullopt;
      // A hole that is too wide with all edges closed is too wide with any adjacent faces.
      const auto closed = [](int, bool, std::size_t) { return true; };
      if (!is_narrow(grids.back().widest_hole_m(closed))) return std::nullopt;
    }
    const std::optional<double> widest_m = widest_hole_m(grids);
    if (!is_narrow(widest_m)) return std::nullopt;
    cage.box.widest_hole_m = *widest_m;
    std::sort(cage.triangles.begin(), cage.triangles.end());
    const auto same = std::unique(cage.triangles.begin(), cage.triangles.end());
    cage.triangles.erase(same, cage.triangles.end());
    return cage;
  }

  [[nodiscard]] bool is_narrow(const std::optional<double>& hole_m) const {
    return hole_m && *hole_m < chord_m_ * (1.0 - kChordRounding);
  }

  void block(const Face& face, const Box& box, const std::vector<std::size_t>& barriers,
             FaceGrid& grid, std::vector<std::uint32_t>& used) {
    for (const std::size_t i : barriers) {
      if (budget_.is_overdrawn()) return;
      const std::vector<std::uint32_t>& triangles = scene_.barriers()[i].triangles;
      spend(grid.block(scene_.mesh(), triangles, parities_[i] == Parity::kOdd));
      used.insert(used.end(), triangles.begin(), triangles.end());
    }
    for (const auto& [name, flats] : flats_at(face, box)) {
      if (budget_.is_overdrawn()) return;
      spend(grid.block_flat(scene_.mesh(), scene_.original(), flats));
      used.insert(used.end(), flats.begin(), flats.end());
    }
  }

  /// The widest hole of all faces. A piece of an edge of the box is blocked if either of its two
  /// faces blocks it.
  [[nodiscard]] static std::optional<double> widest_hole_m(const std::vector<FaceGrid>& grids) {
    double widest_m = 0.0;
    for (const Face& face : kFaces) {
      const std::optional<double> hole_m =
          grids[face.index()].widest_hole_m([&](int axis, bool at_max, std::size_t index) {
            const Face beside{axis, at_max};
            return grids[beside.index()].is_blocked_at_border(face.axis, face.at_max, index);
          });
      if (!hole_m) return std::nullopt;
      widest_m = std::max(widest_m, *hole_m);
    }
    return widest_m;
  }

  void spend(std::size_t steps) { budget_.spend(static_cast<std::int64_t>(steps)); }

  static constexpr std::size_t kTrianglesOfCuboid = 12;

  const CageScene& scene_;
  std::vector<Vec3> centers_;
  double chord_m_;
  double within_m_ = 0.0;
  base::Budget& budget_;
  /// Parities by point and barrier, computed on demand.
  std::vector<std::vector<Parity>> parities_of_;
  std::span<Parity> parities_;  ///< parities of the point inside
};

}  // namespace

std::optional<Cage> find_cage(const scene::Mesh& mesh, const scene::ClosedSurfaces& surfaces,
                              std::span<const Vec3> centers_W, double shortest_chord_m,
                              double within_m) {
  if (centers_W.size() < 2) return std::nullopt;
  base::Budget budget(kMaxSteps);
  for (const CageScene& scene : cage_scenes(mesh, surfaces, shortest_chord_m)) {
    if (std::optional<Cage> cage =
            CageSearch(scene, centers_W, shortest_chord_m, within_m, budget).run()) {
      return cage;
    }
  }
  return std::nullopt;
}

}  // namespace camway::correction
