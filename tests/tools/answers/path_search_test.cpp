// SPDX-License-Identifier: MIT
#include "tools/answers/path_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "daemon/collision/near_quad.h"
#include "daemon/geometry/triangle_intersection.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/random.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using base::Deadline;
using collision::CollisionInterval;
using collision::DetectOptions;

constexpr unsigned kSearchSeed = 20260914;

/// Time to bracket the end of an interval to a millimetre on these paths, which are never slower
/// than 5 cm/s for long.
constexpr double kEnds_s = 0.02;

/// Rounding of a time up to 100 s that is converted to a parameter of a segment and back.
constexpr double kRounding_s = 1e-12;

scene::Mesh dust_mesh(testing::Random& random) {
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  scene::Mesh mesh;
  for (std::uint32_t i = 0; i < 900; i += 3) {
    const geometry::Vec3 centre(coordinate(random), coordinate(random), coordinate(random));
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(centre + 0.1 * geometry::Vec3(coordinate(random), coordinate(random),
                                                            coordinate(random)));
    }
    mesh.triangles.push_back({i, i + 1, i + 2});
  }
  mesh.objects = {{"dust", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  return mesh;
}

motion::Path random_path(testing::Random& random, std::size_t count = 5) {
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  std::vector<motion::Keyframe> keyframes(count);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    keyframes[i].time_s = static_cast<double>(i);
    keyframes[i].pose.position = {coordinate(random), coordinate(random), coordinate(random)};
    keyframes[i].pose.orientation = geometry::from_wxyz(
        geometry::Vec4(4.0, coordinate(random), coordinate(random), coordinate(random))
            .normalized());
  }
  return motion::interpolate(keyframes);
}

bool covered(const CollisionInterval& inner, const std::vector<CollisionInterval>& outer,
             double slack_s) {
  return std::ranges::any_of(outer, [&](const CollisionInterval& interval) {
    return interval.t_begin_s <= inner.t_begin_s + slack_s &&
           inner.t_end_s <= interval.t_end_s + slack_s;
  });
}

/// Returns instants of the path at which the near quadrilateral touches the scene, by exact
/// predicates.
std::vector<double> touching_times_s(const scene::Mesh& mesh, const motion::Path& path,
                                     const motion::Camera& camera) {
  constexpr int kSamples = 1000;
  const motion::Corners corners_C = motion::near_corners_C(camera);
  std::vector<double> times_s;
  for (int i = 0; i <= kSamples; ++i) {
    const double time_s = path.begin_s() + (path.end_s() - path.begin_s()) * i / kSamples;
    const auto quad =
        collision::near_quad_triangles(motion::corners_W(corners_C, path.pose(time_s)));
    bool touches = false;
    for (std::size_t k = 0; k < mesh.triangles.size() && !touches; ++k) {
      touches = geometry::triangles_touch(mesh.triangle(k), quad[0]) ||
                geometry::triangles_touch(mesh.triangle(k), quad[1]);
    }
    if (touches) times_s.push_back(time_s);
  }
  return times_s;
}

// A search in parts misses no collision, and finds only those of a search of the whole path.
TEST(PathSearch, FindsWhatASearchOfTheWholeFinds) {
  testing::Random random(kSearchSeed);
  const scene::Mesh mesh = dust_mesh(random);
  const auto made = scene::make_snapshot("dust", mesh);
  ASSERT_TRUE(made.snapshot) << made.error;
  const motion::Camera camera{1.5, 1.2, 0.3};
  const motion::Body body{camera};
  const DetectOptions options;
  double longest_s = 0.0;
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    const motion::Path path = random_path(random);
    const auto whole =
        collision::detect_collisions({collision::Obstacles(*made.snapshot), body, options}, path,
                                     path.begin_s(), path.end_s(), Deadline::never());
    const PathSearch search =
        search_path({collision::Obstacles(*made.snapshot), body, options}, path, Deadline::never());
    ASSERT_TRUE(whole);
    ASSERT_TRUE(search.complete);
    EXPECT_EQ(search.searched_until_s, path.end_s());
    EXPECT_EQ(search.certificate.certified, whole->empty());
    for (const double time_s : touching_times_s(mesh, path, camera)) {
      EXPECT_TRUE(covered({time_s, time_s}, search.collisions, 0.0)) << time_s;
    }
    for (std::size_t i = 0; i < search.collisions.size(); ++i) {
      const CollisionInterval& interval = search.collisions[i];
      EXPECT_TRUE(covered(interval, *whole, kEnds_s)) << interval.t_begin_s;
      if (i > 0) {
        EXPECT_GT(interval.t_begin_s, search.collisions[i - 1].t_end_s);
      }
      longest_s = std::max(longest_s, interval.t_end_s - interval.t_begin_s);
    }
  }
  EXPECT_GT(longest_s, 0.1) << "no interval reaches over several parts of 0.04 s";
}

// Collisions found before the deadline are kept. The test does not depend on the machine's speed:
// it searches for a deadline between two of them.
TEST(PathSearch, ADeadlineLeavesWhatWasFoundBeforeIt) {
  testing::Random random(kSearchSeed);
  const auto made = scene::make_snapshot("dust", dust_mesh(random));
  ASSERT_TRUE(made.snapshot) << made.error;
  const motion::Body body{motion::Camera{1.5, 1.2, 0.3}};
  const motion::Path path = random_path(random, 100);
  const Deadline clock = Deadline::never();
  const PathSearch all =
      search_path({collision::Obstacles(*made.snapshot), body}, path, Deadline::never());
  double deadline_s = clock.elapsed_ms() / 2000.0;
  ASSERT_TRUE(all.complete);
  PathSearch some;
  for (int attempt = 0; attempt < 50; ++attempt) {
    some = search_path({collision::Obstacles(*made.snapshot), body}, path,
                       Deadline::after_s(deadline_s));
    if (!some.complete && !some.collisions.empty()) break;
    deadline_s *= some.complete ? 0.5 : 1.7;
  }
  ASSERT_FALSE(some.complete);
  EXPECT_FALSE(some.certificate.certified);
  EXPECT_GT(some.searched_until_s, path.begin_s());
  EXPECT_LT(some.searched_until_s, path.end_s());
  ASSERT_FALSE(some.collisions.empty());
  const auto begun = std::ranges::count_if(all.collisions, [&](const CollisionInterval& interval) {
    return interval.t_begin_s < some.searched_until_s - kRounding_s;
  });
  ASSERT_EQ(some.collisions.size(), static_cast<std::size_t>(begun));
  for (std::size_t i = 0; i + 1 < some.collisions.size(); ++i) {
    EXPECT_EQ(some.collisions[i], all.collisions[i]);
  }
  const CollisionInterval& last = some.collisions.back();
  const CollisionInterval& whole = all.collisions[some.collisions.size() - 1];
  EXPECT_EQ(last.t_begin_s, whole.t_begin_s);
  EXPECT_NEAR(last.t_end_s, std::min(whole.t_end_s, some.searched_until_s), kRounding_s);
}

TEST(PathSearch, ADeadlineThatHasPassedLeavesNothingKnown) {
  const auto made = scene::make_snapshot("wall", wall_mesh());
  ASSERT_TRUE(made.snapshot) << made.error;
  testing::Random random(kSearchSeed);
  const motion::Path path = random_path(random);
  const PathSearch search =
      search_path({collision::Obstacles(*made.snapshot), motion::Body{motion::Camera{}}}, path,
                  Deadline::after_s(0.0));
  EXPECT_FALSE(search.complete);
  EXPECT_FALSE(search.certificate.certified);
  EXPECT_EQ(search.searched_until_s, path.begin_s());
}

}  // namespace
}  // namespace camway::tools
