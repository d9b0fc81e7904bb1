// SPDX-License-Identifier: MIT
#include "daemon/scene/index/scene_index.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/segment_triangle.h"
#include "daemon/geometry/triangle_box.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/scene/index/distance_search.h"
#include "daemon/scene/index/index_walk.h"
#include "daemon/scene/index/swept_search.h"
#include "daemon/scene/index/tree_search.h"
#include "daemon/scene/index/tree_walk.h"

namespace camway::scene {

using geometry::Box;
using geometry::LineSegment;
using geometry::Triangle;
using geometry::Vec3;

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Whether the kernels of daemon/geometry accept the point; false for NaN.
bool is_usable(const Vec3& point) {
  return (point.array().abs() < geometry::kLargestCoordinate_m).all();
}

bool is_usable(const Triangle& triangle) {
  return is_usable(triangle[0]) && is_usable(triangle[1]) && is_usable(triangle[2]);
}

bool is_usable(std::span<const Triangle> body) {
  return std::all_of(body.begin(), body.end(), [](const Triangle& t) { return is_usable(t); });
}

Box bounds_of(std::span<const Triangle> body) {
  Box box;
  for (const Triangle& triangle : body) box.extend(geometry::bounds(triangle));
  return box;
}

/// A query for `IndexWalk` that searches the triangles near a body.
template <class Search>
class WalkedBy : public Search {
 public:
  using Search::Search;

  static bool enters(const IndexNode&, std::size_t) { return true; }

  void leaf(const IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t triangle) {
      this->consider(triangle);
      return !this->is_done();
    });
    this->settle();
  }
};

/// A query for `IndexWalk` that visits the leaves that a triangle touches.
template <class Visit>
class TouchQuery {
 public:
  TouchQuery(const Triangle& triangle, const Visit& visit)
      : triangle_(triangle), sides_(geometry::bounds(triangle)), visit_(visit) {}

  [[nodiscard]] const BoxSides& sides() const { return sides_; }
  static const ObliqueSides* oblique() { return nullptr; }
  static double squared_reach_m2() { return 0.0; }
  static bool is_beyond(double) { return false; }
  [[nodiscard]] bool is_done() const { return is_done_; }

  /// A closer test, because the box of a long triangle meets far more than the triangle.
  [[nodiscard]] bool enters(const IndexNode& node, std::size_t slot) const {
    return geometry::triangle_touches_box(triangle_, node.frame.box_of(get_box(node.boxes, slot)));
  }

  void enter(const IndexedPart& part) { part_ = &part; }
  [[nodiscard]] Triangle triangle(std::uint32_t index) const { return part_->triangle(index); }

  void leaf(const IndexWalk::Leaf& leaf) { is_done_ = !visit_(*this, leaf); }

 private:
  const Triangle& triangle_;
  BoxSides sides_;
  const Visit& visit_;
  const IndexedPart* part_ = nullptr;
  bool is_done_ = false;
};

/// A query for `IndexWalk` that visits all triangles whose boxes meet a box.
class BoxQuery {
 public:
  BoxQuery(const Box& box, bool (*visit)(void*, std::uint32_t), void* context)
      : box_(box), sides_(box), visit_(visit), context_(context) {}

  [[nodiscard]] const BoxSides& sides() const { return sides_; }
  static const ObliqueSides* oblique() { return nullptr; }
  static double squared_reach_m2() { return 0.0; }
  static bool is_beyond(double) { return false; }
  static bool enters(const IndexNode&, std::size_t) { return true; }
  [[nodiscard]] bool is_done() const { return is_done_; }

  void enter(const IndexedPart& part) { part_ = &part; }

  void leaf(const IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t triangle) {
      is_done_ = !is_apart(triangle) && !visit_(context_, triangle);
      return !is_done_;
    });
  }

 private:
  /// False for NaN.
  [[nodiscard]] bool is_apart(std::uint32_t triangle) const {
    const Box other = geometry::bounds(part_->triangle(triangle));
    return (other.min().array() > box_.max().array()).any() ||
           (other.max().array() < box_.min().array()).any();
  }

  const Box& box_;
  BoxSides sides_;
  const IndexedPart* part_ = nullptr;
  bool (*visit_)(void*, std::uint32_t);
  void* context_;
  bool is_done_ = false;
};

/// A query for `IndexWalk` that searches what is inside a closed body.
class InsideQuery {
 public:
  using IsInside = std::function<bool(const Vec3&)>;

  InsideQuery(const TreeBody& body, const Box& scene, const IsInside& is_inside)
      : body_(body),
        root_(body.placed(TreeBody::kRoot)),
        rounding_m_(body.rounding_m(scene)),
        is_inside_(is_inside) {}

  [[nodiscard]] const BoxSides& sides() const { return root_.sides; }
  [[nodiscard]] const ObliqueSides* oblique() const { return &root_.oblique; }
  [[nodiscard]] double squared_reach_m2() const { return rounding_m_ * rounding_m_; }
  [[nodiscard]] bool is_beyond(double) const { return found_; }
  [[nodiscard]] bool is_done() const { return found_; }
  [[nodiscard]] bool found() const { return found_; }

  [[nodiscard]] bool enters(const IndexNode& node, std::size_t slot) const {
    const Box box = node.frame.box_of(get_box(node.boxes, slot));
    if (body_.may_touch(box, rounding_m_)) return true;
    found_ = found_ || is_inside_(box.center());
    return false;
  }

  void enter(const IndexedPart& part) { part_ = &part; }

  void leaf(const IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t triangle) {
      found_ = is_inside_(part_->triangle(triangle)[0]);
      return !found_;
    });
  }

 private:
  const TreeBody& body_;
  TreeBody::Placed root_;
  double rounding_m_;
  const IsInside& is_inside_;
  const IndexedPart* part_ = nullptr;
  mutable bool found_ = false;  // `enters` decides for whole nodes
};

/// A query for `IndexWalk` over the boxes of parts: runs `query` through the tree of each part in
/// reach.
template <class Query>
class PartsQuery {
 public:
  PartsQuery(Query& query, std::span<const IndexedPart> parts) : query_(query), parts_(parts) {}

  [[nodiscard]] const BoxSides& sides() const { return query_.sides(); }
  [[nodiscard]] const ObliqueSides* oblique() const { return query_.oblique(); }
  [[nodiscard]] double squared_reach_m2() const { return query_.squared_reach_m2(); }
  [[nodiscard]] bool is_beyond(double squared) const { return query_.is_beyond(squared); }
  [[nodiscard]] bool enters(const IndexNode& node, std::size_t slot) const {
    return query_.enters(node, slot);
  }
  [[nodiscard]] bool is_done() const { return query_.is_done(); }

  void leaf(const IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t number) {
      enter(parts_[number]);
      return !is_done();
    });
  }

  void enter(const IndexedPart& part) {
    query_.enter(part);
    IndexWalk(part.indexed->tree, {part.first_triangle, part.first_leaf}).run(query_);
  }

 private:
  Query& query_;
  std::span<const IndexedPart> parts_;
};

/// A query for `IndexWalk` over the boxes of parts: searches the trees of those within reach of the
/// root of a body's tree.
class RootQuery {
 public:
  RootQuery(TreeSearch& search, std::span<const IndexedPart> parts)
      : search_(search), root_(search.body().placed(TreeBody::kRoot)), parts_(parts) {}

  [[nodiscard]] const BoxSides& sides() const { return root_.sides; }
  [[nodiscard]] const ObliqueSides* oblique() const { return &root_.oblique; }
  [[nodiscard]] double squared_reach_m2() const {
    return search_.squared_reach_m2(search_.body().node(root_.node));
  }
  [[nodiscard]] bool is_beyond(double squared) const {
    return search_.is_beyond(search_.body().node(root_.node), squared);
  }
  static bool enters(const IndexNode&, std::size_t) { return true; }
  [[nodiscard]] bool is_done() const { return search_.is_done(); }

  void leaf(const IndexWalk::Leaf& leaf) {
    leaf.for_each(*this, [this](std::uint32_t number) {
      enter(parts_[number]);
      return !is_done();
    });
  }

  void enter(const IndexedPart& part) {
    search_.enter(part);
    TreeWalk(part.indexed->tree, {part.first_triangle, part.first_leaf}, search_).run();
  }

 private:
  TreeSearch& search_;
  TreeBody::Placed root_;  // a copy: placing children moves the original
  std::span<const IndexedPart> parts_;
};

}  // namespace

void SceneIndex::add(const std::shared_ptr<const IndexedMesh>& mesh) {
  assert(mesh);
  const IndexTree& tree = mesh->tree;
  if (tree.leaves() == 0) return;
  IndexStatistics& s = statistics_;
  parts_.push_back(
      {mesh, static_cast<std::uint32_t>(s.triangles), static_cast<std::uint32_t>(s.leaves)});
  bounds_.extend(tree.bounds());
  s.nodes += tree.nodes() + tree.leaves();
  s.leaves += tree.leaves();
  s.depth = std::max(s.depth, tree.depth());
  s.triangles += mesh->mesh->triangles.size();
  s.references += tree.references();
  s.memory_bytes += tree.memory_bytes();
}

SceneIndex SceneIndex::of(std::span<const std::shared_ptr<const IndexedMesh>> meshes) {
  SceneIndex index;
  for (const std::shared_ptr<const IndexedMesh>& mesh : meshes) index.add(mesh);
  IndexStatistics& s = index.statistics_;
  if (index.parts_.size() > 1) {
    std::vector<Box> boxes;
    boxes.reserve(index.parts_.size());
    for (const IndexedPart& part : index.parts_) boxes.push_back(part.indexed->tree.bounds());
    index.top_ = IndexTree::of_boxes(boxes);
    s.nodes += index.top_.nodes();
    s.depth += index.top_.depth();
    s.memory_bytes += index.top_.memory_bytes();
  }
  if (s.triangles > 0) {
    s.duplication = static_cast<double>(s.references) / static_cast<double>(s.triangles);
  }
  return index;
}

SceneIndex SceneIndex::build(std::shared_ptr<const Mesh> mesh, const IndexOptions& options) {
  return of(std::array{IndexedMesh::build(std::move(mesh), options)});
}

SceneIndex SceneIndex::build(const Mesh& mesh, const IndexOptions& options) {
  SceneIndex index = build(std::make_shared<const Mesh>(mesh), options);
  index.statistics_.memory_bytes += mesh.vertices.size() * sizeof(geometry::Vec3) +
                                    mesh.triangles.size() * sizeof(mesh.triangles[0]);
  return index;
}

bool SceneIndex::has_same_trees_as(const SceneIndex& other) const {
  return top_.is_same_as(other.top_) &&
         std::ranges::equal(parts_, other.parts_, [](const IndexedPart& a, const IndexedPart& b) {
           return a.indexed->tree.is_same_as(b.indexed->tree);
         });
}

template <class Query>
void SceneIndex::run(Query& query) const {
  PartsQuery<Query> parts(query, parts_);
  if (parts_.size() == 1) {
    parts.enter(parts_.front());
  } else {
    IndexWalk(top_).run(parts);
  }
}

void SceneIndex::search(TreeSearch& search) const {
  if (parts_.empty()) return;
  RootQuery query(search, parts_);
  if (parts_.size() == 1) {
    query.enter(parts_.front());
  } else {
    IndexWalk(top_).run(query);
  }
}

bool SceneIndex::has_inside(const TreeBody& body,
                            const std::function<bool(const Vec3&)>& is_inside) const {
  if (parts_.empty()) return false;
  InsideQuery query(body, bounds_, is_inside);
  run(query);
  return query.found();
}

/// Calls `visit(query, leaf)` for every leaf that `triangle` touches until it returns false.
template <class Visit>
void SceneIndex::visit_leaves(const Triangle& triangle, const Visit& visit) const {
  TouchQuery<Visit> query(triangle, visit);
  run(query);
}

std::optional<Nearest> SceneIndex::search(std::span<const Triangle> body, double cutoff_m,
                                          DistanceGoal goal, double certain_m, double share) const {
  if (size() == 0 || body.empty()) return std::nullopt;
  if (!is_usable(body) || std::isnan(cutoff_m)) return Nearest{0.0, 0};
  const Box box = bounds_of(body);
  WalkedBy<DistanceSearch> query(body, box, cutoff_m, error_m(box), goal, certain_m, share);
  run(query);
  return query.result();
}

std::optional<std::uint32_t> SceneIndex::first_intersection(const Triangle& triangle) const {
  if (size() == 0) return std::nullopt;
  if (!is_usable(triangle)) return 0;
  std::uint32_t lowest = kNone;
  visit_leaves(triangle, [&](const auto& query, const IndexWalk::Leaf& leaf) {
    leaf.for_each(query, [&](std::uint32_t index) {
      if (index < lowest && geometry::triangles_touch(triangle, query.triangle(index))) {
        lowest = index;
      }
      return index < lowest;
    });
    return lowest != 0;
  });
  if (lowest == kNone) return std::nullopt;
  return lowest;
}

bool SceneIndex::intersects(const Triangle& triangle) const {
  if (size() == 0) return false;
  if (!is_usable(triangle)) return true;
  bool found = false;
  visit_leaves(triangle, [&](const auto& query, const IndexWalk::Leaf& leaf) {
    leaf.for_each(query, [&](std::uint32_t index) {
      found = geometry::triangles_touch(triangle, query.triangle(index));
      return !found;
    });
    return !found;
  });
  return found;
}

std::optional<SegmentHit> SceneIndex::closest_hit(const LineSegment& segment) const {
  if (size() == 0) return std::nullopt;
  if (!is_usable(segment.from) || !is_usable(segment.to)) return SegmentHit{0.0, 0};
  std::optional<SegmentHit> best;
  const Triangle thin = {segment.from, segment.to, segment.to};
  visit_leaves(thin, [&](const auto& query, const IndexWalk::Leaf& leaf) {
    leaf.for_each(query, [&](std::uint32_t index) {
      const auto fraction = geometry::hit_fraction(segment, query.triangle(index));
      if (fraction && (!best || *fraction < best->fraction ||
                       (*fraction == best->fraction && index < best->triangle))) {
        best = SegmentHit{*fraction, index};
      }
      return true;
    });
    return true;
  });
  return best;
}

void SceneIndex::leaves_touching(const Triangle& triangle, std::vector<std::uint32_t>& out) const {
  out.clear();
  visit_leaves(triangle, [&](const auto&, const IndexWalk::Leaf& leaf) {
    out.push_back(leaf.id());
    return true;
  });
  std::sort(out.begin(), out.end());
}

double SceneIndex::nearest_error_m(std::span<const Triangle> body) const {
  if (body.empty() || size() == 0) return 0.0;
  return error_m(bounds_of(body));
}

double SceneIndex::error_m(const Box& body) const {
  return geometry::triangle_distance_error_m(body.merged(bounds_).sizes().maxCoeff());
}

std::optional<Nearest> SceneIndex::nearest(std::span<const Triangle> body, double cutoff_m) const {
  return search(body, cutoff_m, DistanceGoal::kNearest);
}

std::optional<Nearest> SceneIndex::near(std::span<const Triangle> body, double cutoff_m,
                                        double certain_m, double share) const {
  return search(body, cutoff_m, DistanceGoal::kNear, certain_m, share);
}

SweptResult SceneIndex::swept(const SweptBody& body) const {
  if (size() == 0 || body.middle.empty()) {
    return {true, std::nullopt, std::numeric_limits<double>::infinity()};
  }
  if (!is_usable(body.middle) || !is_usable(body.ends)) return {false, Nearest{0.0, 0}, 0.0};
  const Box box = bounds_of(body.ends);
  WalkedBy<SweptSearch> query(body, box, error_m(box));
  run(query);
  return query.result();
}

std::optional<Nearest> SceneIndex::any_within(std::span<const Triangle> body,
                                              double distance_m) const {
  return search(body, distance_m, DistanceGoal::kAny);
}

LeafTriangles SceneIndex::leaf_triangles(std::uint32_t leaf) const {
  const auto after = std::ranges::upper_bound(parts_, leaf, {}, &IndexedPart::first_leaf);
  const IndexedPart& part = *std::prev(after);
  return {part.first_triangle, part.indexed->tree.leaf(leaf - part.first_leaf)};
}

bool SceneIndex::visit_touching(const Box& box, bool (*visit)(void*, std::uint32_t),
                                void* context) const {
  if (size() == 0) return true;
  BoxQuery query(box, visit, context);
  run(query);
  return !query.is_done();
}

}  // namespace camway::scene
