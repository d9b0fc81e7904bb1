// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/object_mesh.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace camway::wire {
namespace {

ObjectMesh tetrahedron() {
  ObjectMesh mesh;
  mesh.surface_error_m = 0.25;
  mesh.vertices_m = {{0.0, 0.0, 0.0}, {1.0 / 3.0, 0.0, 0.0}, {0.0, 1e-300, 0.0}, {0.0, 0.0, -7.0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  mesh.parts = {{"base", 1}, {"", 0}, {"sides", 3}};
  return mesh;
}

TEST(ObjectMeshTest, ComesBackBitForBit) {
  const ObjectMesh mesh = tetrahedron();
  const auto back = decode_mesh(encode_mesh(mesh));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->vertices_m, mesh.vertices_m);
  EXPECT_EQ(back->triangles, mesh.triangles);
  EXPECT_EQ(back->surface_error_m, mesh.surface_error_m);
  EXPECT_EQ(back->has_inside, mesh.has_inside);
  ASSERT_EQ(back->parts.size(), mesh.parts.size());
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    EXPECT_EQ(back->parts[i].name, mesh.parts[i].name);
    EXPECT_EQ(back->parts[i].triangles, mesh.parts[i].triangles);
  }
}

TEST(ObjectMeshTest, EveryCutAndEveryAdditionIsRefused) {
  std::vector<std::uint8_t> bytes = encode_mesh(tetrahedron());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_mesh(std::span(bytes).first(size))) << size;
  bytes.push_back(0);
  EXPECT_FALSE(decode_mesh(bytes));
}

TEST(ObjectMeshTest, CountsThatTheBytesDoNotHaveAreRefused) {
  constexpr std::size_t kMark = 8;
  for (std::size_t number = 0; number < 4; ++number) {
    for (const std::uint64_t count :
         {std::uint64_t{5}, std::uint64_t{1} << 61, std::numeric_limits<std::uint64_t>::max()}) {
      std::vector<std::uint8_t> bytes = encode_mesh(tetrahedron());
      std::memcpy(bytes.data() + kMark + number * sizeof count, &count, sizeof count);
      EXPECT_FALSE(decode_mesh(bytes)) << number << " " << count;
    }
  }
}

TEST(ObjectMeshTest, WhatIsNoMeshIsRefused) {
  const auto refused = [](auto&& change) {
    ObjectMesh mesh = tetrahedron();
    change(mesh);
    return !decode_mesh(encode_mesh(mesh));
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused([](ObjectMesh& mesh) { mesh.triangles[3][2] = 4; }));
  EXPECT_TRUE(refused([](ObjectMesh& mesh) { mesh.vertices_m[3][2] = kNan; }));
  EXPECT_TRUE(refused([](ObjectMesh& mesh) { mesh.surface_error_m = kNan; }));
  EXPECT_TRUE(refused([](ObjectMesh& mesh) { mesh.surface_error_m = -1.0; }));
  EXPECT_TRUE(refused([](ObjectMesh& mesh) { mesh.parts[0].triangles = 2; }));
  EXPECT_TRUE(refused([](ObjectMesh& mesh) { mesh.parts.clear(); }));
  EXPECT_FALSE(refused([](ObjectMesh& mesh) { mesh.has_inside = true; }));
}

}  // namespace
}  // namespace camway::wire
