// SPDX-License-Identifier: MIT
#include "tests/scene/index/index_bounds.h"

namespace camway::scene {
namespace {

INSTANTIATE_TEST_SUITE_P(Trees, IndexBounds,
                         ::testing::Values(TreeKind{"Octree", IndexedMesh::build}), name_of);

}  // namespace
}  // namespace camway::scene
