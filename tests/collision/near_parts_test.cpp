// SPDX-License-Identifier: MIT
//
// Bodies of many triangles: what is chosen of them, and what detection makes of it, against the
// same triangles in bodies that are small enough to be looked at as a whole.
#include "daemon/collision/near_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/collision/detect.h"
#include "daemon/collision/probe.h"
#include "daemon/geometry/triangle_distance.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Bounds;
using geometry::Triangle;
using geometry::Vec3;
using motion::Body;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Above the rounding of distances of a few metres.
constexpr double kDistanceRounding_m = 1e-12;

/// Returns a bumpy ball about `center` of about `count` small triangles.
motion::MeshShape bumpy_ball(testing::Random& random, const Vec3& center, double radius_m,
                             int count) {
  motion::MeshShape mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = center + radius_m * random.uniform(0.8, 1.0) * random.direction();
    const auto first = static_cast<std::uint32_t>(mesh.vertices_C.size());
    for (int k = 0; k < 3; ++k) mesh.vertices_C.push_back(at + random.in_cube(0.1 * radius_m));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Body body_of(const motion::BodyShape& shape) {
  base::Result<Body> body = Body::make(shape);
  EXPECT_TRUE(body) << body.error;
  return body.value.value_or(Body(testing::small_camera()));
}

std::shared_ptr<const scene::Snapshot> scattered_scene(testing::Random& random) {
  return scene::make_snapshot("test", testing::scattered_triangles(random, 60, 0.2)).snapshot;
}

Triangle placed(const Triangle& triangle_C, const motion::Stretch& stretch) {
  Triangle triangle;
  for (std::size_t k = 0; k < 3; ++k) triangle[k] = stretch.R_WC * triangle_C[k] + stretch.eye_W;
  return triangle;
}

/// Returns the distance from the scene, or the depth inside the bounds if that is less.
double room_m(const scene::Snapshot& scene, const Bounds& bounds, const Triangle& triangle) {
  double room_m = kInfinity;
  for (std::uint32_t i = 0; i < scene.index.size(); ++i) {
    room_m = std::min(room_m, geometry::triangle_distance(triangle, scene.index.triangle(i)));
  }
  for (const Vec3& vertex : triangle) room_m = std::min(room_m, bounds.depth_m(vertex));
  return room_m;
}

Bounds random_bounds(testing::Random& random) {
  Bounds bounds;
  if (random.chance(0.5)) bounds.min_W.x() = random.uniform(-3.0, -1.0);
  if (random.chance(0.5)) bounds.max_W.z() = random.uniform(1.0, 3.0);
  return bounds;
}

TEST(NearParts, WhatIsLeftOutIsFartherAwayThanAsked) {
  testing::Random random(1802);
  int left_out = 0;
  int chosen = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto scene = scattered_scene(random);
    const Bounds bounds = random_bounds(random);
    const Body body = body_of(bumpy_ball(random, random.in_cube(0.3), 0.4, 300));
    ASSERT_NE(body.tree(), nullptr);
    NearParts parts(Obstacles(*scene).within(bounds), body);
    const motion::Stretch stretch = motion::standing_at({random.in_cube(2.0), random.rotation()});
    const double within_m = random.chance(0.2) ? 0.0 : random.log_uniform(1e-3, 0.5);
    parts.choose(stretch, within_m);
    std::vector<bool> is_chosen(body.triangles_C().size(), false);
    for (const std::uint32_t number : parts.numbers()) {
      ASSERT_FALSE(is_chosen[number]) << "twice";
      is_chosen[number] = true;
    }
    for (std::size_t i = 0; i < is_chosen.size(); ++i) {
      if (is_chosen[i]) continue;
      const double far_m = room_m(*scene, bounds, placed(body.triangles_C()[i], stretch));
      ASSERT_GT(far_m, within_m - kDistanceRounding_m);
      ASSERT_GT(far_m, parts.others_at_least_m() - kDistanceRounding_m);
    }
    left_out += static_cast<int>(std::ranges::count(is_chosen, false));
    chosen += static_cast<int>(parts.numbers().size());
  }
  EXPECT_GT(left_out, chosen) << "or it would be of no use";
  EXPECT_GT(chosen, 0);
}

TEST(NearParts, AllAreChosenOfAFewAndForAnEndlessDistance) {
  testing::Random random(1803);
  const auto scene = scattered_scene(random);
  const motion::Stretch far_away =
      motion::standing_at({Vec3(100, 0, 0), geometry::Quat::Identity()});
  const Body few = body_of(bumpy_ball(random, Vec3::Zero(), 0.4, 20));
  NearParts all_of_few(Obstacles(*scene), few);
  all_of_few.choose(far_away, 0.1);
  EXPECT_EQ(all_of_few.numbers().size(), 20U);
  EXPECT_EQ(all_of_few.others_at_least_m(), kInfinity);

  const Body many = body_of(bumpy_ball(random, Vec3::Zero(), 0.4, 200));
  NearParts parts(Obstacles(*scene), many);
  parts.choose(far_away, 0.1);
  EXPECT_EQ(parts.numbers().size(), 0U);
  EXPECT_GT(parts.others_at_least_m(), 0.1);
  parts.choose(far_away, kInfinity);
  EXPECT_EQ(parts.numbers().size(), 200U);
}

/// Returns bodies of at most 50 triangles each that are the whole together.
std::vector<Body> pieces_of(const motion::MeshShape& whole) {
  std::vector<Body> pieces;
  for (std::size_t begin = 0; begin < whole.triangles.size(); begin += 50) {
    motion::MeshShape piece;
    piece.vertices_C = whole.vertices_C;
    const std::size_t end = std::min(begin + 50, whole.triangles.size());
    piece.triangles.assign(whole.triangles.begin() + static_cast<std::ptrdiff_t>(begin),
                           whole.triangles.begin() + static_cast<std::ptrdiff_t>(end));
    pieces.push_back(body_of(piece));
    EXPECT_EQ(pieces.back().tree(), nullptr);
  }
  return pieces;
}

motion::Path random_flight(testing::Random& random) {
  std::vector<motion::Keyframe> keyframes;
  for (int i = 0; i < 3; ++i) {
    keyframes.push_back({1.0 * i, {random.in_cube(2.0), random.rotation()}});
  }
  return motion::interpolate(keyframes);
}

bool collides_at(const std::vector<CollisionInterval>& intervals, double time_s) {
  return std::ranges::any_of(intervals, [&](const CollisionInterval& interval) {
    return interval.t_begin_s <= time_s && time_s <= interval.t_end_s;
  });
}

/// Whether the body touches something, or is beyond the bounds, at the pose of `path` at a time.
bool surely_touches(std::vector<Body>& pieces, const Obstacles& obstacles, double clearance_m,
                    const motion::Pose& pose) {
  return std::ranges::any_of(pieces, [&](const Body& piece) {
    Probe probe(obstacles, piece, clearance_m);
    const ProbeResult seen = probe.check_refined(motion::standing_at(pose), 0.0, 1.0);
    return !seen.free && seen.gap_m < -kDistanceRounding_m;
  });
}

TEST(LargeBody, DetectionFindsWhatItsPiecesMeet) {
  testing::Random random(1804);
  int colliding = 0;
  int free = 0;
  for (int trial = 0; trial < 15; ++trial) {
    const auto scene = scattered_scene(random);
    const Obstacles obstacles = Obstacles(*scene).within(random_bounds(random));
    const motion::MeshShape shape = bumpy_ball(random, random.in_cube(0.3), 0.25, 250);
    const Body whole = body_of(shape);
    std::vector<Body> pieces = pieces_of(shape);
    const motion::Path path = random_flight(random);
    DetectOptions options;
    options.clearance_m = random.chance(0.5) ? 0.02 : 0.0;
    const base::Deadline never = base::Deadline::never();
    const auto found = detect_collisions({obstacles, whole, options}, path, 0.0, 2.0, never);
    ASSERT_TRUE(found);
    std::vector<std::vector<CollisionInterval>> of_pieces;
    for (const Body& piece : pieces) {
      of_pieces.push_back(*detect_collisions({obstacles, piece, options}, path, 0.0, 2.0, never));
    }
    for (int i = 0; i <= 200; ++i) {
      const double time_s = i / 100.0;
      const bool touches =
          surely_touches(pieces, obstacles, options.clearance_m, path.pose(time_s));
      ASSERT_TRUE(!touches || collides_at(*found, time_s)) << trial << " at " << time_s;
      ++(touches ? colliding : free);
    }
    // Intervals of a piece lie in those of the whole, but for the tolerance of their ends.
    for (const std::vector<CollisionInterval>& intervals : of_pieces) {
      for (const CollisionInterval& interval : intervals) {
        const double middle_s = 0.5 * (interval.t_begin_s + interval.t_end_s);
        EXPECT_TRUE(collides_at(*found, middle_s)) << trial;
      }
    }
    for (const CollisionInterval& interval : *found) {
      ASSERT_TRUE(interval.witness);
      if (Obstacles::is_side(interval.witness->triangle)) continue;
      EXPECT_LT(interval.witness->feature, shape.triangles.size());
    }
  }
  EXPECT_GT(colliding, 100);
  EXPECT_GT(free, 100);
}

TEST(LargeBody, ClearanceIsThatOfItsNearestPiece) {
  testing::Random random(1805);
  int measured = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto scene = scattered_scene(random);
    const motion::MeshShape shape = bumpy_ball(random, Vec3::Zero(), 0.05, 200);
    const Body whole = body_of(shape);
    std::vector<Body> pieces = pieces_of(shape);
    const motion::Path path = random_flight(random);
    const base::Deadline never = base::Deadline::never();
    const auto certified = path_clearance(Obstacles(*scene), path, whole, never);
    ASSERT_TRUE(certified);
    double least_m = kInfinity;
    for (int i = 0; i <= 100; ++i) {
      for (const Body& piece : pieces) {
        Probe probe(Obstacles(*scene), piece, 0.0);
        const ProbeResult seen =
            probe.check_refined(motion::standing_at(path.pose(i / 50.0)), 1.0, 1.0);
        least_m = std::min(least_m, seen.free ? 1.0 : seen.gap_m);
      }
    }
    if (!(certified->lower_bound_m > 0.0)) continue;
    ++measured;
    EXPECT_LE(certified->lower_bound_m, least_m + kDistanceRounding_m);
    EXPECT_GE(certified->lower_bound_m,
              (1.0 - kClearanceTolerance - 0.01) * certified->upper_bound_m);
  }
  EXPECT_GT(measured, 3);
}

}  // namespace
}  // namespace camway::collision
