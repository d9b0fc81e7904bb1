// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/map_reader.h"

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <octomap/OcTreeStamped.h>

#include <memory>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::scene {
namespace {

namespace layout = import_record;

template <class Tree>
void take_leaves(const Tree& tree, layout::Record& record) {
  record.header.map_resolution = tree.getResolution();
  if (tree.getRoot() == nullptr) return;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    layout::Cube cube;
    for (unsigned k = 0; k < 3; ++k) cube.min[k] = std::int32_t{key[k]} + VoxelGrid::kMinVoxel;
    cube.size = std::int32_t{1} << (tree.getTreeDepth() - leaf.getDepth());
    (tree.isNodeOccupied(*leaf) ? record.occupied : record.free).push_back(cube);
  }
}

/// Takes the leaves if the tree is of that type.
template <class Tree>
bool took_leaves(const octomap::AbstractOcTree& tree, layout::Record& record) {
  const auto* const typed = dynamic_cast<const Tree*>(&tree);
  if (typed != nullptr) take_leaves(*typed, record);
  return typed != nullptr;
}

std::string read_binary(const std::string& file, layout::Record& record) {
  constexpr double kUntilRead = 1.0;
  octomap::OcTree tree(kUntilRead);
  if (!tree.readBinary(file)) return "is no binary OctoMap file";
  take_leaves(tree, record);
  return {};
}

std::string read_full(const std::string& file, layout::Record& record) {
  // OctoMap knows these types once an object of them was made.
  const octomap::ColorOcTree with_colours(1.0);
  const octomap::OcTreeStamped with_times(1.0);
  const std::unique_ptr<const octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(file));
  if (!tree) return "is no OctoMap file, or of a type that OctoMap does not know";
  if (took_leaves<octomap::OcTree>(*tree, record) ||
      took_leaves<octomap::ColorOcTree>(*tree, record) ||
      took_leaves<octomap::OcTreeStamped>(*tree, record)) {
    return {};
  }
  return "holds a tree of type '" + tree->getTreeType() + "', which has no occupancy";
}

}  // namespace

bool is_map_extension(std::string_view extension) {
  return mesh_readers::equals_ignoring_case(extension, ".bt") ||
         mesh_readers::equals_ignoring_case(extension, ".ot");
}

std::string read_map(const std::string& file, std::string_view extension, layout::Record& record) {
  record.text = "OctoMap";
  record.header.relative_rounding = geometry::kUnitRoundoff;  // of a face: number times edge
  return mesh_readers::equals_ignoring_case(extension, ".bt") ? read_binary(file, record)
                                                              : read_full(file, record);
}

}  // namespace camway::scene
