// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "tests/scene/index/index_queries.h"

/// For any input a tree stays small and shallow, and answers. `index_bounds.cpp` has the tests; a
/// program that compiles it instantiates them for its trees.
namespace camway::scene {

struct TreeKind {
  const char* name;
  BuildIndexedMesh build;
};

class IndexBounds : public ::testing::TestWithParam<TreeKind> {
 protected:
  /// Returns the index of one mesh.
  static SceneIndex build(Mesh mesh, const IndexOptions& options = {});
  static void expect_bounded(const SceneIndex& tree);
  static void expect_nearest(const SceneIndex& tree, const geometry::Vec3& at,
                             const geometry::Vec3& edge);
};

}  // namespace camway::scene
