// SPDX-License-Identifier: MIT
#include "daemon/scene/mirror/scene_mirror.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <sstream>

#include "daemon/scene/mesh/mesh.h"
#include "tests/geometry/random_triangles.h"
#include "tests/scene/voxels/voxel_oracle.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::RandomTriangles;
using geometry::Vec3;

constexpr double kMirrorResolution_m = 0.25;

std::shared_ptr<const ObjectMirror> map_of(const Mesh& mesh) {
  return ObjectMirror::build(mesh, kMirrorResolution_m).map;
}

/// Several meshes mirrored one by one, and as one mesh.
struct MirroredScene {
  explicit MirroredScene(std::uint64_t seed, int count) {
    testing::Random random(seed);
    Mesh whole;
    std::vector<std::shared_ptr<const ObjectMirror>> maps;
    for (int i = 0; i < count; ++i) {
      const Mesh mesh = oracle::random_mesh(random, kMirrorResolution_m, 4);
      const auto first = static_cast<std::uint32_t>(whole.vertices.size());
      whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      for (const auto& t : mesh.triangles) {
        whole.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      }
      maps.push_back(map_of(mesh));
    }
    one = map_of(whole);
    several = std::make_unique<SceneMirror>(kMirrorResolution_m, maps);
  }

  std::shared_ptr<const ObjectMirror> one;
  std::unique_ptr<SceneMirror> several;
};

TEST(SceneMirror, AnswersAsOneMapOfAllObjects) {
  RandomTriangles random(1301);
  int occupied = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const MirroredScene sample(seed, 1 + static_cast<int>(seed) % 5);
    for (int i = 0; i < 300; ++i) {
      const Vec3 point = random.in_cube(3.0);
      const Vec3 other = random.in_cube(3.0);
      const Box box(point.cwiseMin(other), point.cwiseMin(other) + random.in_cube(0.3).cwiseAbs());
      occupied += sample.one->occupied_at(point) ? 1 : 0;
      ASSERT_EQ(sample.several->occupied_at(point), sample.one->occupied_at(point));
      ASSERT_EQ(sample.several->occupied_in_box(box), sample.one->occupied_in_box(box));
      ASSERT_EQ(sample.several->occupied_in_sphere(point, 0.2),
                sample.one->occupied_in_sphere(point, 0.2));
      ASSERT_EQ(sample.several->ray_hit_m(point, other, 5.0),
                sample.one->ray_hit_m(point, other, 5.0));
      // Not the same bits: a box may be skipped that is cheaper by rounding only.
      const std::optional<double> way_m = sample.one->sphere_path_hit_m(point, other, 0.1);
      ASSERT_EQ(sample.several->sphere_path_hit_m(point, other, 0.1).has_value(), !!way_m);
      ASSERT_NEAR(sample.several->sphere_path_hit_m(point, other, 0.1).value_or(0.0),
                  way_m.value_or(0.0), 1e-12);
      ASSERT_EQ(sample.several->distance_m(point, 4.0), sample.one->distance_m(point, 4.0));
      ASSERT_EQ(sample.several->distance_m(point, 0.1), sample.one->distance_m(point, 0.1));
    }
  }
  EXPECT_GT(occupied, 20);
}

TEST(SceneMirror, WritesOneMapOfAllObjects) {
  for (std::uint64_t seed = 30; seed < 40; ++seed) {
    const MirroredScene sample(seed, 3);
    std::stringstream united;
    std::stringstream whole;
    sample.several->write_bt(united);
    SceneMirror(sample.one).write_bt(whole);
    ASSERT_EQ(united.str(), whole.str());
    octomap::OcTree read(1.0);
    ASSERT_TRUE(read.readBinary(united));
    EXPECT_EQ(read.getResolution(), kMirrorResolution_m);
  }
}

TEST(SceneMirror, OfNothingIsFree) {
  const SceneMirror none(kMirrorResolution_m, {});
  EXPECT_EQ(none.resolution_m(), kMirrorResolution_m);
  EXPECT_FALSE(none.occupied_at(Vec3::Zero()));
  EXPECT_FALSE(none.distance_m(Vec3::Zero(), 1e9));
  std::stringstream out;
  none.write_bt(out);
  EXPECT_NE(out.str(), "");
}

}  // namespace
}  // namespace camway::scene
