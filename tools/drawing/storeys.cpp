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

namespace camway::draw {
namespace {

using geometry::Triangle;
using geometry::Vec3;

/// Floors of two storeys are at least this far apart: people cannot stand in less.
constexpr double kLeastStorey_m = 1.8;
/// Heights of one floor differ by less.
constexpr double kSameFloor_m = 0.25;

// Rays: one from the point itself, and two rings of eight.
constexpr std::array kRings_m{1.0, 2.0};
constexpr std::size_t kPerRing = 8;
constexpr std::size_t kRays = 1 + kRings_m.size() * kPerRing;
/// Rays that a surface has to meet to be the floor; a bed or a table meets fewer.
constexpr std::size_t kEnoughRays = 7;

/// Heights at which the rays of one point meet surfaces.
struct Hits {
  std::array<std::vector<double>, kRays> of_ray;
};

std::vector<PlanPoint> feet_of(const PlanPoint& p) {
  std::vector<PlanPoint> feet{p};
  for (const double radius_m : kRings_m) {
    for (std::size_t i = 0; i < kPerRing; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kPerRing;
      feet.emplace_back(p + radius_m * PlanPoint(std::cos(angle), std::sin(angle)));
    }
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

std::vector<Hits> hits_below(const scene::Mesh& mesh, SceneUp up,
                             const std::vector<Vec3>& points_W) {
  constexpr double kLeastBelow_m = 0.1;
  std::vector<PlanPoint> feet;
  for (const Vec3& p_W : points_W) {
    for (const PlanPoint& foot : feet_of(to_plan(p_W, up))) feet.push_back(foot);
  }
  const RayGrid grid(feet);
  std::vector<Hits> hits(points_W.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    if (!is_walkable(triangle, up)) continue;
    Eigen::AlignedBox2d box;
    for (const Vec3& corner : triangle) box.extend(to_plan(corner, up));
    grid.visit_in(box, [&](std::size_t ray) {
      const std::optional<double> h = height_at(triangle, up, grid.foot(ray));
      const std::size_t point = ray / kRays;
      if (!h || *h > height_of(points_W[point], up) - kLeastBelow_m) return;
      hits[point].of_ray[ray % kRays].push_back(*h);
    });
  }
  return hits;
}

/// Returns the highest level that enough rays meet.
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
    const auto meets = [&](const std::vector<double>& ray) {
      return std::ranges::any_of(
          ray, [&](double h) { return h <= level && h >= level - kSameSurface_m; });
    };
    const auto count = std::ranges::count_if(hits.of_ray, meets);
    if (static_cast<std::size_t>(count) >= kEnoughRays) return level;
  }
  return std::nullopt;
}

/// Returns the heights about which most of `floors_m` are, at least a storey apart, lowest first;
/// nothing if too many are about none of them. Requires sorted heights.
std::vector<double> levels_among(const std::vector<double>& floors_m) {
  constexpr double kLeastShare = 0.7;
  std::vector<double> levels;
  std::vector<double> left = floors_m;
  std::size_t covered = 0;
  while (!left.empty()) {
    std::size_t most = 0;
    double level = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const auto end = std::upper_bound(left.begin(), left.end(), left[i] + 2 * kSameFloor_m);
      const auto count = static_cast<std::size_t>(end - left.begin()) - i;
      if (count <= most) continue;
      most = count;
      level = left[i + count / 2];
    }
    const bool is_apart = std::ranges::all_of(
        levels, [&](double other) { return std::abs(level - other) >= kLeastStorey_m; });
    if (is_apart) {
      levels.push_back(level);
      covered += most;
    }
    std::erase_if(left, [&](double h) { return std::abs(h - level) <= 2 * kSameFloor_m; });
  }
  if (static_cast<double>(covered) < kLeastShare * static_cast<double>(floors_m.size())) return {};
  std::ranges::sort(levels);
  return levels;
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
  const auto pass = [&](std::size_t i, std::optional<std::size_t>& last) {
    if (floors[i]) last = i;
    if (!last) return;
    const std::size_t steps = i > *last ? i - *last : *last - i;
    if (steps >= distance[i]) return;
    distance[i] = steps;
    all[i] = *floors[*last];
  };
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < floors.size(); ++i) pass(i, last);
  last.reset();
  for (std::size_t i = floors.size(); i-- > 0;) pass(i, last);
  return all;
}

/// Leaves out levels with few points, none of which is one of the first `certain`.
void drop_rare(std::vector<double>& levels, const std::vector<double>& floors,
               std::size_t certain) {
  constexpr double kRare = 0.03;
  std::vector<std::size_t> counts(levels.size(), 0);
  std::vector<bool> is_certain(levels.size(), false);
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const std::size_t level = nearest_level(levels, floors[i]);
    ++counts[level];
    if (i < certain) is_certain[level] = true;
  }
  for (std::size_t i = levels.size(); i-- > 0;) {
    const bool is_rare =
        static_cast<double>(counts[i]) < kRare * static_cast<double>(floors.size());
    if (counts[i] == 0 || (is_rare && !is_certain[i])) {
      levels.erase(levels.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

}  // namespace

VisitedStoreys visited_storeys(const scene::Mesh& mesh, SceneUp up,
                               const std::vector<Vec3>& points_W, std::size_t certain) {
  VisitedStoreys storeys;
  storeys.of_point.assign(points_W.size(), 0);
  std::vector<std::optional<double>> floors;
  std::vector<double> found;
  for (const Hits& hits : hits_below(mesh, up, points_W)) {
    floors.push_back(floor_among(hits));
    if (floors.back()) found.push_back(*floors.back());
  }
  // On a hill, only its top is level.
  if (found.empty() || 2 * found.size() < points_W.size()) return storeys;
  std::ranges::sort(found);
  storeys.floors_m = levels_among(found);
  if (storeys.floors_m.empty()) return storeys;
  const std::vector<double> floor_of = filled(floors);
  drop_rare(storeys.floors_m, floor_of, certain);
  for (std::size_t i = 0; i < floor_of.size() && !storeys.floors_m.empty(); ++i) {
    storeys.of_point[i] = nearest_level(storeys.floors_m, floor_of[i]);
  }
  return storeys;
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
