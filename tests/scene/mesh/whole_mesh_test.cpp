// SPDX-License-Identifier: MIT
#include "daemon/scene/mesh/whole_mesh.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/scene/test_meshes.h"

namespace camway::scene {
namespace {

using geometry::Triangle;
using geometry::Vec3;

Triangle triangle_at(double x) { return {Vec3(x, 0, 0), Vec3(x, 1, 0), Vec3(x, 0, 1)}; }

std::shared_ptr<const Mesh> mesh_with(const std::vector<Triangle>& triangles,
                                      std::vector<MeshObject> objects) {
  Mesh mesh = mesh_of_triangles(triangles);
  mesh.objects = std::move(objects);
  return std::make_shared<const Mesh>(std::move(mesh));
}

WholeMesh of_three() {
  return WholeMesh({{"house",
                     {mesh_with({triangle_at(0), triangle_at(1), triangle_at(2)},
                                {{"sofa", 0, 1}, {"none", 1, 0}, {"", 1, 2}})}},
                    {"nothing", {mesh_with({}, {})}},
                    {"table", {mesh_with({triangle_at(3)}, {{"top", 0, 1}})}}});
}

TEST(WholeMesh, IsItsOnlyMeshItself) {
  const auto mesh = mesh_with({triangle_at(0)}, {{"sofa", 0, 1}});
  const WholeMesh whole(mesh);
  EXPECT_EQ(whole.share(), mesh);
  EXPECT_EQ(whole.object_name(0), "sofa");
  EXPECT_EQ(whole.object_name(1), "");
  EXPECT_TRUE(WholeMesh()->triangles.empty());
}

TEST(WholeMesh, NumbersTrianglesThrough) {
  const WholeMesh whole = of_three();
  ASSERT_EQ(whole->triangles.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(whole->triangle(i), triangle_at(static_cast<double>(i))) << i;
  }
  EXPECT_EQ(whole.share(), WholeMesh(whole).share()) << "copies share the mesh";
}

TEST(WholeMesh, NamesObjectsByPartAndThemselves) {
  const std::vector<std::string> expected{"house/sofa", "house", "house", "table", ""};
  const WholeMesh whole = of_three();
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(whole.object_name(i), expected[i]) << i;
    for (const MeshObject& object : whole->objects) {
      if (i >= object.first_triangle && i < object.first_triangle + object.triangle_count) {
        EXPECT_EQ(object.name, expected[i]) << i;
      }
    }
  }
}

TEST(WholeMesh, IsPutTogetherOnceWhoeverAsks) {
  const WholeMesh whole = of_three();
  std::vector<const Mesh*> seen(4);
  {
    std::vector<std::jthread> threads;
    for (const Mesh*& each : seen) threads.emplace_back([&] { each = &*whole; });
  }
  for (const Mesh* each : seen) EXPECT_EQ(each, &*whole);
}

}  // namespace
}  // namespace camway::scene
