// SPDX-License-Identifier: MIT
#include "tests/scene/index/index_bounds.h"

#include "tests/support/case_name.h"

namespace camway::scene {
namespace {

INSTANTIATE_TEST_SUITE_P(Trees, IndexBounds,
                         ::testing::Values(TreeKind{"Octree", IndexedMesh::build}),
                         testing::name_of_case);

}  // namespace
}  // namespace camway::scene
