// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>

#include "daemon/geometry/segment_triangle.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/geometry/triangle_intersection.h"
#include "tests/geometry/random_triangles.h"
#include "tests/scene/test_meshes.h"

namespace camway::scene {
namespace {

using geometry::LineSegment;
using geometry::moved;
using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What the queries must answer: every triangle asked in turn.

std::optional<std::uint32_t> brute_first_intersection(const SceneIndex& tree, const Triangle& t) {
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    if (geometry::triangles_touch(t, tree.triangle(i))) return i;
  }
  return std::nullopt;
}

std::optional<SegmentHit> brute_closest_hit(const SceneIndex& tree, const LineSegment& segment) {
  std::optional<SegmentHit> best;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    const auto fraction = geometry::hit_fraction(segment, tree.triangle(i));
    if (fraction && (!best || *fraction < best->fraction)) best = SegmentHit{*fraction, i};
  }
  return best;
}

std::optional<Nearest> brute_nearest(const SceneIndex& tree, std::span<const Triangle> body,
                                     double cutoff_m) {
  std::optional<Nearest> best;
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    for (const Triangle& part : body) {
      const double distance_m = geometry::triangle_distance(part, tree.triangle(i));
      if (distance_m < (best ? best->distance_m : cutoff_m)) best = Nearest{distance_m, i};
    }
  }
  return best;
}

void expect_equal(const std::optional<SegmentHit>& a, const std::optional<SegmentHit>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->fraction, b->fraction);
  EXPECT_EQ(a->triangle, b->triangle);
}

void expect_equal(const std::optional<Nearest>& a, const std::optional<Nearest>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->distance_m, b->distance_m);
  EXPECT_EQ(a->triangle, b->triangle);
}

/// Triangles of all sizes in a cube of 10 m, many small ones in one corner.
std::vector<Triangle> soup(RandomTriangles& random, int count) {
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const double size = random.log_uniform(1e-3, 3.0);
    const Vec3 center = random.in_cube(i % 2 == 0 ? 5.0 : 0.3);
    triangles.push_back({center + random.in_cube(size), center + random.in_cube(size),
                         center + random.in_cube(size)});
  }
  return triangles;
}

/// Integer coordinates: touching, coplanar, equal and degenerate triangles, ties in distance.
std::vector<Triangle> grid_soup(RandomTriangles& random, int count) {
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = random.on_grid(12);
    triangles.push_back(moved(random.grid_triangle(2), at));
    if (i % 5 == 0) triangles.push_back(triangles.back());
  }
  return triangles;
}

struct Case {
  const char* name;
  std::uint64_t seed;
  bool on_grid;
  std::uint32_t threshold;
};

class OctreeQueries : public testing::TestWithParam<Case> {
 protected:
  OctreeQueries() : random_(GetParam().seed) {
    const std::vector<Triangle> triangles =
        GetParam().on_grid ? grid_soup(random_, 500) : soup(random_, 700);
    tree_ = SceneIndex::build(mesh_of_triangles(triangles),
                              {.threshold = GetParam().threshold, .max_depth = 12});
  }

  Vec3 point() { return GetParam().on_grid ? random_.on_grid(14) : random_.in_cube(6.0); }

  Triangle triangle() {
    const Vec3 at = point();
    if (GetParam().on_grid) return moved(random_.grid_triangle(2), at);
    const double size = random_.log_uniform(1e-3, 2.0);
    return {at + random_.in_cube(size), at + random_.in_cube(size), at + random_.in_cube(size)};
  }

  RandomTriangles random_;
  SceneIndex tree_;
};

TEST_P(OctreeQueries, FirstIntersectionIsTheLowestIndexOfAll) {
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

TEST_P(OctreeQueries, ClosestHitIsTheFirstOfAll) {
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

TEST_P(OctreeQueries, NearestIsTheNearestOfAll) {
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

TEST_P(OctreeQueries, NearestIsExclusiveAtItsCutoff) {
  for (int i = 0; i < 200; ++i) {
    const std::array<Triangle, 1> body = {triangle()};
    const auto nearest = tree_.nearest(body, kInfinity);
    ASSERT_TRUE(nearest);
    EXPECT_FALSE(tree_.nearest(body, nearest->distance_m));
    EXPECT_TRUE(tree_.nearest(body, std::nextafter(nearest->distance_m, kInfinity)));
  }
}

TEST_P(OctreeQueries, LeavesTouchedHoldEveryTriangleTouched) {
  std::vector<std::uint32_t> leaves;
  for (int i = 0; i < 500; ++i) {
    const Triangle t = triangle();
    tree_.leaves_touching(t, leaves);
    ASSERT_TRUE(std::is_sorted(leaves.begin(), leaves.end()));
    std::set<std::uint32_t> members;
    for (const std::uint32_t leaf : leaves) {
      const auto in_leaf = tree_.leaf_triangles(leaf);
      ASSERT_TRUE(std::is_sorted(in_leaf.begin(), in_leaf.end()));
      members.insert(in_leaf.begin(), in_leaf.end());
    }
    for (std::uint32_t k = 0; k < tree_.size(); ++k) {
      ASSERT_TRUE(members.contains(k) || !geometry::triangles_touch(t, tree_.triangle(k)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, OctreeQueries,
                         testing::Values(Case{"Soup", 501, false, 8},
                                         Case{"SoupDeep", 502, false, 1},
                                         Case{"Grid", 503, true, 8},
                                         Case{"GridDeep", 504, true, 2}),
                         [](const auto& instance) { return std::string(instance.param.name); });

void expect_bounded(const SceneIndex& tree, const IndexOptions& options) {
  const IndexStatistics& s = tree.statistics();
  std::printf("%llu triangles: %llu nodes, %llu leaves, depth %u, duplication %.2f, %.1f MB\n",
              static_cast<unsigned long long>(s.triangles),
              static_cast<unsigned long long>(s.nodes), static_cast<unsigned long long>(s.leaves),
              s.depth, s.duplication, static_cast<double>(s.memory_bytes) * 1e-6);
  const auto triangles = static_cast<double>(s.triangles);
  EXPECT_LE(s.depth, options.max_depth);
  EXPECT_LE(static_cast<double>(s.references), options.max_duplication * triangles);
  EXPECT_GE(s.references, s.triangles);
  // A node that splits has more than `threshold` entries, and the entries of one level are within
  // the bound of duplication.
  const double splits = options.max_duplication * triangles / options.threshold * options.max_depth;
  EXPECT_LE(static_cast<double>(s.nodes), 1.0 + 8.0 * splits);
  EXPECT_LT(static_cast<double>(s.memory_bytes), 500.0 * triangles + 1e4);
}

TEST(OctreeBounds, AFanOfManyTrianglesAtOneVertex) {
  constexpr int kCount = 100'000;
  std::vector<Triangle> fan;
  const auto rim = [](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kCount;
    return Vec3(std::cos(angle), std::sin(angle), 0.3 * std::sin(7.0 * angle));
  };
  for (int i = 0; i < kCount; ++i) fan.push_back({Vec3(0, 0, 1), rim(i), rim(i + 1)});
  const IndexOptions options;
  expect_bounded(SceneIndex::build(mesh_of_triangles(fan), options), options);
}

TEST(OctreeBounds, ManyCopiesOfOneTriangle) {
  const std::vector<Triangle> copies(100'000, {Vec3(0, 0, 0), Vec3(3, 1, 0), Vec3(1, 4, 2)});
  const IndexOptions options;
  const SceneIndex tree = SceneIndex::build(mesh_of_triangles(copies), options);
  expect_bounded(tree, options);
  // Splitting cannot tell them apart, so it is not tried.
  EXPECT_EQ(tree.statistics().leaves, 1U);
  const std::array<Triangle, 1> body = {copies[0]};
  expect_equal(tree.nearest(body, kInfinity), Nearest{0.0, 0});
}

TEST(OctreeBounds, OneHugeTriangleOverDust) {
  RandomTriangles random(505);
  std::vector<Triangle> scene = {{Vec3(-100, -90, -1), Vec3(120, -80, 1), Vec3(0, 150, 0)}};
  for (int i = 0; i < 50'000; ++i) {
    const Vec3 at = random.in_cube(1.0);
    scene.push_back(
        {at + random.in_cube(1e-4), at + random.in_cube(1e-4), at + random.in_cube(1e-4)});
  }
  const IndexOptions options;
  const SceneIndex tree = SceneIndex::build(mesh_of_triangles(scene), options);
  expect_bounded(tree, options);
  EXPECT_LT(tree.statistics().duplication, 1.5);
  for (int i = 0; i < 20; ++i) {
    const Vec3 at = random.in_cube(1.5);
    const std::array<Triangle, 1> body = {Triangle{at, at + random.in_cube(0.1), at}};
    expect_equal(tree.nearest(body, kInfinity), brute_nearest(tree, body, kInfinity));
  }
}

TEST(OctreeBounds, ManyPointsAtOnePlace) {
  const Vec3 p(1e6, -1e6, 3.0);
  const IndexOptions options;
  const SceneIndex tree =
      SceneIndex::build(mesh_of_triangles(std::vector<Triangle>(5000, {p, p, p})), options);
  expect_bounded(tree, options);
  EXPECT_EQ(tree.first_intersection({p, p, p}), std::optional<std::uint32_t>(0));
}

TEST(OctreeBounds, AFlatSceneIsNotDuplicatedByItsPlane) {
  RandomTriangles random(506);
  std::vector<Triangle> floor;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 at(random.uniform(0, 40), random.uniform(0, 30), 0.0);
    floor.push_back({at, at + Vec3(0.1, 0, 0), at + Vec3(0, 0.1, 0)});
  }
  const IndexOptions options;
  const SceneIndex tree = SceneIndex::build(mesh_of_triangles(floor), options);
  expect_bounded(tree, options);
  EXPECT_LT(tree.statistics().duplication, 1.5);
}

TEST(SceneIndex, ThresholdAndDepthAreObeyed) {
  RandomTriangles random(507);
  const Mesh mesh = mesh_of_triangles(soup(random, 2000));
  const SceneIndex shallow = SceneIndex::build(mesh, {.threshold = 1, .max_depth = 2});
  EXPECT_EQ(shallow.statistics().depth, 2U);
  const SceneIndex all_in_one = SceneIndex::build(mesh, {.threshold = 2000});
  EXPECT_EQ(all_in_one.statistics().leaves, 1U);
  EXPECT_EQ(all_in_one.statistics().duplication, 1.0);
  EXPECT_GT(SceneIndex::build(mesh, {.threshold = 4}).statistics().leaves,
            SceneIndex::build(mesh, {.threshold = 64}).statistics().leaves);
}

TEST(SceneIndex, IsTheSameEveryTime) {
  RandomTriangles random(508);
  const Mesh mesh = mesh_of_triangles(soup(random, 2000));
  const SceneIndex a = SceneIndex::build(mesh);
  const SceneIndex b = SceneIndex::build(mesh);
  EXPECT_EQ(a.statistics(), b.statistics());
  for (std::uint32_t leaf = 0; leaf < a.statistics().leaves; ++leaf) {
    ASSERT_TRUE(std::ranges::equal(a.leaf_triangles(leaf), b.leaf_triangles(leaf)));
  }
}

TEST(SceneIndex, AnEmptySceneAnswersNothing) {
  for (const SceneIndex& tree : {SceneIndex(), SceneIndex::build(Mesh())}) {
    const Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    EXPECT_FALSE(tree.first_intersection(t));
    EXPECT_FALSE(tree.intersects(t));
    EXPECT_FALSE(tree.closest_hit({t[0], t[1]}));
    EXPECT_FALSE(tree.nearest(std::array<Triangle, 1>{t}, kInfinity));
    std::vector<std::uint32_t> leaves = {7};
    tree.leaves_touching(t, leaves);
    EXPECT_TRUE(leaves.empty());
  }
}

TEST(SceneIndex, AnswersFarFromTheOrigin) {
  RandomTriangles random(509);
  const Vec3 far(1e6, -2e6, 5e5);
  std::vector<Triangle> triangles = soup(random, 500);
  for (Triangle& t : triangles) t = moved(t, far);
  const SceneIndex tree = SceneIndex::build(mesh_of_triangles(triangles), {.threshold = 4});
  for (int i = 0; i < 300; ++i) {
    const Triangle t = moved({random.in_cube(5.0), random.in_cube(5.0), random.in_cube(5.0)}, far);
    ASSERT_EQ(tree.first_intersection(t), brute_first_intersection(tree, t));
    expect_equal(tree.nearest(std::array<Triangle, 1>{t}, kInfinity),
                 brute_nearest(tree, std::array<Triangle, 1>{t}, kInfinity));
  }
}

}  // namespace
}  // namespace camway::scene
