// SPDX-License-Identifier: MIT
#include "tests/bench/decompositions/decomposition.h"

#include <array>
#include <utility>

#include "daemon/scene/index/distance_search.h"
#include "daemon/scene/index/index_walk.h"
#include "daemon/scene/index/node_splitter.h"
#include "tests/bench/decompositions/kd_tree_split.h"

namespace camway::bench {

using geometry::Triangle;
using scene::IndexedMesh;
using scene::IndexOptions;
using scene::Mesh;
using scene::Nearest;

namespace {

/// A search for any triangle within a distance, in one tree, that counts what it looks at.
class CountingSearch : public scene::DistanceSearch {
 public:
  CountingSearch(std::span<const Triangle> body, const geometry::Box& box, double distance_m,
                 double error_m)
      : DistanceSearch(body, box, distance_m, error_m, scene::DistanceGoal::kAny,
                       /*certain_m=*/0.0, /*share=*/1.0) {}

  /// The walk asks this once for each node and each leaf that it comes to.
  [[nodiscard]] bool is_beyond(double squared_m2) const {
    const bool is_beyond = DistanceSearch::is_beyond(squared_m2);
    cost_.nodes += is_beyond ? 0 : 1;
    return is_beyond;
  }
  static bool enters(const scene::IndexNode&, std::size_t) { return true; }
  void leaf(const scene::IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t triangle) {
      ++cost_.triangles;
      consider(triangle);
      return !is_done();
    });
    settle();
  }

  [[nodiscard]] const QueryCost& cost() const { return cost_; }

 private:
  mutable QueryCost cost_;  ///< changes in `is_beyond`, which is const
};

/// A decomposition that serves as the scene's index.
class IndexDecomposition : public Decomposition {
 public:
  explicit IndexDecomposition(const std::shared_ptr<const IndexedMesh>& indexed)
      : part_{indexed}, index_(scene::SceneIndex::of(std::array{indexed})) {}

  [[nodiscard]] std::optional<Nearest> nearest(std::span<const Triangle> body,
                                               double cutoff_m) const override {
    return index_.nearest(body, cutoff_m);
  }
  [[nodiscard]] bool any_within(std::span<const Triangle> body, double distance_m) const override {
    return index_.any_within(body, distance_m).has_value();
  }
  [[nodiscard]] QueryCost cost_within(std::span<const Triangle> body,
                                      double distance_m) const override {
    geometry::Box box;
    for (const Triangle& triangle : body) box.extend(geometry::bounds(triangle));
    CountingSearch search(body, box, distance_m, index_.nearest_error_m(body));
    search.enter(part_);
    scene::IndexWalk(part_.indexed->tree).run(search);
    return search.cost();
  }
  [[nodiscard]] bool touches(std::span<const Triangle> body) const override {
    for (const Triangle& triangle : body) {
      if (index_.intersects(triangle)) return true;
    }
    return false;
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override {
    return index_.statistics().memory_bytes;
  }
  [[nodiscard]] const scene::SceneIndex* index() const override { return &index_; }

 private:
  scene::IndexedPart part_;
  scene::SceneIndex index_;
};

class BspDecomposition : public Decomposition {
 public:
  explicit BspDecomposition(std::shared_ptr<const Mesh> mesh) : tree_(std::move(mesh)) {}

  [[nodiscard]] std::optional<Nearest> nearest(std::span<const Triangle> body,
                                               double cutoff_m) const override {
    return tree_.nearest(body, cutoff_m);
  }
  [[nodiscard]] bool any_within(std::span<const Triangle> body, double distance_m) const override {
    return tree_.any_within(body, distance_m).has_value();
  }
  [[nodiscard]] QueryCost cost_within(std::span<const Triangle> body,
                                      double distance_m) const override {
    QueryCost cost;
    static_cast<void>(tree_.any_within(body, distance_m, &cost));
    return cost;
  }
  [[nodiscard]] bool touches(std::span<const Triangle> body) const override {
    return tree_.touches(body);
  }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return tree_.memory_bytes(); }

 private:
  BspTree tree_;
};

std::shared_ptr<const IndexedMesh> indexed_by(const scene::NodeSplitter& splitter,
                                              std::shared_ptr<const Mesh> mesh,
                                              const IndexOptions& options) {
  auto indexed = std::make_shared<IndexedMesh>();
  indexed->tree = scene::IndexTree::of_triangles(*mesh, splitter, options);
  indexed->mesh = std::move(mesh);
  return indexed;
}

template <std::shared_ptr<const IndexedMesh> (*build_tree)(std::shared_ptr<const Mesh>,
                                                           const IndexOptions&)>
std::unique_ptr<const Decomposition> build_index(std::shared_ptr<const Mesh> mesh,
                                                 unsigned threads) {
  return std::make_unique<IndexDecomposition>(build_tree(std::move(mesh), {.threads = threads}));
}

/// One thread builds it, however many there are.
std::unique_ptr<const Decomposition> build_bsp(std::shared_ptr<const Mesh> mesh, unsigned) {
  return std::make_unique<BspDecomposition>(std::move(mesh));
}

constexpr std::array<DecompositionKind, 4> kKinds{
    {{"octree", build_index<IndexedMesh::build>},
     {"k-d tree", build_index<build_kd_tree>},
     {"box hierarchy", build_index<build_box_hierarchy>},
     {"BSP tree", build_bsp}}};

}  // namespace

std::shared_ptr<const IndexedMesh> build_kd_tree(std::shared_ptr<const Mesh> mesh,
                                                 const IndexOptions& options) {
  const auto splitter = make_kd_tree_splitter(*mesh, mesh->bounds(), options);
  return indexed_by(*splitter, std::move(mesh), options);
}

std::shared_ptr<const IndexedMesh> build_box_hierarchy(std::shared_ptr<const Mesh> mesh,
                                                       const IndexOptions& options) {
  return indexed_by(*scene::make_box_group_splitter(options), std::move(mesh), options);
}

std::span<const DecompositionKind> decomposition_kinds() { return kKinds; }

}  // namespace camway::bench
