// SPDX-License-Identifier: MIT
#include "tools/drawing/storeys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace camway::draw {
namespace {

using geometry::Triangle;
using geometry::Vec3;

/// Floors of two storeys are at least this far apart: people cannot stand in less.
constexpr double kLeastStorey_m = 1.8;
/// Heights of one floor differ by less.
constexpr double kSameFloor_m = 0.25;

// Rays that find a floor: one from the point itself, and two rings of eight.
constexpr std::array kRings_m{1.0, 2.0};
constexpr std::size_t kPerRing = 8;
/// Rays that a surface has to meet to be the floor; a bed or a table meets fewer.
constexpr std::size_t kEnoughRays = 7;

/// Heights at which the rays of one point meet surfaces.
struct Hits {
  std::vector<std::vector<double>> of_ray;
};

std::vector<PlanPoint> rings_of_rays() {
  std::vector<PlanPoint> feet{PlanPoint(0.0, 0.0)};
  for (const double radius_m : kRings_m) {
    for (std::size_t i = 0; i < kPerRing; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kPerRing;
      feet.emplace_back(radius_m * PlanPoint(std::cos(angle), std::sin(angle)));
    }
  }
  return feet;
}

/// Returns the rays that measure how far a floor extends: a square of 8 x 8 m about the point.
std::vector<PlanPoint> square_of_rays() {
  constexpr int kHalf = 4;
  std::vector<PlanPoint> feet;
  for (int x = -kHalf; x <= kHalf; ++x) {
    for (int y = -kHalf; y <= kHalf; ++y) feet.emplace_back(x, y);
  }
  return feet;
}

double cross_of(const PlanPoint& a, const PlanPoint& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the height of a triangle above `p` on paper; nothing beside the triangle.
std::optional<double> height_at(const Triangle& t, SceneUp up, const PlanPoint& p) {
  const PlanPoint a = to_plan(t[0], up);
  const PlanPoint ab = to_plan(t[1], up) - a;
  const PlanPoint ac = to_plan(t[2], up) - a;
  const double area = cross_of(ab, ac);
  if (area == 0.0) return std::nullopt;
  const double v = cross_of(p - a, ac) / area;
  const double w = cross_of(ab, p - a) / area;
  if (!(v >= 0.0 && w >= 0.0 && v + w <= 1.0)) return std::nullopt;
  const double h = height_of(t[0], up);
  return h + v * (height_of(t[1], up) - h) + w * (height_of(t[2], up) - h);
}

/// The feet of all rays, in cells on paper.
class RayGrid {
 public:
  explicit RayGrid(const std::vector<PlanPoint>& feet) : feet_(feet) {
    for (const PlanPoint& foot : feet) box_.extend(foot);
    cell_m_ = std::max(0.5, box_.sizes().maxCoeff() / kMostCells);
    for (std::size_t i = 0; i < feet.size(); ++i) cells_[cell_of(feet[i])].push_back(i);
  }

  /// Calls `visit(ray)` for each ray whose foot is in `box` or near it.
  template <class Visit>
  void visit_in(const Eigen::AlignedBox2d& box, const Visit& visit) const {
    const Eigen::AlignedBox2d common = box.intersection(box_);
    if (common.isEmpty()) return;
    const Cell low = cell_of(common.min());
    const Cell high = cell_of(common.max());
    for (int x = low[0]; x <= high[0]; ++x) {
      for (auto it = cells_.lower_bound({x, low[1]}); it != cells_.end(); ++it) {
        if (it->first[0] != x || it->first[1] > high[1]) break;
        for (const std::size_t ray : it->second) visit(ray);
      }
    }
  }

  [[nodiscard]] const PlanPoint& foot(std::size_t ray) const { return feet_[ray]; }

 private:
  using Cell = std::array<int, 2>;
  static constexpr double kMostCells = 200.0;  // in either direction
  [[nodiscard]] Cell cell_of(const PlanPoint& p) const {
    return {static_cast<int>((p.x() - box_.min().x()) / cell_m_),
            static_cast<int>((p.y() - box_.min().y()) / cell_m_)};
  }

  const std::vector<PlanPoint>& feet_;
  Eigen::AlignedBox2d box_;
  double cell_m_ = 1.0;
  std::map<Cell, std::vector<std::size_t>> cells_;
};

bool is_walkable(const Triangle& t, SceneUp up) {
  constexpr double kSteepest = 0.7;  // cosine of the slope
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  return std::abs(height_of(normal, up)) > kSteepest * normal.norm();
}

/// Returns where rays downwards from each point and from `rays` about it meet surfaces.
std::vector<Hits> hits_below(const scene::Mesh& mesh, SceneUp up, const std::vector<Vec3>& points_W,
                             const std::vector<PlanPoint>& rays) {
  constexpr double kLeastBelow_m = 0.1;
  std::vector<PlanPoint> feet;
  for (const Vec3& p_W : points_W) {
    for (const PlanPoint& ray : rays) feet.emplace_back(to_plan(p_W, up) + ray);
  }
  const RayGrid grid(feet);
  std::vector<Hits> hits(points_W.size(), {std::vector<std::vector<double>>(rays.size())});
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    if (!is_walkable(triangle, up)) continue;
    Eigen::AlignedBox2d box;
    for (const Vec3& corner : triangle) box.extend(to_plan(corner, up));
    grid.visit_in(box, [&](std::size_t ray) {
      const std::optional<double> h = height_at(triangle, up, grid.foot(ray));
      const std::size_t point = ray / rays.size();
      if (!h || *h > height_of(points_W[point], up) - kLeastBelow_m) return;
      hits[point].of_ray[ray % rays.size()].push_back(*h);
    });
  }
  return hits;
}

/// Returns the height of the highest surface that enough rays meet: the middle one of where they
/// do, as a tread or the foot of a chair may lie a little higher. The ray of the point itself has
/// to be one of them: beside stairs, the others meet floors above which the point is not.
std::optional<double> floor_among(const Hits& hits) {
  constexpr double kSameSurface_m = 0.2;
  std::vector<double> levels;
  for (const std::vector<double>& ray : hits.of_ray) {
    levels.insert(levels.end(), ray.begin(), ray.end());
  }
  std::ranges::sort(levels, std::greater());
  double last = std::numeric_limits<double>::infinity();
  for (const double level : levels) {
    if (level == last) continue;
    last = level;
    std::vector<double> met;  // by each ray, its highest hit
    bool is_below = false;
    for (std::size_t i = 0; i < hits.of_ray.size(); ++i) {
      double highest = -std::numeric_limits<double>::infinity();
      for (const double h : hits.of_ray[i]) {
        if (h <= level && h >= level - kSameSurface_m) highest = std::max(highest, h);
      }
      if (!std::isfinite(highest)) continue;
      met.push_back(highest);
      is_below = is_below || i == 0;
    }
    if (!is_below) continue;
    if (met.size() < kEnoughRays) continue;
    std::ranges::sort(met);
    return met[met.size() / 2];
  }
  return std::nullopt;
}

/// A height about which floors of points are.
struct FloorLevel {
  double height_m = 0.0;
  std::size_t points = 0;
  double extent = 0.0;  ///< largest share of the square about a point that is on the level

  [[nodiscard]] bool is_about(double floor_m) const {
    return std::abs(floor_m - height_m) <= 2 * kSameFloor_m;
  }
};

/// Returns the levels of `floors_m`, those of most points first. Requires sorted heights.
std::vector<FloorLevel> levels_among(std::vector<double> floors_m) {
  std::vector<FloorLevel> levels;
  while (!floors_m.empty()) {
    FloorLevel level;
    for (std::size_t i = 0; i < floors_m.size(); ++i) {
      const auto end =
          std::upper_bound(floors_m.begin(), floors_m.end(), floors_m[i] + 2 * kSameFloor_m);
      const auto count = static_cast<std::size_t>(end - floors_m.begin()) - i;
      if (count > level.points) level = {floors_m[i + count / 2], count};
    }
    std::erase_if(floors_m, [&](double h) { return level.is_about(h); });
    levels.push_back(level);
  }
  return levels;
}

/// Measures how far the levels extend about some of their points.
void measure_extents(const scene::Mesh& mesh, SceneUp up, const std::vector<Vec3>& points_W,
                     const std::vector<std::optional<double>>& floors,
                     std::vector<FloorLevel>& levels) {
  constexpr std::size_t kMostMeasured = 9;  // points of a level
  std::vector<Vec3> measured_W;
  std::vector<FloorLevel*> level_of;
  for (FloorLevel& level : levels) {
    std::vector<Vec3> on_W;
    for (std::size_t i = 0; i < floors.size(); ++i) {
      if (floors[i] && level.is_about(*floors[i])) on_W.push_back(points_W[i]);
    }
    const std::size_t count = std::min(on_W.size(), kMostMeasured);
    for (std::size_t i = 0; i < count; ++i) {
      measured_W.push_back(on_W[i * (on_W.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
      level_of.push_back(&level);
    }
  }
  const std::vector<Hits> hits = hits_below(mesh, up, measured_W, square_of_rays());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    FloorLevel& level = *level_of[i];
    const auto is_met = [&](const std::vector<double>& ray) {
      return std::ranges::any_of(
          ray, [&](double h) { return std::abs(h - level.height_m) <= kSameFloor_m; });
    };
    const auto met = static_cast<double>(std::ranges::count_if(hits[i].of_ray, is_met));
    level.extent = std::max(level.extent, met / static_cast<double>(hits[i].of_ray.size()));
  }
}

/// Takes the levels that are too small for a storey out of `levels`, and returns them: landings of
/// stairs. In a small building every floor is small.
std::vector<FloorLevel> take_landings(std::vector<FloorLevel>& levels) {
  constexpr double kLeastExtent = 0.25;  // the square about a point in the corner of a storey
  constexpr double kLeastOfWidest = 0.5;
  double widest = 0.0;
  for (const FloorLevel& level : levels) widest = std::max(widest, level.extent);
  const double least = std::min(kLeastExtent, kLeastOfWidest * widest);
  // Not std::ranges::stable_partition: Clang 14 cannot compile that of GCC 12's library.
  const auto landings = std::stable_partition(
      levels.begin(), levels.end(), [&](const FloorLevel& level) { return level.extent >= least; });
  std::vector<FloorLevel> taken(landings, levels.end());
  levels.erase(landings, levels.end());
  return taken;
}

/// Returns the heights of the levels that are at least a storey apart, lowest first; nothing if too
/// many points are about none of them. Requires the levels of most points first.
std::vector<double> storeys_among(const std::vector<FloorLevel>& levels) {
  constexpr double kLeastShare = 0.7;
  std::vector<double> storeys_m;
  std::size_t covered = 0;
  std::size_t all = 0;
  for (const FloorLevel& level : levels) {
    all += level.points;
    const bool is_apart = std::ranges::all_of(storeys_m, [&](double other) {
      return std::abs(level.height_m - other) >= kLeastStorey_m;
    });
    if (!is_apart) continue;
    storeys_m.push_back(level.height_m);
    covered += level.points;
  }
  if (static_cast<double>(covered) < kLeastShare * static_cast<double>(all)) return {};
  std::ranges::sort(storeys_m);
  return storeys_m;
}

std::size_t nearest_level(const std::vector<double>& levels, double height_m) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    if (std::abs(levels[i] - height_m) < std::abs(levels[nearest] - height_m)) nearest = i;
  }
  return nearest;
}

/// Gives points without a floor the floor of the nearest point with one.
std::vector<double> filled(const std::vector<std::optional<double>>& floors) {
  std::vector<double> all(floors.size(), 0.0);
  constexpr auto kFar = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> distance(floors.size(), kFar);
  std::size_t last = kFar;
  const auto pass = [&](std::size_t i) {
    if (floors[i]) last = i;
    if (last == kFar) return;
    const std::size_t steps = i > last ? i - last : last - i;
    if (steps >= distance[i]) return;
    distance[i] = steps;
    all[i] = *floors[last];
  };
  for (std::size_t i = 0; i < floors.size(); ++i) pass(i);
  last = kFar;
  for (std::size_t i = floors.size(); i-- > 0;) pass(i);
  return all;
}

/// Leaves out levels that have neither a few points in a row nor one of the first `certain` points.
void drop_rare(std::vector<double>& levels, const std::vector<double>& floors,
               std::size_t certain) {
  constexpr std::size_t kEnoughInARow = 3;
  std::vector<bool> is_visited(levels.size(), false);
  std::size_t in_a_row = 0;
  std::size_t last = levels.size();
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const std::size_t level = nearest_level(levels, floors[i]);
    in_a_row = level == last ? in_a_row + 1 : 1;
    last = level;
    if (i < certain || in_a_row >= kEnoughInARow) is_visited[level] = true;
  }
  for (std::size_t i = levels.size(); i-- > 0;) {
    if (!is_visited[i]) levels.erase(levels.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

VisitedStoreys visited_storeys(const scene::Mesh& mesh, SceneUp up,
                               const std::vector<Vec3>& points_W, std::size_t certain) {
  VisitedStoreys storeys;
  storeys.of_point.assign(points_W.size(), 0);
  std::vector<std::optional<double>> floors;
  std::vector<double> found;
  for (const Hits& hits : hits_below(mesh, up, points_W, rings_of_rays())) {
    floors.push_back(floor_among(hits));
    if (floors.back()) found.push_back(*floors.back());
  }
  // On a hill, only its top is level.
  if (found.empty() || 2 * found.size() < points_W.size()) return storeys;
  std::ranges::sort(found);
  std::vector<FloorLevel> levels = levels_among(std::move(found));
  measure_extents(mesh, up, points_W, floors, levels);
  const std::vector<FloorLevel> landings = take_landings(levels);
  storeys.floors_m = storeys_among(levels);
  if (storeys.floors_m.empty()) return storeys;
  // A landing is on the storey that the path comes from or goes to, whichever is nearer in time.
  for (std::optional<double>& floor : floors) {
    const auto has_floor = [&](const FloorLevel& landing) { return landing.is_about(*floor); };
    if (floor && std::ranges::any_of(landings, has_floor)) floor.reset();
  }
  const std::vector<double> floor_of = filled(floors);
  drop_rare(storeys.floors_m, floor_of, certain);
  for (std::size_t i = 0; i < floor_of.size() && !storeys.floors_m.empty(); ++i) {
    storeys.of_point[i] = nearest_level(storeys.floors_m, floor_of[i]);
  }
  return storeys;
}

std::optional<double> ceiling_above(const scene::Mesh& mesh, SceneUp up,
                                    const std::vector<Vec3>& points_W, double floor_m) {
  std::vector<PlanPoint> feet;
  for (const Vec3& p_W : points_W) feet.push_back(to_plan(p_W, up));
  std::optional<double> ceiling_m;
  if (feet.empty()) return ceiling_m;
  const RayGrid grid(feet);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    Eigen::AlignedBox2d box;
    for (const Vec3& corner : triangle) box.extend(to_plan(corner, up));
    grid.visit_in(box, [&](std::size_t ray) {
      const std::optional<double> h = height_at(triangle, up, grid.foot(ray));
      if (!h || *h < std::max(floor_m + kLeastStorey_m, height_of(points_W[ray], up))) return;
      if (!ceiling_m || *h < *ceiling_m) ceiling_m = h;
    });
  }
  return ceiling_m;
}

namespace {

/// Areas of the level faces of a scene by height.
class LevelAreas {
 public:
  LevelAreas(const scene::Mesh& mesh, SceneUp up) {
    constexpr double kLevelCosine = 0.99;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle t = mesh.triangle(i);
      const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
      if (!(std::abs(height_of(normal, up)) > kLevelCosine * normal.norm())) continue;
      const double h = std::max({height_of(t[0], up), height_of(t[1], up), height_of(t[2], up)});
      Level& level = levels_[static_cast<std::int64_t>(std::floor(h / kStep_m))];
      if (level.area_m2 == 0.0 || h > level.height_m) level.height_m = h;
      level.area_m2 += 0.5 * normal.norm();
    }
  }

  struct Level {
    double height_m = 0.0;
    double area_m2 = 0.0;
  };

  /// Returns all levels, the largest area first.
  [[nodiscard]] std::vector<Level> by_area() const {
    std::vector<Level> all;
    for (const auto& [step, level] : levels_) all.push_back(level);
    std::ranges::stable_sort(all, std::greater(), &Level::area_m2);
    return all;
  }

  /// Returns the upper side of the slab of which `level` is either side.
  [[nodiscard]] Level upper_side(const Level& level) const {
    constexpr double kThickestSlab_m = 0.6;
    constexpr double kAsLarge = 0.8;
    Level upper = level;
    for (const auto& [step, other] : levels_) {
      const double above = other.height_m - level.height_m;
      if (above > 0.0 && above <= kThickestSlab_m && other.area_m2 >= kAsLarge * level.area_m2) {
        upper = other;
      }
    }
    return upper;
  }

 private:
  static constexpr double kStep_m = 0.02;
  std::map<std::int64_t, Level> levels_;
};

/// Returns the area of all faces as seen along an axis, hidden ones included.
double area_seen_m2(const scene::Mesh& mesh, SceneUp up) {
  double area_m2 = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    area_m2 += 0.5 * std::abs(height_of((t[1] - t[0]).cross(t[2] - t[0]), up));
  }
  return area_m2;
}

double length_of_walls(const scene::Mesh& mesh, SceneUp up, double height_m) {
  double length_m = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    std::array<PlanPoint, 2> ends;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3 && count < 2; ++k) {
      const double a = height_of(t[k], up) - height_m;
      const double b = height_of(t[(k + 1) % 3], up) - height_m;
      if ((a < 0.0) == (b < 0.0)) continue;
      ends[count++] = to_plan(t[k] + a / (a - b) * (t[(k + 1) % 3] - t[k]), up);
    }
    if (count == 2) length_m += (ends[1] - ends[0]).norm();
  }
  return length_m;
}

}  // namespace

std::vector<double> storeys_of(const scene::Mesh& mesh, SceneUp up) {
  constexpr double kLeastArea = 0.05;
  constexpr double kLeastWalls = 0.1;
  constexpr double kMostlyLevel = 0.4;
  constexpr std::size_t kMostLevels = 16;
  struct Candidate {
    double height_m;
    double walls_m;
  };
  std::vector<Candidate> candidates;
  const LevelAreas areas(mesh, up);
  const std::vector<LevelAreas::Level> levels = areas.by_area();
  double most_walls_m = 0.0;
  double all_m2 = 0.0;
  for (const LevelAreas::Level& level : levels) all_m2 += level.area_m2;
  if (all_m2 < kMostlyLevel * area_seen_m2(mesh, up)) return {};
  for (const LevelAreas::Level& level : levels) {
    if (level.area_m2 < kLeastArea * levels.front().area_m2) break;
    if (candidates.size() == kMostLevels) break;
    const double floor_m = areas.upper_side(level).height_m;
    const bool is_apart = std::ranges::all_of(candidates, [&](const Candidate& other) {
      return std::abs(floor_m - other.height_m) >= kLeastStorey_m;
    });
    if (!is_apart) continue;
    candidates.push_back({floor_m, length_of_walls(mesh, up, floor_m + kEyes_m)});
    most_walls_m = std::max(most_walls_m, candidates.back().walls_m);
  }
  std::vector<double> floors;
  for (const Candidate& candidate : candidates) {
    if (candidate.walls_m > 0.0 && candidate.walls_m >= kLeastWalls * most_walls_m) {
      floors.push_back(candidate.height_m);
    }
  }
  std::ranges::sort(floors);
  return floors;
}

SceneUp up_of(const scene::Mesh& mesh) {
  const bool is_z = area_seen_m2(mesh, SceneUp::kZ) > area_seen_m2(mesh, SceneUp::kY);
  return is_z ? SceneUp::kZ : SceneUp::kY;
}

}  // namespace camway::draw
