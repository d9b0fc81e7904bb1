// SPDX-License-Identifier: MIT
#include "daemon/collision/probe.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/motion/body/body.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::collision {
namespace {

using geometry::Vec3;
using motion::Pose;

// A probe that remembers what stopped it must answer as one that knows nothing.
TEST(Probe, WhatStoppedItBeforeChangesNoAnswer) {
  testing::Random random(5);
  const motion::Body body(testing::small_camera());
  for (int run = 0; run < 20; ++run) {
    const scene::SceneIndex index =
        scene::SceneIndex::build(testing::scattered_triangles(random, 60, 1.0));
    const Obstacles obstacles(index);
    const double clearance_m = random.chance(0.5) ? 0.0 : random.log_uniform(1e-4, 0.3);
    Probe probe(obstacles, body, clearance_m);
    int free_count = 0;
    Pose pose{random.in_cube(1.0), random.rotation()};
    for (int i = 0; i < 300; ++i) {
      // Mostly a little way on, as searches do, so that the same triangle is met again.
      if (random.chance(0.1)) pose = {random.in_cube(1.0), random.rotation()};
      pose.position += random.normal_vector(0.02);
      const double margin_m = random.chance(0.5) ? 0.0 : random.log_uniform(1e-6, 0.1);
      const bool expected =
          Probe(obstacles, body, clearance_m).check(motion::standing_at(pose), margin_m).free;
      ASSERT_EQ(probe.is_free(pose, margin_m), expected) << "run " << run << ", pose " << i;
      free_count += expected ? 1 : 0;
    }
    EXPECT_GT(free_count, 0) << "run " << run;
    EXPECT_LT(free_count, 300) << "run " << run;
  }
}

// Exactly at the required distance and one rounding beside it, where computed distances may differ
// from the true ones.
TEST(Probe, WhatStoppedItBeforeChangesNoAnswerAtTheRequiredDistance) {
  scene::Mesh mesh;
  testing::add_triangle(mesh, {-50, -50, 0}, {50, -50, 0}, {0, 80, 0});
  const scene::SceneIndex index = scene::SceneIndex::build(mesh);
  const Obstacles obstacles(index);
  const motion::Body body(testing::small_camera());
  testing::Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const double clearance_m = random.chance(0.3) ? 0.0 : random.uniform(0.0, 0.5);
    Probe probe(obstacles, body, clearance_m);
    const geometry::Quat orientation = random.rotation();
    double lowest_m = 0.0;
    for (const geometry::Triangle& triangle : body.triangles_C()) {
      for (const Vec3& corner_C : triangle) {
        lowest_m = std::min(lowest_m, (orientation * corner_C).z());
      }
    }
    const double limit_m = clearance_m - lowest_m;
    probe.is_free({{0.0, 0.0, limit_m - 0.01}, orientation});
    const double beside_m = random.integer(-8, 8) * 0x1p-50;
    const Pose pose{{0.0, 0.0, limit_m + beside_m}, orientation};
    EXPECT_EQ(probe.is_free(pose),
              Probe(obstacles, body, clearance_m).check(motion::standing_at(pose)).free)
        << i;
  }
}

}  // namespace
}  // namespace camway::collision
