// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "daemon/scene/index/node_splitter.h"

namespace camway::bench {

/// Returns a node splitter that makes a k-d tree: a plane across an axis at the least surface area
/// cost divides space, and a triangle goes to each side that it lies on. Requires that `mesh`
/// outlives the splitter and that `bounds` holds all of its triangles.
std::unique_ptr<scene::NodeSplitter> make_kd_tree_splitter(const scene::Mesh& mesh,
                                                           const geometry::Box& bounds,
                                                           const scene::IndexOptions& options);

}  // namespace camway::bench
