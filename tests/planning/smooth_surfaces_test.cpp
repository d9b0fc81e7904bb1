// SPDX-License-Identifier: MIT
//
// Triangles that stand for smooth surfaces: what is proved holds for the surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/deadline.h"
#include "daemon/motion/body/camera.h"
#include "daemon/planning/plan.h"
#include "daemon/planning/watched_path.h"
#include "daemon/scene/import/surfaces/quadrics.h"
#include "daemon/scene/snapshot/scene_difference.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/watched_scenes.h"

namespace camway::planning {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;

constexpr double kSphere_m = 1.0;
/// Cells of the grid are 8 mm large: 4 mm beside a point of the sphere are 8e-6 m off it.
constexpr double kGrid_m = 2e-5;

using Source = std::shared_ptr<const scene::ObjectSource>;

/// A sphere of `kSphere_m` around the origin of its object.
Source sphere_source(double surface_error_m) {
  const scene::surfaces::FacetedSurface facets = scene::surfaces::sphere(kSphere_m);
  scene::Mesh mesh;
  for (const scene::surfaces::Point& point : facets.points) {
    mesh.vertices.emplace_back(point[0], point[1], point[2]);
  }
  mesh.triangles = facets.triangles;
  mesh.objects = {{"sphere", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  scene::ImportReport report = scene::report_of(mesh, "test");
  report.surface_error_m = surface_error_m;
  return scene::make_source(scene::ObjectKind::kMesh, std::move(mesh), report, {});
}

double error_of_facets() { return scene::surfaces::sphere(kSphere_m).error; }

struct Placed {
  std::string name;
  Source source;
  Vec3 position = Vec3::Zero();
};

std::shared_ptr<const scene::Snapshot> scene_of(const std::vector<Placed>& all) {
  scene::SceneObjects objects;
  for (const Placed& each : all) {
    objects.push_back(
        scene::place_object(each.name, each.source, testing::at(each.position), {}).object);
  }
  return scene::assemble("test", 1, std::move(objects), {});
}

/// A camera that moves straight past the origin without turning.
struct Pass {
  Vec3 aside;  ///< unit vector from the origin towards the middle of the path
  Vec3 along;  ///< unit vector of the motion
  Quat orientation;

  static Pass random(testing::Random& random) {
    const Quat turn = random.rotation();
    return {turn * Vec3::UnitX(), turn * Vec3::UnitY(), random.rotation()};
  }

  [[nodiscard]] PlanRequest request(double eye_m) const {
    PlanRequest request;
    request.scene = "test";
    request.camera = testing::small_camera();
    request.has_times = true;
    request.options.max_inserted_keyframes = 0;
    for (const double side : {-2.0, 2.0}) {
      request.keyframes.push_back({side, {eye_m * aside + side * along, orientation}});
    }
    return request;
  }

  /// The least distance from the origin that a point of the near quadrilateral has while it passes,
  /// by points of a grid on it: at most `kGrid_m` too large.
  [[nodiscard]] double least_m(double eye_m) const {
    constexpr int kSteps = 24;
    const motion::Corners corners = motion::near_corners_C(testing::small_camera());
    double least_m = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kSteps; ++i) {
      for (int k = 0; k <= kSteps; ++k) {
        const double u = static_cast<double>(i) / kSteps;
        const double v = static_cast<double>(k) / kSteps;
        const Vec3 at = orientation * (corners[0] + u * (corners[1] - corners[0]) +
                                       v * (corners[3] - corners[0]));
        const Vec3 point = eye_m * aside + at;
        least_m = std::min(least_m, (point - point.dot(along) * along).norm());
      }
    }
    return least_m;
  }

  /// Returns how far from the origin the eye passes if the near quadrilateral comes that near to
  /// it.
  [[nodiscard]] double eye_for(double wanted_m) const {
    double low_m = wanted_m;
    double high_m = wanted_m + 1.0;
    for (int i = 0; i < 20; ++i) {
      const double middle_m = 0.5 * (low_m + high_m);
      (least_m(middle_m) < wanted_m ? low_m : high_m) = middle_m;
    }
    return high_m;
  }
};

TEST(SmoothSurfaces, WhatIsProvedHoldsForTheSphereThatTheFacetsStandFor) {
  testing::Random random(20261126);
  const double error_m = error_of_facets();
  const auto known = scene_of({{"sphere", sphere_source(error_m)}});
  const auto unknown = scene_of({{"sphere", sphere_source(0.0)}});
  int proved = 0;
  int only_facets = 0;
  for (int round = 0; round < 50; ++round) {
    const Pass pass = Pass::random(random);
    const double eye_m = pass.eye_for(kSphere_m + random.uniform(-1.0, 3.0) * error_m);
    const double sphere_m = pass.least_m(eye_m) - kSphere_m;
    const PlanRequest request = pass.request(eye_m);
    const PlanResult result = plan(*known, request, Deadline::never());
    if (result.certificate.certified) {
      ++proved;
      EXPECT_GE(sphere_m + kGrid_m, result.certificate.clearance_lower_bound_m) << round;
    } else {
      // The facets are within the error of the sphere, and the error is kept from them.
      EXPECT_LE(sphere_m, 2.0 * error_m + request.options.interval_tolerance_m) << round;
    }
    const bool is_free_of_facets = plan(*unknown, request, Deadline::never()).certificate.certified;
    if (is_free_of_facets && sphere_m < 0.0) ++only_facets;
  }
  EXPECT_GT(proved, 10);
  EXPECT_GT(only_facets, 2) << "the facets alone prove what does not hold";
}

TEST(SmoothSurfaces, AKeyframeWithinTheErrorIsRefusedInWords) {
  const double error_m = 0.05;
  const auto snapshot = scene_of({{"sphere", sphere_source(error_m)}});
  testing::Random random(5);
  const Pass pass = Pass::random(random);
  PlanRequest request = pass.request(pass.eye_for(kSphere_m + 0.6 * error_m));
  request.keyframes[0].pose.position = request.keyframes[1].pose.position;
  request.keyframes[1].pose.position -= 2.0 * pass.along;
  const PlanResult result = plan(*snapshot, request, Deadline::never());
  EXPECT_EQ(result.status, Status::kInvalid);
  EXPECT_NE(result.message.find("keyframes[1]: the near quadrilateral is nearer to the scene than "
                                "the 0.05 m of error of its smooth surfaces there, by about"),
            std::string::npos)
      << result.message;
}

TEST(SmoothSurfaces, TheDigestOfASceneKnowsTheirError) {
  const auto exact = scene_of({{"sphere", sphere_source(0.0)}});
  const auto fine = scene_of({{"sphere", sphere_source(1e-3)}});
  EXPECT_NE(exact->digest, fine->digest);
  EXPECT_NE(fine->digest, scene_of({{"sphere", sphere_source(2e-3)}})->digest);
  EXPECT_EQ(fine->digest, scene_of({{"sphere", sphere_source(1e-3)}})->digest);
}

TEST(SmoothSurfaces, AWatchedPathIsLostOnlyToWhatComesWithinTheError) {
  testing::Random random(6);
  const Pass pass = Pass::random(random);
  const double error_m = 0.05;
  const Placed far{"far", sphere_source(error_m), 100.0 * pass.aside};
  const auto before = scene_of({far});
  const double eye_m = pass.eye_for(kSphere_m + 0.03);
  const PlanRequest request = pass.request(eye_m);
  const auto watched = WatchedPath::of(request, plan(*before, request, Deadline::never()));
  ASSERT_TRUE(watched);
  const auto stays_free_with = [&](const Placed& added) {
    const scene::SceneDifference change = scene::difference(*before, *scene_of({added, far}));
    return !watched->may_meet(change) || watched->stays_free(change, Deadline::never());
  };
  // 3 cm off the sphere, in a scene that is known within 5 cm.
  EXPECT_FALSE(stays_free_with({"added", sphere_source(0.0)}));
  EXPECT_TRUE(stays_free_with({"added", sphere_source(0.0), -0.05 * pass.aside}));
  // A coarser surface elsewhere counts everywhere.
  EXPECT_FALSE(stays_free_with({"added", sphere_source(0.06), -50.0 * pass.aside}));
  EXPECT_TRUE(stays_free_with({"added", sphere_source(error_m), -50.0 * pass.aside}));
}

}  // namespace
}  // namespace camway::planning
