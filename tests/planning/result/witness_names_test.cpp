// SPDX-License-Identifier: MIT
#include "daemon/planning/result/witness_names.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

scene::WholeMesh three_objects() {
  scene::Mesh mesh;
  for (const char* name : {"table", "nothing", "lamp", ""}) {
    const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
    const bool is_empty = std::string_view(name) == "nothing";
    if (!is_empty) testing::add_cuboid(mesh, geometry::Vec3::Zero(), geometry::Vec3::Ones());
    mesh.objects.push_back({name, first, is_empty ? 0U : 12U});
  }
  return std::make_shared<const scene::Mesh>(std::move(mesh));
}

TEST(DescribeWitness, NamesTheObjectOfATriangleAndTheFeature) {
  const scene::WholeMesh mesh = three_objects();
  const motion::Body body(testing::small_camera());
  const auto described = [&](std::uint32_t triangle, std::uint32_t feature) {
    return describe_witness(mesh, body, {.triangle = triangle, .feature = feature});
  };
  EXPECT_EQ(described(0, 0), (WitnessNames{"table", "inside"}));
  EXPECT_EQ(described(11, 1), (WitnessNames{"table", "edge 0"}));
  EXPECT_EQ(described(12, 8), (WitnessNames{"lamp", "corner 3"}));
  EXPECT_EQ(described(23, 0).object, "lamp");
  EXPECT_EQ(described(24, 0).object, "");
  EXPECT_EQ(described(4000, 0).object, "") << "of another scene";
}

TEST(DescribeWitness, LeavesNamesEmptyWhereThereIsNoWitness) {
  const scene::WholeMesh mesh = three_objects();
  PlanRequest request;
  request.camera = testing::small_camera();
  PlanResult result;
  result.collisions = {{0.0, 1.0}, {2.0, 3.0, collision::Witness{.triangle = 13, .feature = 2}}};
  result.remaining_collisions = {{4.0, 5.0, collision::Witness{}}};
  name_witnesses(mesh, request, result);
  EXPECT_EQ(result.collision_names, (std::vector<WitnessNames>{{"", ""}, {"lamp", "edge 1"}}));
  EXPECT_EQ(result.remaining_names, (std::vector<WitnessNames>{{"table", "inside"}}));
}

// A separate function without assignment: GCC 12 warns of the variant in the empty optional, which
// neither assignment nor destruction reads.
[[gnu::noinline]] PlanRequest request_with_box() {
  PlanRequest request;
  request.body.emplace(motion::BoxShape{geometry::Vec3::Zero(), {1, 1, 1}});
  return request;
}

TEST(DescribeWitness, NamesFeaturesOfTheBodyThatMoved) {
  const PlanRequest with_box = request_with_box();
  PlanResult result;
  result.remaining_collisions = {{0.0, 1.0, collision::Witness{.triangle = 12, .feature = 7}}};
  name_witnesses(three_objects(), with_box, result);
  const std::vector<WitnessNames> expected{{"lamp", "face 7"}};
  EXPECT_EQ(result.remaining_names, expected);
  PlanRequest with_camera;
  with_camera.camera = testing::small_camera();
  name_witnesses(three_objects(), with_camera, result);
  EXPECT_EQ(result.remaining_names, expected) << "named already";
}

}  // namespace
}  // namespace camway::planning
