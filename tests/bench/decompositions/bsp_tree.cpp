// SPDX-License-Identifier: MIT
#include "tests/bench/decompositions/bsp_tree.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "daemon/geometry/rounding.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "tests/bench/decompositions/bsp_builder.h"

namespace camway::bench {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;
using scene::Nearest;

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Box bounds_of(std::span<const Triangle> body) {
  Box box;
  for (const Triangle& triangle : body) box.extend(geometry::bounds(triangle));
  return box;
}

/// Remembers triangles that were tested, as a triangle is met in every cell that it has a piece in.
/// Forgetting one costs time only.
class Met {
 public:
  Met() { met_.fill(kNone); }

  bool was_met(std::uint32_t triangle) {
    std::uint32_t& slot = met_[triangle % met_.size()];
    if (slot == triangle) return true;
    slot = triangle;
    return false;
  }

 private:
  std::array<std::uint32_t, 64> met_;
};

/// The distance between two boxes along the axis where it is largest.
double box_gap_m(const Box& a, const Box& b) {
  return (a.min() - b.max()).cwiseMax(b.min() - a.max()).maxCoeff();
}

/// Finds the triangle nearest to a body, or any within a distance.
class NearestSearch {
 public:
  NearestSearch(std::span<const Triangle> body, double cutoff_m, bool any, double margin_m)
      : body_(body),
        box_(bounds_of(body)),
        any_(any),
        margin_m_(margin_m),
        best_{cutoff_m, kNone} {}

  [[nodiscard]] std::span<const Triangle> body() const { return body_; }
  /// Triangles that are surely farther need not be tested.
  [[nodiscard]] double reach_m() const { return best_.distance_m + margin_m_; }
  [[nodiscard]] bool is_done() const { return any_ && best_.triangle != kNone; }

  void test(const Triangle& triangle, std::uint32_t index) {
    if (met_.was_met(index) || box_gap_m(geometry::bounds(triangle), box_) > reach_m()) return;
    for (const Triangle& part : body_) {
      const double distance_m = geometry::triangle_distance(part, triangle, best_.distance_m);
      const bool is_tie = distance_m == best_.distance_m && best_.triangle != kNone;
      if (distance_m < best_.distance_m || (is_tie && index < best_.triangle)) {
        best_ = {distance_m, index};
      }
    }
  }

  [[nodiscard]] std::optional<Nearest> result() const {
    if (best_.triangle == kNone) return std::nullopt;
    return best_;
  }

 private:
  std::span<const Triangle> body_;
  Box box_;
  bool any_;
  double margin_m_;
  Nearest best_;
  Met met_;
};

/// Finds out whether a body touches any triangle.
class TouchSearch {
 public:
  TouchSearch(std::span<const Triangle> body, double margin_m)
      : body_(body), box_(bounds_of(body)), margin_m_(margin_m) {}

  [[nodiscard]] std::span<const Triangle> body() const { return body_; }
  [[nodiscard]] double reach_m() const { return margin_m_; }
  [[nodiscard]] bool is_done() const { return found_; }

  void test(const Triangle& triangle, std::uint32_t index) {
    if (met_.was_met(index) || !geometry::bounds(triangle).intersects(box_)) return;
    for (const Triangle& part : body_) {
      found_ = found_ || geometry::triangles_touch(part, triangle);
    }
  }

 private:
  std::span<const Triangle> body_;
  Box box_;
  double margin_m_;
  bool found_ = false;
  Met met_;
};

}  // namespace

BspTree::BspTree(std::shared_ptr<const scene::Mesh> mesh, const BspOptions& options)
    : mesh_(std::move(mesh)), bounds_(mesh_->bounds()) {
  assert(options.threshold >= 1 && options.max_depth <= kMaxBspDepth);
  BspBuilder(*this, options).build();
}

double BspTree::margin_m(const Box& body) const {
  const Box all = bounds_.merged(body);
  const double units = kBspErrorUnits + kBspErrorUnitsOfLevel * depth_;
  // A computed distance may be below the true one, and a bound above it.
  return units * geometry::kUnitRoundoff * largest_m(all) +
         2.0 * geometry::triangle_distance_error_m(all.sizes().maxCoeff());
}

/// Visits the nearer side first. Leaves out what is beyond the reach of the search.
template <class Search>
void BspTree::run(Search& search, QueryCost& cost) const {
  struct Waiting {
    std::uint32_t child;
    double least_m;  ///< bound of the distance of its triangles
  };
  // Each level leaves at most one sibling waiting.
  std::array<Waiting, kMaxBspDepth + 2> stack;
  std::size_t size = 0;
  const auto push = [&](std::uint32_t child, double least_m) {
    if (child != kNothing && least_m <= search.reach_m()) stack[size++] = {child, least_m};
  };
  const auto test_all = [&](const Range& range) {
    for (const std::uint32_t index : triangles_of(range)) {
      if (search.is_done()) return;
      ++cost.triangles;
      search.test(mesh_->triangle(index), index);
    }
  };
  push(root_, 0.0);
  while (size > 0 && !search.is_done()) {
    const Waiting top = stack[--size];
    if (top.least_m > search.reach_m()) continue;
    ++cost.nodes;
    if ((top.child & kLeafBit) != 0) {
      test_all(leaves_[top.child & ~kLeafBit]);
      continue;
    }
    const Node& node = nodes_[top.child];
    double low_m = std::numeric_limits<double>::infinity();
    double high_m = -std::numeric_limits<double>::infinity();
    for (const Triangle& part : search.body()) {
      for (const Vec3& corner : part) {
        const double height_m = node.plane.height_m(corner);
        low_m = std::min(low_m, height_m);
        high_m = std::max(high_m, height_m);
      }
    }
    const double behind_m = std::max(top.least_m, low_m);
    const double in_front_m = std::max(top.least_m, -high_m);
    if (std::max(behind_m, in_front_m) <= search.reach_m()) test_all(node.in_plane);
    if (behind_m < in_front_m) {
      push(node.in_front, in_front_m);
      push(node.behind, behind_m);
    } else {
      push(node.behind, behind_m);
      push(node.in_front, in_front_m);
    }
  }
}

std::optional<Nearest> BspTree::nearest(std::span<const Triangle> body, double cutoff_m) const {
  if (root_ == kNothing || body.empty()) return std::nullopt;
  NearestSearch search(body, cutoff_m, /*any=*/false, margin_m(bounds_of(body)));
  QueryCost cost;
  run(search, cost);
  return search.result();
}

std::optional<Nearest> BspTree::any_within(std::span<const Triangle> body, double distance_m,
                                           QueryCost* cost) const {
  if (root_ == kNothing || body.empty()) return std::nullopt;
  NearestSearch search(body, distance_m, /*any=*/true, margin_m(bounds_of(body)));
  QueryCost own;
  run(search, cost != nullptr ? *cost : own);
  return search.result();
}

bool BspTree::touches(std::span<const Triangle> body) const {
  if (root_ == kNothing || body.empty()) return false;
  TouchSearch search(body, margin_m(bounds_of(body)));
  QueryCost cost;
  run(search, cost);
  return search.is_done();
}

std::uint64_t BspTree::memory_bytes() const {
  return nodes_.size() * sizeof(Node) + leaves_.size() * sizeof(Range) +
         references_.size() * sizeof(std::uint32_t);
}

}  // namespace camway::bench
