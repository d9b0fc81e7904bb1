// SPDX-License-Identifier: MIT
#include "tests/scene/index/index_queries.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/scene/test_meshes.h"

namespace camway::scene {

using geometry::LineSegment;
using geometry::moved;
using geometry::Triangle;
using geometry::Vec3;

namespace {

/// Returns an index of `count` meshes, each with a range of the triangles, and of one without any
/// if there are several.
SceneIndex index_of_meshes(const std::vector<Triangle>& triangles, std::size_t count,
                           BuildIndexedMesh build, const IndexOptions& options) {
  std::vector<std::shared_ptr<const IndexedMesh>> meshes;
  const auto add = [&](std::size_t begin, std::size_t end) {
    const std::vector<Triangle> run(triangles.begin() + static_cast<std::ptrdiff_t>(begin),
                                    triangles.begin() + static_cast<std::ptrdiff_t>(end));
    meshes.push_back(build(std::make_shared<const Mesh>(mesh_of_triangles(run)), options));
  };
  for (std::size_t i = 0; i < count; ++i) {
    add(i * triangles.size() / count, (i + 1) * triangles.size() / count);
    if (i == 0 && count > 1) add(0, 0);
  }
  return SceneIndex::of(meshes);
}

/// Returns the distance of one triangle from the whole body.
double brute_nearest_of(const SceneIndex& tree, std::span<const Triangle> body,
                        std::uint32_t index) {
  double least_m = kInfinity;
  for (const Triangle& part : body) {
    least_m = std::min(least_m, geometry::triangle_distance(part, tree.triangle(index)));
  }
  return least_m;
}

}  // namespace

IndexQueries::IndexQueries() : random_(GetParam().seed) {
  const std::vector<Triangle> triangles =
      GetParam().on_grid ? grid_soup(random_, 500) : soup(random_, 700);
  tree_ = index_of_meshes(triangles, GetParam().meshes, GetParam().build,
                          {.threshold = GetParam().threshold, .max_depth = 12});
}

Vec3 IndexQueries::point() {
  return GetParam().on_grid ? random_.on_grid(14) : random_.in_cube(6.0);
}

Triangle IndexQueries::triangle() {
  const Vec3 at = point();
  if (GetParam().on_grid) return moved(random_.grid_triangle(2), at);
  const double size = random_.log_uniform(1e-3, 2.0);
  return {at + random_.in_cube(size), at + random_.in_cube(size), at + random_.in_cube(size)};
}

TEST_P(IndexQueries, FirstIntersectionIsTheLowestIndexOfAll) {
  int found = 0;
  for (int i = 0; i < 1500; ++i) {
    const Triangle t = triangle();
    const auto expected = brute_first_intersection(tree_, t);
    found += expected ? 1 : 0;
    ASSERT_EQ(tree_.first_intersection(t), expected);
    ASSERT_EQ(tree_.intersects(t), expected.has_value());
  }
  EXPECT_GT(found, 30);
  EXPECT_LT(found, 1400);
}

TEST_P(IndexQueries, ClosestHitIsTheFirstOfAll) {
  int found = 0;
  for (int i = 0; i < 1500; ++i) {
    const LineSegment segment{point(), point()};
    const auto expected = brute_closest_hit(tree_, segment);
    found += expected ? 1 : 0;
    expect_equal(tree_.closest_hit(segment), expected);
    if (HasFatalFailure() || HasNonfatalFailure()) return;
  }
  EXPECT_GT(found, 100);
}

TEST_P(IndexQueries, NearestIsTheNearestOfAll) {
  int zero = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<Triangle> body = {triangle(), triangle()};
    const std::span<const Triangle> used(body.data(), i % 3 == 0 ? 1 : 2);
    const double cutoff_m = i % 4 == 0 ? random_.log_uniform(1e-3, 10.0) : kInfinity;
    const auto expected = brute_nearest(tree_, used, cutoff_m);
    zero += expected && expected->distance_m == 0.0 ? 1 : 0;
    expect_equal(tree_.nearest(used, cutoff_m), expected);
    if (HasFatalFailure() || HasNonfatalFailure()) return;
  }
  EXPECT_GT(zero, 10);
}

// A point has bounds of its own.
TEST_P(IndexQueries, NearestToAPointIsTheNearestOfAll) {
  for (int i = 0; i < 1000; ++i) {
    const Vec3 at = point();
    const std::array<Triangle, 1> body = {Triangle{at, at, at}};
    const double cutoff_m = i % 4 == 0 ? random_.log_uniform(1e-3, 10.0) : kInfinity;
    expect_equal(tree_.nearest(body, cutoff_m), brute_nearest(tree_, body, cutoff_m));
    if (HasFatalFailure() || HasNonfatalFailure()) return;
  }
}

TEST_P(IndexQueries, NearestIsExclusiveAtItsCutoff) {
  for (int i = 0; i < 200; ++i) {
    const std::array<Triangle, 1> body = {triangle()};
    const auto nearest = tree_.nearest(body, kInfinity);
    ASSERT_TRUE(nearest);
    EXPECT_FALSE(tree_.nearest(body, nearest->distance_m));
    EXPECT_TRUE(tree_.nearest(body, std::nextafter(nearest->distance_m, kInfinity)));
  }
}

TEST_P(IndexQueries, LeavesTouchedHoldEveryTriangleTouched) {
  std::vector<std::uint32_t> leaves;
  for (int i = 0; i < 500; ++i) {
    const Triangle t = triangle();
    tree_.leaves_touching(t, leaves);
    ASSERT_TRUE(std::is_sorted(leaves.begin(), leaves.end()));
    std::set<std::uint32_t> members;
    for (const std::uint32_t leaf : leaves) {
      const LeafTriangles in_leaf = tree_.leaf_triangles(leaf);
      ASSERT_TRUE(std::ranges::is_sorted(in_leaf.numbers));
      for (const std::uint32_t number : in_leaf.numbers) members.insert(in_leaf.first + number);
    }
    for (std::uint32_t k = 0; k < tree_.size(); ++k) {
      ASSERT_TRUE(members.contains(k) || !geometry::triangles_touch(t, tree_.triangle(k)));
    }
  }
}

TEST_P(IndexQueries, AnyWithinFindsWhatThereIs) {
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<Triangle> body = {triangle(), triangle()};
    const double distance_m = random_.log_uniform(1e-3, 3.0);
    const auto any = tree_.any_within(body, distance_m);
    ASSERT_EQ(any.has_value(), brute_nearest(tree_, body, distance_m).has_value());
    if (!any) continue;
    ++found;
    ASSERT_LT(any->distance_m, distance_m);
    const auto own = brute_nearest_of(tree_, body, any->triangle);
    // The distance is that of the triangle from at least one part of the body.
    ASSERT_GE(any->distance_m, own);
    ASSERT_TRUE(
        geometry::triangle_distance(body[0], tree_.triangle(any->triangle)) == any->distance_m ||
        geometry::triangle_distance(body[1], tree_.triangle(any->triangle)) == any->distance_m);
  }
  EXPECT_GT(found, 100);
  EXPECT_LT(found, 1000);
}

TEST_P(IndexQueries, NearIsWithinTheShareOfTheNearestAndSureUpToALimit) {
  int rough = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<Triangle> body = {triangle(), triangle()};
    const double cutoff_m = i % 3 == 0 ? kInfinity : random_.log_uniform(1e-3, 3.0);
    const double certain_m = i % 2 == 0 ? 0.0 : random_.log_uniform(1e-3, 1.0);
    const double share = random_.uniform(0.05, 1.0);
    const auto near = tree_.near(body, cutoff_m, certain_m, share);
    const auto nearest = brute_nearest(tree_, body, cutoff_m);
    ASSERT_EQ(near.has_value(), nearest.has_value());
    if (!near) continue;
    ASSERT_GE(near->distance_m, nearest->distance_m);
    // Below this fraction of it only by the rounding of either.
    const double error_m = 4.0 * tree_.nearest_error_m(body);
    ASSERT_GE(nearest->distance_m, share * near->distance_m - error_m);
    ASSERT_EQ(near->distance_m == 0.0, nearest->distance_m == 0.0);
    ASSERT_EQ(near->distance_m < certain_m, nearest->distance_m < certain_m);
    ASSERT_LT(near->distance_m, cutoff_m);
    if (near->distance_m > nearest->distance_m) ++rough;
  }
  EXPECT_GT(rough, 0);
}

namespace {

// Returns whether a body on a straight motion comes nearer to a triangle than `keep_m`, at samples.
bool comes_near(const SceneIndex& tree, std::span<const Triangle> ends, double keep_m) {
  constexpr int kSamples = 16;
  for (int i = 0; i <= kSamples; ++i) {
    const double share = static_cast<double>(i) / kSamples;
    std::vector<Triangle> there;
    for (std::size_t part = 0; part < ends.size(); part += 2) {
      Triangle& t = there.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        t[k] = (1.0 - share) * ends[part][k] + share * ends[part + 1][k];
      }
    }
    if (tree.any_within(there, keep_m)) return true;
  }
  return false;
}

}  // namespace

TEST_P(IndexQueries, AClearPassageKeepsAwayAllTheWay) {
  int clear = 0;
  int beyond_reach = 0;  // clear, though what is near half way is nearer than the body moves
  int wrong = 0;         // not clear, though nothing comes near
  for (int run = 0; run < 600; ++run) {
    std::vector<Triangle> ends;
    std::vector<Triangle> middle;
    const Vec3 step = random_.in_cube(random_.log_uniform(1e-3, 1.0));
    const Vec3 at = point();
    for (int part = 0; part < 1 + run % 12; ++part) {
      const Triangle t = moved(random_.grid_triangle(1), at + random_.in_cube(0.3));
      middle.push_back(t);
      ends.push_back(moved(t, -step));
      ends.push_back(moved(t, step));
    }
    SweptBody body{middle, ends, random_.log_uniform(1e-6, 0.02), step.norm(), 0.0};
    body.reach_m += body.bend_m;
    const double error_m = tree_.nearest_error_m(ends);
    const double clearance_m = random_.log_uniform(1e-6, 0.1);
    body.keep_m = clearance_m + error_m;
    const SweptResult passage = tree_.swept(body);
    const bool near = comes_near(tree_, ends, clearance_m + body.bend_m);
    ASSERT_FALSE(passage.is_clear && near) << "run " << run;
    clear += passage.is_clear ? 1 : 0;
    wrong += !passage.is_clear && !near ? 1 : 0;
    if (passage.is_clear && tree_.any_within(middle, body.reach_m + clearance_m)) ++beyond_reach;
    if (passage.nearest) {
      // The distance of one part of the body; others may not have been tested.
      EXPECT_GE(passage.nearest->distance_m,
                brute_nearest_of(tree_, middle, passage.nearest->triangle));
    }
  }
  EXPECT_GT(clear, 100);
  EXPECT_GT(beyond_reach, 10);
  EXPECT_LT(wrong, 120);
}

TEST_P(IndexQueries, LargeBodiesAreAskedWhole) {
  for (int i = 0; i < 42; ++i) {
    std::vector<Triangle> body;
    const int count = i < 40 ? random_.integer(3, 40) : random_.integer(1000, 1100);
    for (int k = 0; k < count; ++k) body.push_back(triangle());
    const double cutoff_m = i % 2 == 0 ? kInfinity : random_.log_uniform(1e-3, 1.0);
    const auto expected = brute_nearest(tree_, body, cutoff_m);
    expect_equal(tree_.nearest(body, cutoff_m), expected);
    ASSERT_EQ(tree_.any_within(body, cutoff_m).has_value(), expected.has_value());
    if (HasFailure()) return;
  }
}

TEST_P(IndexQueries, VisitsWhatTouchesABox) {
  for (int i = 0; i < 300; ++i) {
    geometry::Box box(point());
    box.extend(Vec3(box.min() + (i % 4 == 0 ? Vec3(0, 0, 0) : random_.in_cube(2.0))));
    std::set<std::uint32_t> visited;
    EXPECT_TRUE(tree_.for_each_touching(box, [&](std::uint32_t t) {
      visited.insert(t);
      return true;
    }));
    const Triangle low = {box.min(), box.max(), Vec3(box.min().x(), box.max().y(), box.min().z())};
    for (std::uint32_t k = 0; k < tree_.size(); ++k) {
      const Triangle t = tree_.triangle(k);
      // A vertex inside, or a triangle inside the touched box, is a point in the box.
      const bool surely = box.contains(t[0]) || box.contains(t[1]) || box.contains(t[2]) ||
                          geometry::triangles_touch(low, t);
      ASSERT_TRUE(!surely || visited.contains(k));
      ASSERT_TRUE(!visited.contains(k) || geometry::bounds(t).intersects(box));
    }
    if (visited.empty()) continue;
    int calls = 0;
    EXPECT_FALSE(tree_.for_each_touching(box, [&](std::uint32_t) { return ++calls < 1; }));
    EXPECT_EQ(calls, 1);
  }
}

}  // namespace camway::scene
