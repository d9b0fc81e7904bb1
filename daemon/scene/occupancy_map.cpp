// SPDX-License-Identifier: MIT
#include "daemon/scene/occupancy_map.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <ostream>
#include <sstream>
#include <utility>

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Vec3;
using octomap::OcTree;
using octomap::OcTreeKey;
using octomap::OcTreeNode;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

OcTreeKey key_of(const Voxel& voxel) {
  const auto key = [](std::int32_t v) {
    return static_cast<octomap::key_type>(v - VoxelGrid::kMinVoxel);
  };
  return {key(voxel[0]), key(voxel[1]), key(voxel[2])};
}

/// The cube of a leaf with this key that is so many levels above a voxel.
VoxelCube cube_of(const OcTreeKey& key, unsigned levels_above_voxel) {
  VoxelCube cube;
  for (unsigned k = 0; k < 3; ++k) cube.min[k] = std::int32_t{key[k]} + VoxelGrid::kMinVoxel;
  cube.size = std::int32_t{1} << levels_above_voxel;
  return cube;
}

/// The least value that `cost` takes on the boxes of occupied leaves, or nothing if none is
/// finite and <= `limit`. Branch and bound, cheapest octant first; see `box_costs.h` for what a
/// cost has to keep.
template <typename Cost>
class CheapestLeaf {
 public:
  CheapestLeaf(const OcTree& tree, const VoxelGrid& grid, const Cost& cost, double limit)
      : tree_(tree), grid_(grid), cost_(cost), limit_(limit) {}

  std::optional<double> run() {
    if (const OcTreeNode* root = tree_.getRoot(); root != nullptr) {
      visit(*root, VoxelGrid::kRoot, cost_(grid_.box(VoxelGrid::kRoot)));
    }
    return best_;
  }

 private:
  struct Child {
    const OcTreeNode* node;
    VoxelCube cube;
    double cost;
  };

  void visit(const OcTreeNode& node, const VoxelCube& cube, double cost) {
    if (!(cost <= limit_ && cost < kInfinity) || (best_ && cost >= *best_)) return;
    if (!tree_.isNodeOccupied(node)) return;  // an inner node holds the maximum of its children
    if (!tree_.nodeHasChildren(&node)) {
      best_ = cost;
      return;
    }
    std::array<Child, 8> children;
    std::size_t count = 0;
    for (unsigned index = 0; index < 8; ++index) {
      if (!tree_.nodeChildExists(&node, index)) continue;
      const VoxelCube child = cube.child(index);
      children[count++] = {tree_.getNodeChild(&node, index), child, cost_(grid_.box(child))};
    }
    const auto end = children.begin() + static_cast<std::ptrdiff_t>(count);
    std::stable_sort(children.begin(), end,
                     [](const Child& a, const Child& b) { return a.cost < b.cost; });
    for (std::size_t i = 0; i < count; ++i)
      visit(*children[i].node, children[i].cube, children[i].cost);
  }

  const OcTree& tree_;
  const VoxelGrid& grid_;
  const Cost& cost_;
  double limit_;
  std::optional<double> best_;
};

/// `bounds` is the box of all occupied leaves.
template <typename Cost>
std::optional<double> cheapest_leaf(const OcTree& tree, const VoxelGrid& grid, const Box& bounds,
                                    const Cost& cost, double limit) {
  if (bounds.isEmpty() || !(cost(bounds) <= limit)) return std::nullopt;
  return CheapestLeaf<Cost>(tree, grid, cost, limit).run();
}

std::string describe(const Box& box) {
  std::ostringstream text;
  text << '[' << box.min().x() << ", " << box.min().y() << ", " << box.min().z() << "] to ["
       << box.max().x() << ", " << box.max().y() << ", " << box.max().z() << "] m";
  return text.str();
}

/// Why a mesh cannot be mirrored, or nothing.
std::string refusal(const Mesh& mesh, double resolution_m) {
  std::ostringstream text;
  if (!VoxelGrid::valid_resolution(resolution_m)) {
    text << "occupancy resolution " << resolution_m << " m is not between "
         << VoxelGrid::kMinResolutionM << " and " << VoxelGrid::kMaxResolutionM << " m";
    return text.str();
  }
  const VoxelGrid grid(resolution_m);
  Box bounds;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const Vec3& vertex : mesh.triangle(i)) {
      if (!vertex.allFinite()) return "triangle " + std::to_string(i) + " is not finite";
      bounds.extend(vertex);
    }
  }
  if (bounds.isEmpty()) return {};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (voxels_touching(grid, bounds.min()[axis], bounds.max()[axis])) continue;
    text << "scene extent " << describe(bounds) << " exceeds what an occupancy map of resolution "
         << resolution_m << " m can hold: " << OccupancyMap::kMaxKeyVoxels
         << " voxels from the origin, " << OccupancyMap::kMaxKeyVoxels * resolution_m << " m";
    return text.str();
  }
  return {};
}

/// The voxels of all triangles; nothing if there are more than `max_voxels`.
std::optional<VoxelSet> touched_voxels(const Mesh& mesh, const VoxelGrid& grid,
                                       std::uint64_t max_voxels) {
  VoxelSet voxels;
  VoxelMarker marker(voxels);
  const auto is_new = [&](const Voxel& voxel) { return !marker.contains(voxel); };
  const auto mark = [&](const Voxel& voxel) {
    marker.insert(voxel);
    return voxels.size() <= max_voxels;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!for_each_voxel_touched(grid, mesh.triangle(i), is_new, mark)) return std::nullopt;
  }
  return voxels;
}

/// Adds the voxels with their middle in the solid: what no face touches is inside with all of it.
/// False if there are more than `max_voxels`, or too many to look at.
bool fill(const PlacedVoxelMap& solid, const VoxelGrid& grid, std::uint64_t max_voxels,
          VoxelSet& voxels) {
  constexpr double kMostLooks = 1e9;
  if (voxels.empty()) return true;
  const VoxelSet::Range range = voxels.bounds();
  double looks = 1.0;
  for (const VoxelRange& along : range) looks *= double{1} + along.last - along.first;
  if (looks > kMostLooks) return false;
  Voxel voxel{};
  for (voxel[2] = range[2].first; voxel[2] <= range[2].last; ++voxel[2]) {
    for (voxel[1] = range[1].first; voxel[1] <= range[1].last; ++voxel[1]) {
      for (voxel[0] = range[0].first; voxel[0] <= range[0].last; ++voxel[0]) {
        if (!voxels.contains(voxel) && solid.holds(grid.box({voxel, 1}).center())) {
          voxels.insert(voxel);
        }
      }
      if (voxels.size() > max_voxels) return false;
    }
  }
  return true;
}

/// What is occupied, or nothing if it is too much.
std::optional<VoxelSet> occupied_voxels(const Mesh& mesh, const VoxelGrid& grid,
                                        const std::optional<PlacedVoxelMap>& solid,
                                        std::uint64_t max_voxels) {
  if (solid && solid->placement.is_identity() &&
      solid->map->resolution_m() == grid.resolution_m()) {
    const VoxelSet& voxels = solid->map->solid();
    return voxels.size() <= max_voxels ? std::optional(voxels) : std::nullopt;
  }
  std::optional<VoxelSet> voxels = touched_voxels(mesh, grid, max_voxels);
  if (voxels && solid && !fill(*solid, grid, max_voxels, *voxels)) return std::nullopt;
  return voxels;
}

}  // namespace

OccupancyMap::BuildResult OccupancyMap::build(const Mesh& mesh, double resolution_m,
                                              const std::optional<PlacedVoxelMap>& solid,
                                              std::uint64_t max_voxels) {
  if (std::string error = refusal(mesh, resolution_m); !error.empty()) return {nullptr, error};
  const VoxelGrid grid(resolution_m);
  const std::optional<VoxelSet> voxels = occupied_voxels(mesh, grid, solid, max_voxels);
  if (!voxels) {
    Box bounds;
    for (const Vec3& vertex : mesh.vertices) bounds.extend(vertex);
    std::ostringstream text;
    text << "an occupancy map of resolution " << resolution_m << " m would need more than "
         << max_voxels << " voxels for the scene extent " << describe(bounds);
    return {nullptr, text.str()};
  }
  auto tree = std::make_unique<OcTree>(resolution_m);
  const float occupied = tree->getClampingThresMaxLog();
  voxels->for_each(
      [&](const Voxel& voxel) { tree->setNodeValue(key_of(voxel), occupied, /*lazy_eval=*/true); });
  tree->updateInnerOccupancy();
  tree->prune();
  return {std::shared_ptr<const OccupancyMap>(new OccupancyMap(std::move(tree), grid)), {}};
}

OccupancyMap::OccupancyMap(std::unique_ptr<const OcTree> tree, const VoxelGrid& grid)
    : tree_(std::move(tree)), grid_(grid) {
  statistics_.resolution_m = grid.resolution_m();
  statistics_.nodes = tree_->size();
  statistics_.memory_bytes = tree_->memoryUsage();
  if (tree_->getRoot() == nullptr) return;
  for (auto leaf = tree_->begin_leafs(); leaf != tree_->end_leafs(); ++leaf) {
    const unsigned levels_above_voxel = tree_->getTreeDepth() - leaf.getDepth();
    if (tree_->isNodeOccupied(*leaf)) {
      statistics_.occupied_voxels += std::uint64_t{1} << (3 * levels_above_voxel);
      bounds_.extend(grid_.box(cube_of(leaf.getIndexKey(), levels_above_voxel)));
    }
  }
}

OccupancyMap::~OccupancyMap() = default;

bool OccupancyMap::occupied_at(const Vec3& point_W) const {
  if (!bounds_.contains(point_W)) return false;
  const std::optional<Voxel> voxel = grid_.voxel_of(point_W);
  if (!voxel) return false;
  const OcTreeNode* node = tree_->search(key_of(*voxel));
  return node != nullptr && tree_->isNodeOccupied(node);
}

bool OccupancyMap::occupied_in_box(const Box& box_W) const {
  if (!(box_W.min().array() <= box_W.max().array()).all()) return false;  // empty, or NaN
  return cheapest_leaf(*tree_, grid_, bounds_, BoxTouch(box_W), 0.0).has_value();
}

bool OccupancyMap::occupied_in_sphere(const Vec3& center_W, double radius_m) const {
  return distance_m(center_W, radius_m).has_value();
}

std::optional<double> OccupancyMap::ray_hit_m(const Vec3& origin_W, const Vec3& direction_W,
                                              double max_range_m) const {
  if (!origin_W.allFinite() || !direction_W.allFinite()) return std::nullopt;
  if ((direction_W.array() == 0.0).all()) return std::nullopt;
  return cheapest_leaf(*tree_, grid_, bounds_, RayEntry(origin_W, direction_W), max_range_m);
}

std::optional<double> OccupancyMap::distance_m(const Vec3& point_W, double max_distance_m) const {
  if (!point_W.allFinite()) return std::nullopt;
  return cheapest_leaf(*tree_, grid_, bounds_, PointDistance(point_W), max_distance_m);
}

std::optional<double> OccupancyMap::sphere_path_hit_m(const Vec3& from_W, const Vec3& to_W,
                                                      double radius_m) const {
  if (!from_W.allFinite() || !to_W.allFinite() || !(radius_m >= 0.0)) return std::nullopt;
  const BallWay way(from_W, to_W, radius_m);
  return cheapest_leaf(*tree_, grid_, bounds_, way, way.length_m());
}

void write_bt_of(const OcTree& tree, std::ostream& out) {
  // Not OcTree::writeBinaryConst: it prints the resolution with six digits, which scales the map of
  // any other resolution, and chats on stderr. The call below is not virtual for the latter reason:
  // the installed library was built with its debug output on.
  const std::streamsize precision = out.precision(std::numeric_limits<double>::max_digits10);
  out << "# Octomap OcTree binary file\n# conservative mirror of a Camway scene\n#\n"
      << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
      << "\ndata\n";
  out.precision(precision);
  tree.octomap::OccupancyOcTreeBase<OcTreeNode>::writeBinaryData(out);
}

}  // namespace camway::scene
