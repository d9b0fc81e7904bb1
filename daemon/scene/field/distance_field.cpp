// SPDX-License-Identifier: MIT
#include "daemon/scene/field/distance_field.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/base/parallel_chunks.h"
#include "daemon/geometry/rounding.h"
#include "daemon/scene/field/distance_transform.h"
#include "daemon/scene/field/surface_cells.h"

namespace camway::scene {
namespace {

using geometry::Vec3;

constexpr std::size_t kLevels = 256;
using SquaredLevels = std::array<std::int32_t, kLevels>;

/// Squares of the levels, in cells: every integer at first, then in steps of 2.7 % (1.3 % of the
/// distance), such that the last is just beyond kMaxSquaredCellDistance and the one before it is
/// used.
constexpr SquaredLevels kSquaredLevels = [] {
  SquaredLevels levels{};
  for (std::size_t i = 1; i < kLevels; ++i) {
    levels[i] = levels[i - 1] + 1 + levels[i - 1] * 27 / 1024;
  }
  return levels;
}();
static_assert(kSquaredLevels[kLevels - 1] > kMaxSquaredCellDistance);
static_assert(kSquaredLevels[kLevels - 2] <= kMaxSquaredCellDistance);

/// For every squared distance the highest level that does not exceed it.
CellDistanceCodes level_codes() {
  CellDistanceCodes codes{};
  std::size_t level = 0;
  for (std::size_t squared = 0; squared < codes.size(); ++squared) {
    while (kSquaredLevels[level + 1] <= static_cast<std::int32_t>(squared)) ++level;
    codes[squared] = static_cast<std::uint8_t>(level);
  }
  return codes;
}

/// The lengths of the levels. None exceeds the distance between a point looked up in a cell and a
/// triangle's point that many cells away.
///
/// The margin of marking covers all rounding here. With u = 2^-53 and n cells on the longest side,
/// a triangle's point in the nearest marked cell is at least `reliable_margin_cells` = 12u·n away
/// from each face towards the other cell; otherwise the cell beyond that face would be marked, too,
/// and nearer. The point looked up is off its cell by `coordinate_error_cells` = 4u·n, so 8u·n is
/// left of each gap that is not 0, and of the length at least as much. Root and product round by
/// 2u·√3·n.
std::array<double, kLevels> level_lengths_m(const CellGrid& grid) {
  std::array<double, kLevels> lengths_m{};
  for (std::size_t i = 0; i < kLevels; ++i) {
    lengths_m[i] = std::sqrt(static_cast<double>(kSquaredLevels[i])) * grid.resolution_m;
  }
  return lengths_m;
}

/// The finest grid around `bounds` that `fits`, up to a hundredth of a per cent; nothing if the
/// coarsest one does not fit.
template <class Fits>
std::optional<CellGrid> finest_grid(const geometry::Box& bounds, const Fits& fits) {
  const double longest_m = bounds.sizes().maxCoeff();
  const auto usable = [&](double resolution_m) {
    std::optional<CellGrid> grid = CellGrid::around(bounds, resolution_m);
    if (grid && !fits(*grid)) grid.reset();
    return grid;
  };
  std::optional<CellGrid> best = usable(longest_m);
  if (!best) return std::nullopt;
  // Each halving halves the logarithm of the ratio of the two resolutions, which is 2^15 at first.
  constexpr int kHalvings = 18;
  double too_fine_m = longest_m / CellGrid::kMaxSide;
  for (int i = 0; i < kHalvings; ++i) {
    const double resolution_m = std::sqrt(too_fine_m * best->resolution_m);
    if (std::optional<CellGrid> finer = usable(resolution_m)) {
      best = finer;
    } else {
      too_fine_m = resolution_m;
    }
  }
  return best;
}

/// The grid for `mesh` within the limits of `DistanceField`, or nothing.
std::optional<CellGrid> choose_grid(const Mesh& mesh, const geometry::Box& bounds,
                                    std::size_t most_cells, unsigned threads) {
  const SurfaceExtent extent = surface_extent(mesh, threads);
  const double most_effort =
      DistanceField::kEffort +
      DistanceField::kEffortPerTriangle * static_cast<double>(mesh.triangles.size());
  return finest_grid(bounds, [&](const CellGrid& candidate) {
    return candidate.cells() <= most_cells && extent.effort(candidate.resolution_m) <= most_effort;
  });
}

double settled_share(const CellGrid& grid, const std::vector<std::uint8_t>& codes,
                     std::uint8_t settling_code, unsigned threads) {
  const auto slices = static_cast<std::size_t>(grid.size[2]);
  const std::size_t in_slice = codes.size() / slices;
  std::vector<std::size_t> settled(slices);
  base::for_each_chunk(base::chunk_threads(threads), slices, [&](unsigned, std::size_t z) {
    const auto begin = codes.begin() + static_cast<std::ptrdiff_t>(z * in_slice);
    settled[z] = static_cast<std::size_t>(
        std::count_if(begin, begin + static_cast<std::ptrdiff_t>(in_slice),
                      [&](std::uint8_t code) { return code >= settling_code; }));
  });
  const std::size_t total = std::accumulate(settled.begin(), settled.end(), std::size_t{0});
  return static_cast<double>(total) / static_cast<double>(codes.size());
}

std::string too_little(double share, double resolution_m) {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "%.1f %% of the cells of %.4g m are %d cells or more away from the scene, and below "
      "%.0f %% it does not pay",
      100.0 * share, resolution_m, DistanceField::kSettlingCells,
      100.0 * DistanceField::kLeastSettledShare);
  return text;
}

}  // namespace

DistanceField::DistanceField(const CellGrid& grid, base::Array<std::uint8_t> codes,
                             double settled_share)
    : grid_(grid),
      row_(static_cast<std::size_t>(grid.size[0])),
      slice_(row_ * static_cast<std::size_t>(grid.size[1])),
      level_m_(level_lengths_m(grid)),
      codes_(std::move(codes)) {
  statistics_.resolution_m = grid.resolution_m;
  statistics_.cells = grid.size;
  statistics_.memory_bytes = sizeof *this + codes_.size();
  statistics_.settled_from_m = kSettlingCells * grid.resolution_m;
  statistics_.settled_share = settled_share;
}

// The grid's box is convex and contains the scene. So with q the point of the box nearest to p, the
// angle between p and every point s of the scene, seen from q, is at least 90°: |p-s|² >= |p-q|² +
// |q-s|².
double DistanceField::clearance_outside_m(const Vec3& point_W) const {
  if (!point_W.allFinite()) return 0.0;
  // By the same argument a point nearer to the box may replace one whose squares would overflow.
  Vec3 cell = grid_.in_cells(point_W.cwiseMax(-0x1p300).cwiseMin(0x1p300));
  Vec3 beyond_m;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double size = grid_.size[static_cast<std::size_t>(axis)];
    const double beyond = std::max({-cell[axis], cell[axis] - size, 0.0});
    // Within twice the box the coordinate is off by 8u·n cells, and the scene is a quarter of a
    // cell inside; further out it is off by a relative 4u of what is less than twice `beyond`.
    beyond_m[axis] = (1.0 - 8.0 * geometry::kUnitRoundoff) * beyond * grid_.resolution_m;
    cell[axis] = std::clamp(cell[axis], 0.0, size - 1.0);
  }
  const double inside_m = level_at(cell);
  // The factor and products above round by 3u; squares and sums by 4u, halved by the root; the root
  // by 1u.
  return (1.0 - 8.0 * geometry::kUnitRoundoff) *
         std::sqrt(beyond_m.squaredNorm() + inside_m * inside_m);
}

base::Result<std::shared_ptr<const DistanceField>> DistanceField::build(
    const Mesh& mesh, const DistanceFieldOptions& options) {
  if (mesh.triangles.empty()) return base::Failure{"the scene has no triangles"};
  const geometry::Box bounds = mesh.bounds();
  const std::size_t wanted = std::max(kSmallestCells, kCellsPerTriangle * mesh.triangles.size());
  const std::size_t fitting =
      std::max(options.memory_limit_bytes, sizeof(DistanceField)) - sizeof(DistanceField);
  // Starting threads takes longer than a small field.
  const unsigned threads = wanted < 16 * kSmallestCells ? 1 : options.threads;
  const std::optional<CellGrid> grid =
      choose_grid(mesh, bounds, std::min(wanted, fitting), threads);
  if (!grid) return base::Failure{"no grid holds a scene of this extent within the limits"};
  std::vector<std::uint8_t> cells(grid->cells());
  mark_touched_cells(mesh, *grid, threads, cells);
  const CellDistanceCodes codes = level_codes();
  distance_transform(grid->size, threads, codes, cells);
  const double share = settled_share(*grid, cells, codes[kSettlingCells * kSettlingCells], threads);
  const bool flat = bounds.sizes().minCoeff() < kFlatness * bounds.sizes().maxCoeff();
  if (share < kLeastSettledShare && !flat) {
    return base::Failure{too_little(share, grid->resolution_m)};
  }
  return std::shared_ptr<const DistanceField>(new DistanceField(*grid, std::move(cells), share));
}

base::Result<std::shared_ptr<const DistanceField>> DistanceField::of_codes(
    const geometry::Box& bounds, double resolution_m, base::Array<std::uint8_t> codes,
    double settled_share) {
  const std::optional<CellGrid> grid = CellGrid::around(bounds, resolution_m);
  if (!grid || grid->cells() != codes.size()) {
    return base::Failure{"the distance field has not as many cells as its grid"};
  }
  if (!(settled_share >= 0.0 && settled_share <= 1.0)) {
    return base::Failure{"the share of settled cells of the distance field is not between 0 and 1"};
  }
  return std::shared_ptr<const DistanceField>(
      new DistanceField(*grid, std::move(codes), settled_share));
}

}  // namespace camway::scene
