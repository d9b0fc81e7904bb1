// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "daemon/collision/detect.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/path/guide.h"
#include "daemon/geometry/triangle_distance.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

/// A small scene for tests of searches, with oracles that test every triangle.
namespace camway::correction::testing_search {

using camway::geometry::Quat;
using camway::geometry::Triangle;
using camway::geometry::Vec3;
using camway::geometry::Vec4;
using motion::SignedPose;

struct SearchScene {
  explicit SearchScene(scene::Mesh mesh_W,
                       const motion::Body& moving = motion::Body(testing::small_camera()))
      : mesh(std::move(mesh_W)), index(scene::SceneIndex::build(mesh)), body(moving) {}

  [[nodiscard]] FreeSpace space(const OrientationPolicy& policy = {}) const {
    return FreeSpace({collision::Obstacles(index), body, detect}, policy);
  }

  /// Returns the distance of a point from the scene; infinity for an empty scene.
  [[nodiscard]] double distance_m(const Vec3& point_W) const {
    return least_m({point_W, point_W, point_W});
  }

  /// Returns the distance of the body from the scene. Requires a body without an inside.
  [[nodiscard]] double distance_m(const motion::Pose& pose) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& part_C : body.triangles_C()) {
      Triangle part_W;
      for (std::size_t i = 0; i < 3; ++i) part_W[i] = pose.position + pose.orientation * part_C[i];
      least = std::min(least, least_m(part_W));
    }
    return least - body.ball_radius_m();
  }

  [[nodiscard]] double least_m(const Triangle& part_W) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      least = std::min(least, camway::geometry::triangle_distance(part_W, mesh.triangle(t)));
    return least;
  }

  scene::Mesh mesh;
  scene::SceneIndex index;
  motion::Body body;
  collision::DetectOptions detect;
};

inline motion::Body sphere(double radius_m) {
  return *motion::Body::make(motion::SphereShape{Vec3::Zero(), radius_m});
}

/// Returns a wall in the plane z = 0, 10 cm thick, open for x from `from_m` to `to_m`.
inline scene::Mesh wall_with_gap(double from_m, double to_m) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-30, -30, -0.05}, {from_m, 30, 0.05});
  testing::add_cuboid(mesh, {to_m, -30, -0.05}, {30, 30, 0.05});
  return mesh;
}

/// Returns `count` cuboids of up to `size_m` in a cube of side 2 m about the origin.
inline scene::Mesh scattered_cuboids(testing::Random& random, int count, double size_m) {
  std::uniform_real_distribution<double> share(0.2, 1.0);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  scene::Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 min(place(random), place(random), place(random));
    const double x = share(random);
    const double y = share(random);
    const double z = share(random);
    testing::add_cuboid(mesh, min, min + size_m * Vec3(x, y, z));
  }
  return mesh;
}

/// Returns the least distance between body and scene over the motions of `guide`, at samples
/// between which the body moves by less than `step_m`.
inline double least_distance_m(const SearchScene& scene, const FreeSpace& space, const Guide& guide,
                               double step_m) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < guide.size(); ++i) {
    const int steps = 1 + static_cast<int>(space.distance_m(guide[i - 1], guide[i]) / step_m);
    for (int k = 0; k <= steps; ++k) {
      const SignedPose at = motion::between(guide[i - 1], guide[i], static_cast<double>(k) / steps);
      least = std::min(least, scene.distance_m(motion::unsigned_pose(at)));
    }
  }
  return least;
}

/// Returns whether the search for collisions proves every motion of `guide` free, with `margin_m`
/// in addition to the required clearance.
inline bool is_proved_free(const SearchScene& scene, const Guide& guide, double margin_m) {
  collision::DetectOptions detect = scene.detect;
  detect.clearance_m += margin_m;
  for (std::size_t i = 1; i < guide.size(); ++i) {
    const motion::Path path({motion::straight_motion(guide[i - 1], guide[i])});
    const auto found =
        collision::detect_collisions({collision::Obstacles(scene.index), scene.body, detect}, path,
                                     0.0, 1.0, base::Deadline::never());
    if (!found || !found->empty()) return false;
  }
  return true;
}

inline bool same(const Guide& a, const Guide& b) {
  return std::ranges::equal(a, b, [](const SignedPose& p, const SignedPose& q) {
    return p.position == q.position && p.orientation == q.orientation;
  });
}

}  // namespace camway::correction::testing_search
