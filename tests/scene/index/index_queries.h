// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "tests/scene/index/index_oracle.h"

/// Properties of the queries that hold whatever tree serves them. `index_queries.cpp` has the
/// tests; a program that compiles it instantiates them for its trees.
namespace camway::scene {

/// Builds the tree of a mesh.
using BuildIndexedMesh = std::shared_ptr<const IndexedMesh> (*)(std::shared_ptr<const Mesh> mesh,
                                                                const IndexOptions& options);

struct QueryCase {
  const char* name;
  std::uint64_t seed;
  bool on_grid;
  std::uint32_t threshold;
  BuildIndexedMesh build = IndexedMesh::build;
  std::size_t meshes = 1;
};

class IndexQueries : public ::testing::TestWithParam<QueryCase> {
 protected:
  IndexQueries();

  geometry::Vec3 point();
  geometry::Triangle triangle();

  geometry::RandomTriangles random_;
  SceneIndex tree_;
};

}  // namespace camway::scene
