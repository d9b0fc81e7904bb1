// SPDX-License-Identifier: MIT
#include "tools/view/display/display_glb.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/support/random.h"
#include "tools/view/display/display_mesh.h"

namespace camway::view {
namespace {

using geometry::Vec3;
using nlohmann::json;

constexpr std::size_t kEveryTriangle = 100'000'000;

/// A `.glb` as the specifications of glTF and of its extensions have it, read apart from the
/// product.
struct Glb {
  json root;
  std::string buffer;
};

std::uint32_t number_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.substr(offset, sizeof number).data(), sizeof number);
  return number;
}

Glb parse(const std::string& file) {
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(number_at(file, 4), 2);
  EXPECT_EQ(number_at(file, 8), file.size());
  EXPECT_EQ(file.size() % 4, 0);
  const std::uint32_t length = number_at(file, 12);
  EXPECT_EQ(file.substr(16, 4), "JSON");
  Glb glb{json::parse(file.substr(20, length)), {}};
  const std::size_t next = 20 + length;
  if (next == file.size()) return glb;
  EXPECT_EQ(file.substr(next + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(number_at(file, next), file.size() - next - 8);
  glb.buffer = file.substr(next + 8);
  return glb;
}

/// Decompresses a view of the buffer.
std::vector<unsigned char> content(const Glb& glb, std::size_t view) {
  const json& outer = glb.root["bufferViews"][view];
  const json& inner = outer["extensions"]["EXT_meshopt_compression"];
  const auto count = inner["count"].get<std::size_t>();
  const auto stride = inner["byteStride"].get<std::size_t>();
  EXPECT_EQ(outer["byteLength"], count * stride);
  const std::string packed = glb.buffer.substr(inner["byteOffset"], inner["byteLength"]);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(packed.data());
  std::vector<unsigned char> result(count * stride);
  const int fault =
      inner["mode"] == "TRIANGLES"
          ? meshopt_decodeIndexBuffer(result.data(), count, stride, bytes, packed.size())
          : meshopt_decodeVertexBuffer(result.data(), count, stride, bytes, packed.size());
  EXPECT_EQ(fault, 0);
  return result;
}

template <class Number>
std::vector<double> numbers_of(const std::vector<unsigned char>& bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return {numbers.begin(), numbers.end()};
}

/// The triangles in the file, in the frame of the object.
std::vector<geometry::Triangle> triangles_in(const Glb& glb) {
  const json& accessor = glb.root["accessors"][0];
  const bool is_short = accessor["componentType"] == 5122;
  const std::vector<double> positions =
      is_short ? numbers_of<std::int16_t>(content(glb, 0)) : numbers_of<float>(content(glb, 0));
  const std::size_t stride = is_short ? 4 : 3;
  const double unit = is_short ? 32767.0 : 1.0;
  EXPECT_EQ(accessor.value("normalized", false), is_short);
  const std::vector<double> indices = glb.root["accessors"][1]["componentType"] == 5123
                                          ? numbers_of<std::uint16_t>(content(glb, 1))
                                          : numbers_of<std::uint32_t>(content(glb, 1));
  const json& node = glb.root["nodes"][0];
  std::vector<geometry::Triangle> triangles(indices.size() / 3);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    Vec3& corner = triangles[i / 3].at(i % 3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = positions.at(stride * static_cast<std::size_t>(indices[i]) + axis) / unit;
      corner[static_cast<Eigen::Index>(axis)] =
          node["translation"][axis].get<double>() + node["scale"][axis].get<double>() * x;
    }
  }
  return triangles;
}

/// The file has the triangles that `display_mesh` makes, which other tests hold against the mesh.
void expect_has_display_mesh(const scene::Mesh& mesh, std::size_t most, const Glb& glb) {
  const DisplayMesh display = display_mesh(mesh, most);
  const std::vector<geometry::Triangle> triangles = triangles_in(glb);
  ASSERT_EQ(triangles.size(), display.shown());
  const json& extras = glb.root["asset"]["extras"];
  EXPECT_EQ(extras["triangles"], mesh.triangles.size());
  EXPECT_EQ(extras["shown"], display.shown());
  EXPECT_EQ(extras["simplified"], display.is_simplified);
  EXPECT_EQ(extras["error_m"], display.error_m);
  const double rounding_m = 1e-9 * display.step_m + 1e-12 * display.centre_O.norm();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    // The compression may begin a triangle at another corner.
    bool is_same = false;
    for (std::size_t first = 0; first < 3; ++first) {
      bool fits = true;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto& point = display.vertices[display.indices[3 * i + (corner + first) % 3]];
        const Vec3 expected =
            display.centre_O + display.step_m * Vec3(point[0], point[1], point[2]);
        fits = fits && (triangles[i].at(corner) - expected).norm() <= rounding_m;
      }
      is_same = is_same || fits;
    }
    ASSERT_TRUE(is_same) << "triangle " << i;
  }
}

TEST(DisplayGlb, HoldsTheTrianglesOfEverySize) {
  testing::Random random(2111);
  for (const double size_m : {0.001, 0.5, 30.0, 37.0, 38.0, 200.0, 1e4, 1e7}) {
    scene::Mesh mesh;
    for (std::uint32_t i = 0; i < 300; ++i) {
      mesh.vertices.push_back(Vec3(7, 8, 9) + random.in_cube(size_m));
    }
    for (std::uint32_t i = 0; i + 2 < 300; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
    const Glb glb = parse(mesh_glb(mesh, kEveryTriangle));
    EXPECT_EQ(glb.root["accessors"][0]["componentType"], size_m < 37.5 ? 5122 : 5126) << size_m;
    expect_has_display_mesh(mesh, kEveryTriangle, glb);
    if (HasFailure()) FAIL() << size_m;
  }
}

TEST(DisplayGlb, HoldsLargeAndSimplifiedMeshes) {
  const base::Result<scene::Mesh> ball = scene::sphere_mesh(3.0, 1e-4);
  ASSERT_TRUE(ball) << ball.error;
  ASSERT_GT(ball->vertices.size(), 70'000);
  const Glb whole = parse(mesh_glb(*ball, kEveryTriangle));
  EXPECT_EQ(whole.root["accessors"][1]["componentType"], 5125);
  expect_has_display_mesh(*ball, kEveryTriangle, whole);
  const Glb less = parse(mesh_glb(*ball, 5000));
  EXPECT_EQ(less.root["accessors"][1]["componentType"], 5123);
  expect_has_display_mesh(*ball, 5000, less);
}

TEST(DisplayGlb, OfNothingHasNoMesh) {
  const Glb glb = parse(mesh_glb({}, kEveryTriangle));
  EXPECT_TRUE(glb.buffer.empty());
  EXPECT_FALSE(glb.root["nodes"][0].contains("mesh"));
  EXPECT_FALSE(glb.root.contains("extensionsRequired"));
  EXPECT_EQ(glb.root["asset"]["extras"]["shown"], 0);
}

TEST(DisplayGlb, TheOfficeTakesLessThan100Kilobytes) {
  const auto office =
      scene::load_snapshot("office", std::string(CAMWAY_SCENES_FOLDER) + "/office.obj").snapshot;
  ASSERT_TRUE(office);
  std::size_t bytes = 0;
  for (const auto& object : office->objects) {
    const scene::Mesh mesh = scene::joined(object->source->parts_O);
    const std::string glb = mesh_glb(mesh, triangles_to_show(29'544, 29'544));
    EXPECT_FALSE(parse(glb).root["asset"]["extras"]["simplified"]);
    bytes += glb.size();
  }
  RecordProperty("bytes", static_cast<int>(bytes));
  EXPECT_LT(bytes, 100'000);
}

TEST(DisplayGlb, SharesTheTrianglesOfAScene) {
  EXPECT_EQ(triangles_to_show(0, 0), 0);
  EXPECT_EQ(triangles_to_show(kShownTriangles, kShownTriangles), kShownTriangles);
  EXPECT_EQ(triangles_to_show(7, kShownTriangles), 7);
  testing::Random random(2112);
  for (int round = 0; round < 1000; ++round) {
    const auto scene = static_cast<std::int64_t>(
        random.log_uniform(static_cast<double>(kShownTriangles) + 1.0, 1e9));
    std::int64_t left = scene;
    std::size_t shown = 0;
    while (left > 0) {
      const std::int64_t object =
          std::min(left, static_cast<std::int64_t>(random.log_uniform(1e4, 1e9)));
      shown += triangles_to_show(object, scene);
      left -= object;
    }
    ASSERT_LE(shown, static_cast<std::size_t>(kShownTriangles)) << scene;
    ASSERT_GE(shown, static_cast<std::size_t>(kShownTriangles) * 8 / 10) << scene;
  }
}

TEST(DisplayGlb, ASmallChangeOfTheSceneMostlyChangesNoShare) {
  int changes = 0;
  for (std::int64_t scene = 1'000'000; scene < 2'000'000; scene += 1000) {
    if (triangles_to_show(100'000, scene) != triangles_to_show(100'000, scene + 1000)) ++changes;
  }
  EXPECT_EQ(changes, 4);
}

}  // namespace
}  // namespace camway::view
