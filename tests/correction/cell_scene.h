// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <utility>

#include "daemon/correction/search/cell_tree.h"
#include "tests/correction/search_scene.h"

/// A scene whose cells are all known, for tests of what a cell search makes of them.
namespace camway::correction::testing_search {

/// The cube of side 2 m about the origin, in which each mixed cell is divided as far as the options
/// allow.
struct CellScene {
  CellScene(scene::Mesh mesh, const CellOptions& cell_options)
      : scene(std::move(mesh)),
        space(scene.space()),
        options(cell_options),
        tree(space, options, {Vec3::Constant(-1.0), Vec3::Constant(1.0)}) {
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
      if (tree[i].state == CellState::kMixed && tree.may_divide(tree[i])) tree.divide(i);
    }
  }
  CellScene(const CellScene&) = delete;  // the tree refers to the members
  CellScene& operator=(const CellScene&) = delete;

  /// Calls `visit(index, center_W)` for each cell that is free and not divided.
  template <class Visit>
  void for_each_free(const Visit& visit) const {
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
      if (!tree[i].is_divided() && tree[i].state == CellState::kFree)
        visit(i, tree.center_W(tree[i]));
    }
  }

  /// Marks the free cells for whose middle `is_reached` returns true as reached from an end.
  void reach(std::size_t end, const std::function<bool(const Vec3& center_W)>& is_reached) {
    for_each_free([&](std::uint32_t i, const Vec3& center_W) {
      if (is_reached(center_W)) tree[i].reached.add(end);
    });
  }

  SearchScene scene;
  FreeSpace space;
  CellOptions options;
  CellTree tree;
};

}  // namespace camway::correction::testing_search
