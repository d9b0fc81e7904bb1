// SPDX-License-Identifier: MIT
#include "daemon/motion/body/closed_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/body_meshes.h"
#include "tests/support/random.h"

namespace camway::motion {
namespace {

using geometry::Vec3;
using ::testing::HasSubstr;

MeshShape tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

TEST(ClosedMesh, AcceptsClosedSurfacesOfAnyOrder) {
  EXPECT_FALSE(fault_of_surface(tetrahedron()));
  MeshShape mesh = testing::torus(1.0, 0.3, 20, 10);
  EXPECT_FALSE(fault_of_surface(mesh));
  testing::Random random(77);
  std::ranges::shuffle(mesh.triangles, random);
  for (auto& t : mesh.triangles) std::ranges::rotate(t, t.begin() + random.integer(0, 2));
  EXPECT_FALSE(fault_of_surface(mesh));
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(fault_of_surface(mesh)) << "inside out";
}

// As STL files have them: each triangle has vertices of its own.
TEST(ClosedMesh, JoinsVerticesAtTheSamePlace) {
  const MeshShape mesh = testing::torus(1.0, 0.3, 20, 10);
  MeshShape apart;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(apart.vertices_C.size());
    for (const std::uint32_t v : t) apart.vertices_C.push_back(mesh.vertices_C[v]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  apart.triangles.push_back({0, 1, 1});  // of no area: does not count
  EXPECT_FALSE(fault_of_surface(apart));
  EXPECT_EQ(connected_parts(apart).size(), 1U);
}

TEST(ClosedMesh, NamesTheEdgeThatIsWrong) {
  MeshShape open = tetrahedron();
  open.triangles.pop_back();
  EXPECT_THAT(
      fault_of_surface(open).value_or(""),
      HasSubstr(
          "the edge between vertices 0 and 2, from [0, 0, 0] to [0, 1, 0], has one triangle"));
  MeshShape turned = tetrahedron();
  std::swap(turned.triangles[2][0], turned.triangles[2][1]);
  EXPECT_THAT(fault_of_surface(turned).value_or(""),
              HasSubstr("the edge between vertices 1 and 2, from [1, 0, 0] to [0, 1, 0], has two "
                        "triangles that run through it in "
                        "the same direction"));
  MeshShape fin = tetrahedron();
  fin.vertices_C.emplace_back(1, 1, 1);
  fin.triangles.push_back({0, 1, 4});
  EXPECT_THAT(
      fault_of_surface(fin).value_or(""),
      HasSubstr("the edge between vertices 0 and 1, from [0, 0, 0] to [1, 0, 0], has 3 triangles"));
  EXPECT_TRUE(fault_of_surface({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}, true}));
}

TEST(ClosedMesh, FaultsOfSolidsNameTheirField) {
  MeshShape open = tetrahedron();
  open.triangles.pop_back();
  EXPECT_TRUE(Body::make(open)) << "a surface need not be closed";
  open.solid = true;
  const std::optional<ShapeFault> fault = fault_in(open);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->field, "triangles");
  EXPECT_THAT(fault->reason, HasSubstr("no closed surface: the edge between vertices 0 and 2"));
  MeshShape closed = tetrahedron();
  closed.solid = true;
  const base::Result<Body> body = Body::make(closed);
  ASSERT_TRUE(body) << body.error;
  EXPECT_TRUE(body->is_solid_mesh());
  EXPECT_NE(body->tree(), nullptr);
}

TEST(ClosedMesh, HasATriangleOfEachConnectedPart) {
  MeshShape mesh = testing::torus(1.0, 0.3, 20, 10);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  const auto first = static_cast<std::uint32_t>(mesh.vertices_C.size());
  const MeshShape other = testing::torus(1.0, 0.3, 20, 10, {5, 0, 0});
  mesh.vertices_C.insert(mesh.vertices_C.end(), other.vertices_C.begin(), other.vertices_C.end());
  for (const auto& t : other.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  EXPECT_THAT(connected_parts(mesh), ::testing::ElementsAre(0U, count));
  EXPECT_EQ(Body::make(mesh)->connected_parts().size(), 2U);
}

TEST(ClosedMesh, LimitsAreThoseOfLargeBodies) {
  const MeshShape most = testing::torus(1.0, 0.3, 500, 100);
  ASSERT_EQ(most.triangles.size(), kMaxBodyTriangles);
  EXPECT_TRUE(Body::make(most));
  EXPECT_THAT(fault_in(testing::torus(1.0, 0.3, 501, 100))->reason,
              HasSubstr("100000 are allowed"));
}

}  // namespace
}  // namespace camway::motion
