// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/object_mirror.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <sstream>
#include <utility>

#include "daemon/scene/mirror/box_costs.h"
#include "daemon/scene/mirror/mirror_voxels.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Finds the least `cost` over the boxes of occupied cubes; nothing if none is finite and <=
/// `limit`. Branch and bound, cheapest octant first; `box_costs.h` states the requirements on a
/// cost.
template <typename Cost>
class CheapestCube {
 public:
  /// A cost of at most `enough` is accepted in place of the least.
  CheapestCube(const VoxelTree& tree, const VoxelGrid& grid, const Cost& cost, double limit,
               double enough)
      : tree_(tree), grid_(grid), cost_(cost), limit_(limit), enough_(enough) {}

  std::optional<double> run() {
    Faces faces;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t first = tree_.root_cube().min[axis];
      faces[axis] = {grid_.low_face_m(first), grid_.high_face_m(first + tree_.root_cube().size)};
    }
    visit(tree_.root(), tree_.root_cube(), faces);
    return best_;
  }

 private:
  /// Lower and upper face, as in `VoxelGrid::box`.
  using Pair = std::array<double, 2>;
  using Faces = std::array<Pair, 3>;

  struct Way {
    double cost;
    unsigned octant;
  };

  [[nodiscard]] bool is_of_use(double cost) const {
    return cost <= limit_ && std::isfinite(cost) &&
           !(best_ && (cost >= *best_ || *best_ <= enough_));
  }

  void visit(const VoxelTree::Place& place, const VoxelCube& cube, const Faces& faces) {
    const std::int32_t half = cube.size / 2;
    std::array<std::array<Pair, 2>, 3> halves;  // by axis, lower and upper half of the cube
    std::array<std::array<typename Cost::Part, 2>, 3> parts;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t middle = cube.min[axis] + half;
      halves[axis] = {Pair{faces[axis][0], grid_.high_face_m(middle)},
                      Pair{grid_.low_face_m(middle), faces[axis][1]}};
      for (std::size_t side = 0; side < 2; ++side) {
        parts[axis][side] = cost_.along(static_cast<Eigen::Index>(axis), halves[axis][side][0],
                                        halves[axis][side][1]);
      }
    }
    take_full(place.node->full, parts);
    std::array<Way, 8> ways;
    const std::size_t count = sorted_ways(place.node->nodes, parts, ways);
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_of_use(ways[i].cost)) return;
      const unsigned octant = ways[i].octant;
      Faces within;
      for (std::size_t axis = 0; axis < 3; ++axis) within[axis] = halves[axis][octant >> axis & 1U];
      visit(tree_.child(place, octant), cube.child(octant), within);
    }
  }

  template <typename Parts>
  void take_full(unsigned octants, const Parts& parts) {
    for (; octants != 0; octants &= octants - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(octants));
      const double cost = cost_.total(parts[0][i & 1U], parts[1][i >> 1 & 1U], parts[2][i >> 2]);
      if (is_of_use(cost)) best_ = cost;
    }
  }

  /// Sorts octants by cost; equal costs stay in the order of the octants.
  template <typename Parts>
  std::size_t sorted_ways(unsigned octants, const Parts& parts, std::array<Way, 8>& ways) const {
    std::size_t count = 0;
    for (; octants != 0; octants &= octants - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(octants));
      const double cost = cost_.bound(parts[0][i & 1U], parts[1][i >> 1 & 1U], parts[2][i >> 2]);
      if (!is_of_use(cost)) continue;
      std::size_t place = count++;
      for (; place > 0 && ways[place - 1].cost > cost; --place) ways[place] = ways[place - 1];
      ways[place] = {cost, i};
    }
    return count;
  }

  const VoxelTree& tree_;
  const VoxelGrid& grid_;
  const Cost& cost_;
  double limit_;
  double enough_;
  std::optional<double> best_;
};

constexpr const char* kCancelled = "making its mirror was cancelled";

std::string describe(const Box& box) {
  std::ostringstream text;
  text << '[' << box.min().x() << ", " << box.min().y() << ", " << box.min().z() << "] to ["
       << box.max().x() << ", " << box.max().y() << ", " << box.max().z() << "] m";
  return text.str();
}

using Meshes = std::span<const Mesh* const>;

/// Why a scene with these bounds cannot be mirrored, or an empty text.
std::string refusal(const Box& bounds, double resolution_m) {
  std::ostringstream text;
  if (!VoxelGrid::valid_resolution(resolution_m)) {
    text << "occupancy resolution " << resolution_m << " m is not between "
         << VoxelGrid::kMinResolutionM << " and " << VoxelGrid::kMaxResolutionM << " m";
    return text.str();
  }
  const VoxelGrid grid(resolution_m);
  if (bounds.isEmpty()) return {};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (voxels_touching(grid, bounds.min()[axis], bounds.max()[axis])) continue;
    text << "scene extent " << describe(bounds) << " exceeds what an occupancy map of resolution "
         << resolution_m << " m can hold: " << ObjectMirror::kMaxKeyVoxels
         << " voxels from the origin, " << ObjectMirror::kMaxKeyVoxels * resolution_m << " m";
    return text.str();
  }
  return {};
}

std::string refusal(Meshes meshes, double resolution_m, const std::stop_token& stop) {
  Box bounds;
  std::size_t number = 0;
  for (const Mesh* mesh : meshes) {
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i, ++number) {
      if (stop.stop_requested()) return kCancelled;
      for (const Vec3& vertex : mesh->triangle(i)) {
        if (!vertex.allFinite()) return "triangle " + std::to_string(number) + " is not finite";
        bounds.extend(vertex);
      }
    }
  }
  return refusal(bounds, resolution_m);
}

std::string too_many(const Box& bounds, double resolution_m, std::uint64_t max_voxels) {
  std::ostringstream text;
  text << "an occupancy map of resolution " << resolution_m << " m would need more than "
       << max_voxels << " voxels for the scene extent " << describe(bounds);
  return text.str();
}

}  // namespace

ObjectMirror::BuildResult ObjectMirror::build(Meshes meshes, double resolution_m,
                                              const std::optional<PlacedVoxelMap>& solid,
                                              std::uint64_t max_voxels,
                                              const std::stop_token& stop) {
  if (std::string error = refusal(meshes, resolution_m, stop); !error.empty()) {
    return {nullptr, error};
  }
  const VoxelGrid grid(resolution_m);
  const MirrorVoxels made = mirror_voxels({meshes, solid, grid, max_voxels, stop});
  if (made.is_cancelled) return {nullptr, kCancelled};
  if (!made.voxels) {
    Box bounds;
    for (const Mesh* mesh : meshes) {
      for (const Vec3& vertex : mesh->vertices) bounds.extend(vertex);
    }
    return {nullptr, too_many(bounds, resolution_m, max_voxels), Limit::kMirrorVoxels};
  }
  return made_of(VoxelTree(*made.voxels, stop), grid, stop);
}

ObjectMirror::BuildResult ObjectMirror::of_map(const VoxelMap& map, const Box& bounds,
                                               std::uint64_t max_voxels,
                                               const ObjectMirror* mirror_before,
                                               const VoxelMap* map_before,
                                               const std::stop_token& stop) {
  const double resolution_m = map.resolution_m();
  if (std::string error = refusal(bounds, resolution_m); !error.empty()) return {nullptr, error};
  if (map.solid().size() > max_voxels) {
    return {nullptr, too_many(bounds, resolution_m, max_voxels), Limit::kMirrorVoxels};
  }
  VoxelTree tree = mirror_before != nullptr
                       ? mirror_before->tree_.updated(map_before->solid(), map.solid(), stop)
                       : VoxelTree(map.solid(), stop);
  return made_of(std::move(tree), VoxelGrid(resolution_m), stop);
}

ObjectMirror::BuildResult ObjectMirror::made_of(VoxelTree tree, const VoxelGrid& grid,
                                                const std::stop_token& stop) {
  if (stop.stop_requested()) return {nullptr, kCancelled};
  return {std::shared_ptr<const ObjectMirror>(new ObjectMirror(std::move(tree), grid)), {}};
}

ObjectMirror::ObjectMirror(VoxelTree tree, const VoxelGrid& grid)
    : tree_(std::move(tree)), grid_(grid) {
  statistics_.resolution_m = grid.resolution_m();
  statistics_.nodes = tree_.node_count();
  statistics_.memory_bytes = tree_.memory_bytes();
  statistics_.occupied_voxels = tree_.voxels();
  if (tree_.voxels() == 0) return;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const VoxelRange& along = tree_.bounds()[static_cast<std::size_t>(axis)];
    bounds_.min()[axis] = grid_.low_face_m(along.first);
    bounds_.max()[axis] = grid_.high_face_m(along.last + 1);
  }
}

/// With `enough` equal to `limit` it only finds out whether there is such a cube.
template <typename Cost>
std::optional<double> ObjectMirror::cheapest(const Cost& cost, double limit, double enough) const {
  if (bounds_.isEmpty()) return std::nullopt;
  const auto along = [&](Eigen::Index axis) {
    return cost.along(axis, bounds_.min()[axis], bounds_.max()[axis]);
  };
  if (!(cost.bound(along(0), along(1), along(2)) <= limit)) return std::nullopt;
  return CheapestCube<Cost>(tree_, grid_, cost, limit, enough).run();
}

bool ObjectMirror::occupied_at(const Vec3& point_W) const {
  if (!bounds_.contains(point_W)) return false;
  const std::optional<Voxel> voxel = grid_.voxel_of(point_W);
  if (!voxel) return false;
  return tree_.contains(*voxel);
}

bool ObjectMirror::occupied_in_box(const Box& box_W) const {
  if (!(box_W.min().array() <= box_W.max().array()).all()) return false;  // empty, or NaN
  return cheapest(BoxTouch(box_W), 0.0, 0.0).has_value();
}

bool ObjectMirror::occupied_in_sphere(const Vec3& center_W, double radius_m) const {
  if (!center_W.allFinite()) return false;
  return cheapest(PointDistance(center_W), radius_m, radius_m).has_value();
}

std::optional<double> ObjectMirror::ray_hit_m(const Vec3& origin_W, const Vec3& direction_W,
                                              double max_range_m) const {
  if (!origin_W.allFinite() || !direction_W.allFinite()) return std::nullopt;
  if ((direction_W.array() == 0.0).all()) return std::nullopt;
  return cheapest(RayEntry(origin_W, direction_W), max_range_m, 0.0);
}

std::optional<double> ObjectMirror::distance_m(const Vec3& point_W, double max_distance_m) const {
  if (!point_W.allFinite()) return std::nullopt;
  return cheapest(PointDistance(point_W), max_distance_m, 0.0);
}

std::optional<double> ObjectMirror::sphere_path_hit_m(const Vec3& from_W, const Vec3& to_W,
                                                      double radius_m) const {
  if (!from_W.allFinite() || !to_W.allFinite() || !(radius_m >= 0.0)) return std::nullopt;
  const BallWay way(from_W, to_W, radius_m);
  return cheapest(way, way.length_m(), 0.0);
}

}  // namespace camway::scene
