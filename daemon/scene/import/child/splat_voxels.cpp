// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/splat_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/geometry/rounding.h"
#include "daemon/scene/import/readers/tokens.h"
#include "daemon/scene/voxels/voxel_grid.h"

namespace camway::scene {
namespace {

namespace layout = import_record;
using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "as the files are");

constexpr std::string_view kEnding = ".voxel.json";
constexpr std::string_view kTreeEnding = ".bin";  ///< in place of ".json"

// A node is a word. Of an inner node the upper byte says which children it has, and the rest is the
// number of the first; an upper byte of 0 is a leaf of single voxels, and the rest says which.
constexpr unsigned kChildrenBits = 24;
constexpr std::uint32_t kNumberMask = (std::uint32_t{1} << kChildrenBits) - 1;
constexpr std::uint32_t kSolid = std::uint32_t{0xFF} << kChildrenBits;
constexpr std::size_t kWordsOfALeaf = 2;
constexpr std::int32_t kLeafEdge = 4;
/// A tree of this depth has half of the keys of OctoMap, all from 0 on.
constexpr std::int32_t kMostDepth = 13;

struct Grid {
  std::array<double, 3> begin{};
  std::array<std::int32_t, 3> size{};  ///< voxels
  double voxel = 0.0;                  ///< edge, in file units
  std::int32_t depth = 0;              ///< of the leaves; the root has depth 0
  std::size_t nodes = 0;
  std::size_t leaf_words = 0;
};

std::optional<double> number(const json& value) {
  if (!value.is_number()) return std::nullopt;
  const auto result = value.get<double>();
  return std::isfinite(result) ? std::optional(result) : std::nullopt;
}

std::optional<std::array<double, 3>> point(const json& value) {
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  std::array<double, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<double> at = number(value[k]);
    if (!at) return std::nullopt;
    result[k] = *at;
  }
  return result;
}

/// The whole number of a member, from 0 to `most`.
std::optional<std::int64_t> count(const json& root, const char* name, std::int64_t most) {
  const auto found = root.find(name);
  if (found == root.end()) return std::nullopt;
  const std::optional<double> value = number(*found);
  if (!value || *value != std::floor(*value) || *value < 0.0 ||
      *value > static_cast<double>(most)) {
    return std::nullopt;
  }
  return static_cast<std::int64_t>(*value);
}

std::string read_bounds(const json& root, Grid& grid) {
  const json bounds = root.value("gridBounds", json());
  const auto low = point(bounds.is_object() ? bounds.value("min", json()) : json());
  const auto high = point(bounds.is_object() ? bounds.value("max", json()) : json());
  const auto voxel = number(root.value("voxelResolution", json()));
  if (!low || !high) return "gridBounds: must have min and max, of three numbers each";
  if (!voxel || !VoxelGrid::valid_resolution(*voxel)) {
    return fmt::format("voxelResolution: must be a number from {:g} to {:g}",
                       VoxelGrid::kMinResolutionM, VoxelGrid::kMaxResolutionM);
  }
  grid.begin = *low;
  grid.voxel = *voxel;
  for (std::size_t k = 0; k < 3; ++k) {
    const double voxels = std::round(((*high)[k] - (*low)[k]) / *voxel);
    // The ends are decimals, so the quotient is a whole number up to rounding.
    constexpr double kSlack = 1e-3;
    const double off = std::abs(((*high)[k] - (*low)[k]) / *voxel - voxels);
    if (!(voxels >= 1.0 && voxels <= VoxelGrid::kRoot.size && off < kSlack)) {
      return "gridBounds: are no whole number of voxels, from 1 to 65536";
    }
    grid.size[k] = static_cast<std::int32_t>(voxels);
  }
  return {};
}

std::string read_description(std::string_view text, Grid& grid) {
  const json root = json::parse(text, nullptr, false);
  if (!root.is_object()) return "is no JSON object";
  const json version = root.value("version", json());
  if (!version.is_string() || !version.get_ref<const std::string&>().starts_with("1.")) {
    return "version: must be \"1.1\" or another of 1";
  }
  if (count(root, "leafSize", kLeafEdge) != kLeafEdge) return "leafSize: must be 4";
  const auto depth = count(root, "treeDepth", kMostDepth);
  if (!depth) return fmt::format("treeDepth: must be a whole number, {} at most", kMostDepth);
  const auto nodes = count(root, "nodeCount", kNumberMask);
  const auto leaf_words = count(root, "leafDataCount", kWordsOfALeaf * kNumberMask);
  if (!nodes || !leaf_words) return "nodeCount and leafDataCount: must be whole numbers below 2^25";
  grid.depth = static_cast<std::int32_t>(*depth);
  grid.nodes = static_cast<std::size_t>(*nodes);
  grid.leaf_words = static_cast<std::size_t>(*leaf_words);
  return read_bounds(root, grid);
}

/// Walks through the tree and collects its cubes.
class TreeReader {
 public:
  TreeReader(const Grid& grid, std::string_view words, layout::Record& record)
      : grid_(grid), words_(words), record_(record), is_read_(grid.nodes, false) {}

  /// Returns the fault of the tree, or an empty text.
  std::string read() {
    if (grid_.nodes == 0) {
      add_free(root());
      return {};
    }
    std::vector<Node> waiting{{0, 0, root()}};
    while (!waiting.empty()) {
      const Node node = waiting.back();
      waiting.pop_back();
      if (is_read_[node.number]) return fmt::format("node {}: has two parents", node.number);
      is_read_[node.number] = true;
      if (std::string fault = visit(node, waiting); !fault.empty()) return fault;
    }
    return {};
  }

 private:
  struct Node {
    std::size_t number = 0;
    std::int32_t depth = 0;
    VoxelCube cube;
  };

  [[nodiscard]] VoxelCube root() const { return {{0, 0, 0}, kLeafEdge << grid_.depth}; }

  [[nodiscard]] std::uint32_t word(std::size_t i) const {
    std::uint32_t value = 0;
    std::memcpy(&value, words_.data() + i * sizeof value, sizeof value);
    return value;
  }

  std::string visit(const Node& node, std::vector<Node>& waiting) {
    const std::uint32_t value = word(node.number);
    if (value == kSolid) {
      record_.occupied.push_back(cube_of(node.cube));
      return {};
    }
    const std::uint32_t children = value >> kChildrenBits;
    const std::size_t first = value & kNumberMask;
    if (children == 0) return visit_leaf(node, first);
    if (node.depth == grid_.depth) {
      return fmt::format("node {}: has children below the leaves", node.number);
    }
    const auto many = static_cast<std::size_t>(std::popcount(children));
    // Children come after their parents, so that there is no circle.
    if (first <= node.number || first + many > grid_.nodes) {
      return fmt::format("node {}: has children {} to {} of {} nodes", node.number, first,
                         first + many - 1, grid_.nodes);
    }
    std::size_t next = first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      const VoxelCube cube = node.cube.child(octant);
      if ((children >> octant & 1U) != 0) {
        waiting.push_back({next++, node.depth + 1, cube});
      } else {
        add_free(cube);
      }
    }
    return {};
  }

  std::string visit_leaf(const Node& node, std::size_t pair) {
    if (node.depth != grid_.depth) {
      return fmt::format("node {}: is a leaf of single voxels, and no smallest cube", node.number);
    }
    if (kWordsOfALeaf * (pair + 1) > grid_.leaf_words) {
      return fmt::format("node {}: is leaf {} of {}", node.number, pair,
                         grid_.leaf_words / kWordsOfALeaf);
    }
    const std::size_t at = grid_.nodes + kWordsOfALeaf * pair;
    const std::uint64_t bits = word(at) | std::uint64_t{word(at + 1)} << 32U;
    for (std::int32_t bit = 0; bit < 64; ++bit) {
      const VoxelCube voxel{
          {node.cube.min[0] + bit % 4, node.cube.min[1] + bit / 4 % 4, node.cube.min[2] + bit / 16},
          1};
      if ((bits >> bit & 1U) != 0) {
        record_.occupied.push_back(cube_of(voxel));
      } else {
        add_free(voxel);
      }
    }
    return {};
  }

  /// Adds the part of a cube that is in the grid.
  void add_free(const VoxelCube& cube) {
    bool is_inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      if (cube.min[k] >= grid_.size[k]) return;
      is_inside = is_inside && cube.min[k] + cube.size <= grid_.size[k];
    }
    if (is_inside) {
      record_.free.push_back(cube_of(cube));
      return;
    }
    for (unsigned octant = 0; octant < 8; ++octant) add_free(cube.child(octant));
  }

  static layout::Cube cube_of(const VoxelCube& cube) { return {cube.min, cube.size}; }

  const Grid& grid_;
  std::string_view words_;
  layout::Record& record_;
  std::vector<bool> is_read_;
};

}  // namespace

bool is_splat_voxel_name(std::string_view name) {
  return name.size() > kEnding.size() &&
         mesh_readers::equals_ignoring_case(name.substr(name.size() - kEnding.size()), kEnding);
}

base::Result<layout::Record> read_splat_voxels(const std::string& name, std::string_view json_text,
                                               const OpenInclude& open) {
  Grid grid;
  if (std::string fault = read_description(json_text, grid); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  constexpr std::size_t kJsonEnding = 5;  // ".json"
  const std::string tree_name =
      name.substr(0, name.size() - kJsonEnding) + std::string(kTreeEnding);
  const base::Result<IncludedFile> tree = open("", tree_name);
  if (!tree) {
    return base::Failure{fmt::format("its tree '{}', beside it, {}", tree_name, tree.error)};
  }
  const std::size_t wanted = sizeof(std::uint32_t) * (grid.nodes + grid.leaf_words);
  if (tree->text.size() != wanted) {
    return base::Failure{fmt::format("'{}' has {} bytes; {} nodes and {} words of leaves are {}",
                                     tree_name, tree->text.size(), grid.nodes, grid.leaf_words,
                                     wanted)};
  }
  layout::Record record;
  if (std::string fault = TreeReader(grid, tree->text, record).read(); !fault.empty()) {
    return base::Failure{fmt::format("'{}': {}", tree_name, fault)};
  }
  record.text = "voxels of Gaussian splats";
  record.notes = fmt::format(
      "Y is up, in metres; what is outside of the grid ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) "
      "counts as solid for SuperSplat and is free here: bounds, or unknown occupied, keep a body "
      "inside\n",
      grid.begin[0], grid.begin[1], grid.begin[2], grid.begin[0] + grid.size[0] * grid.voxel,
      grid.begin[1] + grid.size[1] * grid.voxel, grid.begin[2] + grid.size[2] * grid.voxel);
  record.header.map_resolution = grid.voxel;
  record.header.map_origin = grid.begin;
  record.header.is_free_optional = 1;
  // A face is at its number times the edge, plus the begin: two roundings.
  record.header.relative_rounding = 2.0 * geometry::kUnitRoundoff;
  return record;
}

}  // namespace camway::scene
