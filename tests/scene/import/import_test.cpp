// SPDX-License-Identifier: MIT
#include "daemon/scene/import/import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <thread>

#include "daemon/base/base64.h"
#include "daemon/scene/import/import_process.h"
#include "tests/support/collada_triangle.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using geometry::Triangle;
using geometry::Vec3;
using ::testing::HasSubstr;

class Import : public ::testing::Test {
 protected:
  Import() {
    const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) /
              ("camway_" + std::string(info->name()) + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  ~Import() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, std::string_view text) {
    const fs::path file = folder_ / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  /// Imports and expects success.
  ImportResult import_text(const std::string& name, std::string_view text,
                           const ImportOptions& options = {}) {
    ImportResult result = import_mesh(write(name, text), options);
    EXPECT_TRUE(result.mesh) << result.error;
    EXPECT_EQ(result.error, "");
    return result;
  }

  /// Imports and expects an error that names the file.
  std::string error_of(const fs::path& file, const ImportOptions& options = {}) {
    const ImportResult result = import_mesh(file, options);
    EXPECT_FALSE(result.mesh);
    EXPECT_THAT(result.error, HasSubstr(file.string()));
    return result.error;
  }

  fs::path folder_;
};

/// Sorts vertices, so that the vertex at which a format begins a triangle does not matter.
std::vector<std::array<double, 3>> sorted_vertices(const Mesh& mesh) {
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const Vec3& v : mesh.triangle(i)) points.push_back({v.x(), v.y(), v.z()});
  }
  std::sort(points.begin(), points.end());
  return points;
}

/// Expects the triangle (1,2,3) (4,2,3) (1,5,3), which is in every format below.
void expect_the_triangle(const ImportResult& result, const Vec3& shift = Vec3::Zero()) {
  ASSERT_TRUE(result.mesh);
  std::vector<std::array<double, 3>> expected = {{1, 2, 3}, {1, 5, 3}, {4, 2, 3}};
  for (auto& p : expected) {
    for (std::size_t k = 0; k < 3; ++k) p[k] += shift[static_cast<Eigen::Index>(k)];
  }
  EXPECT_EQ(sorted_vertices(*result.mesh), expected);
  EXPECT_EQ(result.report.triangles, 1U);
  EXPECT_EQ(result.report.vertices, 3U);
  EXPECT_EQ(result.report.objects, 1U);
  EXPECT_EQ(result.report.bounds_m.min(), Vec3(1, 2, 3) + shift);
  EXPECT_EQ(result.report.bounds_m.max(), Vec3(4, 5, 3) + shift);
}

constexpr std::string_view kObj = "o wedge\nv 1 2 3\nv 4 2 3\nv 1 5 3\nf 1 2 3\n";
constexpr std::string_view kOff = "OFF\n3 1 0\n1 2 3\n4 2 3\n1 5 3\n3 0 1 2\n";
constexpr std::string_view kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "1 2 3\n4 2 3\n1 5 3\n3 0 1 2\n";
constexpr std::string_view kStl =
    "solid wedge\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 2 3\nvertex 1 5 3\n"
    "endloop\nendfacet\nendsolid wedge\n";

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      text += padding ? '=' : kDigits[group >> (18 - 6 * k) & 63U];
    }
  }
  return text;
}

/// Returns one triangle with its positions in an embedded buffer, under a node that moves it by
/// (10, 0, 0).
std::string gltf(const std::array<float, 9>& positions) {
  const std::array<std::uint16_t, 3> indices = {0, 1, 2};
  std::vector<std::uint8_t> bytes(sizeof positions + sizeof indices);
  std::memcpy(bytes.data(), positions.data(), sizeof positions);
  std::memcpy(bytes.data() + sizeof positions, indices.data(), sizeof indices);
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"name":"shelf","mesh":0,"translation":[10,0,0]}],
    "meshes":[{"name":"board","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "accessors":[
      {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[9,9,9]},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},
                   {"buffer":0,"byteOffset":36,"byteLength":6}],
    "buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + R"("}]})";
}

/// Returns the triangle under two nested nodes that move it by (10, 0, 0) and (0, 20, 0).
std::string collada(std::string_view opening = "", std::string_view closing = "") {
  return testing::collada_triangle("1 2 3 4 2 3 1 5 3",
                                   testing::kColladaMetre, std::string(opening) + R"(
  <node id="outer" name="outer"><translate>10 0 0</translate>
   <node id="inner" name="inner"><translate>0 20 0</translate>
    <instance_geometry url="#g"/></node></node>)" + std::string(closing));
}

TEST_F(Import, ReadsObj) {
  const ImportResult result = import_text("a.obj", kObj);
  expect_the_triangle(result);
  EXPECT_THAT(result.mesh->objects[0].name, HasSubstr("wedge"));
  EXPECT_THAT(result.report.format, HasSubstr("Wavefront"));
}
TEST_F(Import, ReadsOff) { expect_the_triangle(import_text("a.off", kOff)); }
TEST_F(Import, ReadsPly) { expect_the_triangle(import_text("a.ply", kPly)); }
TEST_F(Import, ReadsStl) { expect_the_triangle(import_text("a.stl", kStl)); }

TEST_F(Import, ReadsGltfWithItsNodes) {
  const ImportResult result = import_text("a.gltf", gltf({1, 2, 3, 4, 2, 3, 1, 5, 3}));
  expect_the_triangle(result, Vec3(10, 0, 0));
  EXPECT_EQ(result.mesh->objects[0].name, "shelf/board");
}

TEST_F(Import, ReadsColladaWithItsNodes) {
  expect_the_triangle(import_text("a.dae", collada()), Vec3(10, 20, 0));
}

TEST_F(Import, CutsPolygonsToTriangles) {
  const ImportResult result =
      import_text("a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(result.report.triangles, 3U);
  double area = 0.0;
  for (std::size_t i = 0; i < result.mesh->triangles.size(); ++i) {
    const Triangle t = result.mesh->triangle(i);
    area += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
  }
  EXPECT_DOUBLE_EQ(area, 5.0);
}

TEST_F(Import, KeepsDecimalsFarFromTheOrigin) {
  // Floats are 6 cm apart here: a wall whose coordinate is exact, and a triangle of a centimetre.
  const std::string corners[] = {"1000000.03 0 0", "1000000.03 1 0", "1000000.03 0 1",
                                 "1000000.04 0 0"};
  std::string vertices;
  for (const std::string& corner : corners) vertices += corner + "\n";
  const std::string stl_wall = "facet\nvertex " + corners[0] + "\nvertex " + corners[1] +
                               "\nvertex " + corners[2] + "\nendfacet\n";
  const std::string stl_small = "facet\nvertex " + corners[0] + "\nvertex " + corners[3] +
                                "\nvertex 1000000.03 0.01 0\nendfacet\n";
  for (const auto& [name, text] : std::initializer_list<std::pair<const char*, std::string>>{
           {"a.obj", "v " + corners[0] + "\nv " + corners[1] + "\nv " + corners[2] + "\nv " +
                         corners[3] + "\nv 1000000.03 0.01 0\nf 1 2 3\nf 1 4 5\n"},
           {"a.off", "OFF\n5 2 0\n" + vertices + "1000000.03 0.01 0\n3 0 1 2\n3 0 3 4\n"},
           {"a.ply",
            "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double "
            "y\nproperty double z\nelement face 2\nproperty list uchar int "
            "vertex_indices\nend_header\n" +
                vertices + "1000000.03 0.01 0\n3 0 1 2\n3 0 3 4\n"},
           {"a.stl", "solid\n" + stl_wall + stl_small + "endsolid\n"}}) {
    SCOPED_TRACE(name);
    const ImportResult result = import_text(name, text);
    ASSERT_EQ(result.report.triangles, 2U);
    EXPECT_EQ(result.mesh->triangle(0)[1], Vec3(1000000.03, 1, 0));
    EXPECT_EQ(result.mesh->triangle(1)[1], Vec3(1000000.04, 0, 0));
    EXPECT_EQ(result.mesh->triangle(1)[2], Vec3(1000000.03, 0.01, 0));
    EXPECT_FALSE(result.report.single_precision);
    // Half a unit in the last place of a million is 0.6e-10.
    EXPECT_GT(result.report.rounding_m, 0.5e-10);
    EXPECT_LT(result.report.rounding_m, 2e-10);
  }
}

TEST_F(Import, BoundsTheRoundingOfScaleAndOfSinglePrecision) {
  EXPECT_EQ(import_text("a.obj", kObj, {.scale = 3.0}).report.rounding_m, 2.0 * 0x1p-53 * 15.0);
  EXPECT_EQ(import_text("a.stl", kStl).report.rounding_m, 0x1p-53 * 5.0);
  // A decimal that is no float, moved by numbers that are none either.
  std::string text = collada();
  text.replace(text.find("1 2 3 4 2 3"), 5, "1000000.03 2 3");
  text.replace(text.find("10 0 0"), 6, "10.1 0 0");
  const ImportResult result = import_text("a.dae", text);
  EXPECT_TRUE(result.report.single_precision);
  double off_m = 1e9;
  for (const Vec3& v : result.mesh->vertices) {
    off_m = std::min(off_m, (v - Vec3(1000000.03 + 10.1, 22, 3)).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(off_m, 1e-4) << "floats are 6 cm apart here";
  EXPECT_LE(off_m, result.report.rounding_m);
  EXPECT_LT(result.report.rounding_m, 5.0);
}

TEST_F(Import, ScalesAndTurnsOnlyWhenAsked) {
  const ImportResult as_is = import_text("a.obj", kObj);
  EXPECT_EQ(as_is.report.scale, 1.0);
  EXPECT_EQ(as_is.report.up, UpAxis::kAsInFile);
  const ImportResult z_to_y = import_text("a.obj", kObj, {.scale = 2.0, .up = UpAxis::kZToY});
  EXPECT_EQ(z_to_y.mesh->triangle(0)[0], Vec3(2, 6, -4));
  EXPECT_EQ(z_to_y.report.scale, 2.0);
  EXPECT_EQ(z_to_y.report.up, UpAxis::kZToY);
  const ImportResult y_to_z = import_text("a.obj", kObj, {.up = UpAxis::kYToZ});
  EXPECT_EQ(y_to_z.mesh->triangle(0)[0], Vec3(1, -3, 2));
}

TEST_F(Import, KeepsObjectsApartAndInOrder) {
  const ImportResult result = import_text("a.obj",
                                          "o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no two\nv 0 0 "
                                          "5\nv 1 0 5\nv 0 1 5\nf 4 5 6\nf 6 5 4\n");
  ASSERT_EQ(result.mesh->objects.size(), 2U);
  EXPECT_THAT(result.mesh->objects[0].name, HasSubstr("one"));
  EXPECT_EQ(result.mesh->objects[0].first_triangle, 0U);
  EXPECT_EQ(result.mesh->objects[0].triangle_count, 1U);
  EXPECT_THAT(result.mesh->objects[1].name, HasSubstr("two"));
  EXPECT_EQ(result.mesh->objects[1].first_triangle, 1U);
  EXPECT_EQ(result.mesh->objects[1].triangle_count, 2U);
}

TEST_F(Import, DropsTrianglesWithoutAreaAndCountsThem) {
  const ImportResult result = import_text(
      "a.obj",
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 3 0 0\nv 1 1e-30 0\nf 1 2 3\nf 1 2 4\nf 2 2 3\nf 1 2 5\n");
  // A triangle with an area stays, however thin it is.
  EXPECT_EQ(result.report.triangles, 2U);
  EXPECT_EQ(result.report.degenerate_triangles, 2U);
}

TEST_F(Import, DropsPointsAndLinesAndCountsThem) {
  const ImportResult result =
      import_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\nl 2 3\n");
  EXPECT_EQ(result.report.triangles, 1U);
  EXPECT_EQ(result.report.dropped_points_and_lines, 2U);
}

TEST_F(Import, DropsNonFiniteTrianglesAndCountsThem) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  for (const float bad : {kNaN, kInfinite, -kInfinite}) {
    const ImportResult result =
        import_mesh(write("a.gltf", gltf({1, 2, bad, 4, 2, 3, 1, 5, 3})), {});
    EXPECT_FALSE(result.mesh);
    EXPECT_EQ(result.report.dropped_nonfinite, 1U) << result.error;
    EXPECT_THAT(result.error, HasSubstr("no triangle"));
  }
}

TEST_F(Import, CountsFacesThatNameAVertexThatDoesNotExist) {
  const std::string ply(kPly);
  const std::string counted = ply.substr(0, ply.find("face 1")) + "face 2" +
                              ply.substr(ply.find("face 1") + 6) + "3 0 1 99999999\n";
  for (const auto& [name, text] : std::initializer_list<std::pair<const char*, std::string>>{
           {"a.off", "OFF\n3 2 0\n1 2 3\n4 2 3\n1 5 3\n3 0 1 2\n3 0 1 99999999\n"},
           {"b.off", "OFF\n3 2 0\n1 2 3\n4 2 3\n1 5 3\n3 0 1 2\n4 0 1 2 -1\n"},
           {"a.obj", std::string(kObj) + "f 1 2 4\n"},
           {"b.obj", std::string(kObj) + "f 1 2 -4\n"},
           {"c.obj", std::string(kObj) + "f 0 2 3 1\n"},
           {"a.ply", counted}}) {
    SCOPED_TRACE(name);
    const ImportResult result = import_text(name, text);
    expect_the_triangle(result);
    EXPECT_EQ(result.report.dropped_bad_index, 1U);
  }
}

TEST_F(Import, NamesWhatIsWrongWithAFileBeforeReadingIt) {
  EXPECT_THAT(error_of(folder_ / "none.obj"), HasSubstr("no such file"));
  EXPECT_THAT(error_of(folder_), HasSubstr("is a directory"));
  EXPECT_THAT(error_of(write("empty.obj", "")), HasSubstr("is empty"));
  EXPECT_THAT(error_of("/dev/null"), HasSubstr("not a regular file"));
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(error_of(write("a.obj", kObj), {.scale = scale}), HasSubstr("scale"));
  }
}

TEST_F(Import, RefusesATypeThatNothingReads) {
  EXPECT_THAT(error_of(write("a.jt", "Version 9.5 JT\n")), HasSubstr(".jt"));
  EXPECT_THAT(error_of(write("a", "nothing")), HasSubstr("supported"));
}

TEST_F(Import, RefusesATruncatedFile) {
  error_of(write("a.gltf", gltf({1, 2, 3, 4, 2, 3, 1, 5, 3}).substr(0, 300)));
  error_of(write("a.dae", collada().substr(0, 900)));
  error_of(write("a.ply", kPly.substr(0, kPly.size() - 15)));
  error_of(write("a.off", kOff.substr(0, 12)));
}

TEST_F(Import, RefusesGarbageOfEveryType) {
  std::string garbage;
  std::uint32_t state = 12345;
  for (int i = 0; i < 4000; ++i) {
    state = state * 1664525U + 1013904223U;
    garbage += static_cast<char>(state >> 24);
  }
  for (const char* name :
       {"a.obj", "a.off", "a.ply", "a.stl", "a.gltf", "a.glb", "a.dae", "a.fbx"}) {
    error_of(write(name, garbage));
  }
}

/// A triangle in FBX as text. `unit` is a number, or what stands in its place.
std::string fbx_of_unit(const std::string& unit) {
  return "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: "
         "7400\n}\nGlobalSettings: {\nVersion: 1000\nProperties70: {\nP: \"UnitScaleFactor\", "
         "\"double\", \"Number\", \"\"," +
         unit +
         "\n}\n}\nObjects: {\nGeometry: 1000, \"Geometry::t\", \"Mesh\" {\nVertices: *9 {\na: "
         "0,0,0,100,0,0,0,100,0\n}\nPolygonVertexIndex: *3 {\na: 0,1,-3\n}\nGeometryVersion: "
         "124\n}\nModel: 2000, \"Model::t\", \"Mesh\" {\nVersion: 232\n}\n}\nConnections: {\nC: "
         "\"OO\",2000,0\nC: \"OO\",1000,2000\n}\n";
}

TEST_F(Import, TakesTheUnitOfFbxOrSaysWhatIsWrongWithIt) {
  const ImportResult centimetres = import_mesh(write("a.fbx", fbx_of_unit("1")), {});
  ASSERT_TRUE(centimetres.mesh.has_value()) << centimetres.error;
  EXPECT_NEAR(centimetres.report.bounds_m.max().x(), 1.0, 1e-6);
  for (const char* unit : {"-1", "0", "1e30", "1e-30"}) {
    EXPECT_THAT(error_of(write("a.fbx", fbx_of_unit(unit))), HasSubstr("UnitScaleFactor"));
  }
}

// 27 bytes that cost assimp 5 GB and 15 s. The error has the number only if the file was not read.
TEST_F(Import, RefusesAFileThatPromisesBillions) {
  EXPECT_THAT(error_of(write("a.off", "OFF\n400000000 1 0\n0 0 0 0 \n")), HasSubstr("400000000"));
  EXPECT_THAT(error_of(write("b.off", "OFF\n#\n1 99999999999999999999 0\n")), HasSubstr("range"));
}

TEST_F(Import, EndsAReaderThatTakesTooMuchMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's shadow memory takes more address space than any limit";
#endif
  std::string text;
  for (int i = 0; i < 1'500'000; ++i) text += "v 1.5 2.5 3.5\n";
  EXPECT_THAT(error_of(write("a.obj", text), {.memory_limit_bytes = std::size_t{60} << 20}),
              HasSubstr("more than the limit of 60 MiB"));
}

TEST_F(Import, EndsAReaderThatTakesTooLong) {
  // More than is read before the first check of the clock.
  std::string text;
  for (int i = 0; i < 400'000; ++i) text += "v 1.5 2.5 3.5\n";
  EXPECT_THAT(error_of(write("a.obj", text.append(kObj)), {.time_limit_s = 0.0}),
              HasSubstr("more than the limit of 0 s"));
}

/// Returns a comb, which has few ears: cutting it takes time that grows with the cube of its teeth.
std::string endless_comb() {
  std::string text;
  std::string face = "f";
  constexpr int kTeeth = 40'000;
  for (int i = 0; i < kTeeth; ++i) {
    text += "v " + std::to_string(i) + " " + std::to_string(i % 2 * 1000) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  text += "v " + std::to_string(kTeeth) + " 2000 0\nv -1 2000 0\n";
  face += " " + std::to_string(kTeeth + 1) + " " + std::to_string(kTeeth + 2);
  return text + face + "\n";
}

TEST_F(Import, EndsAReaderThatTakesForEver) {
  EXPECT_THAT(error_of(write("a.obj", endless_comb()), {.time_limit_s = 0.3}),
              HasSubstr("more than the limit of 0.3 s"));
}

/// Returns the /proc/PID/status of the child process of that name, or an empty text.
std::string status_of_child(const std::string& name) {
  std::error_code error;
  for (const auto& task : fs::directory_iterator("/proc/self/task", error)) {
    std::ifstream children(task.path() / "children");
    for (std::string pid; children >> pid;) {
      std::ifstream file("/proc/" + pid + "/status");
      const std::string status{std::istreambuf_iterator<char>(file), {}};
      if (status.starts_with("Name:\t" + name)) return status;
    }
  }
  return {};
}

TEST_F(Import, TheReaderIsConfinedBeforeItReads) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "with a sanitizer the reader is not confined, see import_child.cpp";
#endif
  const fs::path file = write("a.obj", endless_comb());
  std::atomic<bool> done = false;
  std::jthread importing([&] {
    import_mesh(file, {.time_limit_s = 3.0});
    done = true;
  });
  bool confined = false;
  while (!confined && !done) {
    const std::string status = status_of_child("camway-import");
    confined = status.find("Seccomp:\t2") != std::string::npos &&
               status.find("NoNewPrivs:\t1") != std::string::npos;
  }
  EXPECT_TRUE(confined);
}

TEST_F(Import, SurvivesAReaderThatCrashes) {
  // Nodes are nested so deeply that the reader's recursion exhausts the stack.
  std::string opening;
  std::string closing;
  for (int i = 0; i < 400'000; ++i) {
    opening += "<node>";
    closing += "</node>";
  }
  EXPECT_THAT(error_of(write("a.dae", collada(opening, closing))), HasSubstr("crashed"));
}

TEST_F(Import, LeavesNoChildAndNoDescriptorBehind) {
  const auto descriptors = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const fs::path file = write("a.obj", kObj);
  import_mesh(file, {});
  const auto before = descriptors();
  for (int i = 0; i < 5; ++i) {
    import_mesh(file, {});
    import_mesh(file, {.time_limit_s = 0.0});
  }
  EXPECT_EQ(descriptors(), before);
}

TEST_F(Import, SaysWhatToDoWithFormatsThatAreNotRead) {
  EXPECT_THAT(error_of(write("a.usda", "#usda 1.0\n")),
              HasSubstr("USD is not supported: export glTF"));
  EXPECT_THAT(error_of(write("a.USDZ", "PK\n")), HasSubstr("export glTF"));
  EXPECT_THAT(error_of(write("a.laz", "LASF")), HasSubstr("las2las"));
  const std::string gltf =
      R"({"asset": {"version": "2.0"}, "extensionsRequired": ["EXT_meshopt_compression"],
          "scene": 0, "scenes": [{}], "buffers": [{"byteLength": 4}]})";
  EXPECT_THAT(error_of(write("a.gltf", gltf)), HasSubstr("compressed (EXT_meshopt_compression)"));
  EXPECT_THAT(error_of(write("a.ifc", "ISO-10303-21;\nHEADER;FILE_SCHEMA(('IFC4'));ENDSEC;\n")),
              HasSubstr("is of the schema IFC4"));
}

TEST_F(Import, SaysWhatAFileIsWhoseNameSaysAnotherFormat) {
  EXPECT_THAT(error_of(write("a.obj", "#Inventor V2.1 ascii\n")),
              HasSubstr("its content is Open Inventor: name it .iv"));
  EXPECT_THAT(error_of(write("b.obj", "ISO-10303-21;\nHEADER;\n")), HasSubstr("name it .step"));
  EXPECT_THAT(error_of(write("c.obj", "Kaydara FBX Binary  ")), HasSubstr("name it .fbx"));
  EXPECT_THAT(error_of(write("d.fbx", gltf({1, 2, 3, 4, 2, 3, 1, 5, 3}))),
              HasSubstr("name it .gltf"));
  EXPECT_THAT(error_of(write("e.json", "[1]")), HasSubstr(".voxel.json, with its .voxel.bin"));
}

TEST_F(Import, ReadsTextsBehindAByteOrderMark) {
  const std::string mark = "\xEF\xBB\xBF";
  expect_the_triangle(import_text("a.obj", mark + std::string(kObj)));
  expect_the_triangle(import_text("a.off", mark + std::string(kOff)));
  expect_the_triangle(import_text("a.ply", mark + std::string(kPly)));
  expect_the_triangle(import_text("a.stl", mark + std::string(kStl)));
  EXPECT_EQ(import_text("a.ug", mark + "v p 0 0 0; v q 1 0 0; v r 0 1 0; f (p q r);")
                .mesh->triangles.size(),
            1U);
}

TEST_F(Import, OpensTheFilesThatGltfNamesInAUri) {
  std::string text = gltf({1, 2, 3, 4, 2, 3, 1, 5, 3});
  const std::string begin = "data:application/octet-stream;base64,";
  const std::size_t at = text.find(begin);
  ASSERT_NE(at, std::string::npos);
  const std::size_t end = text.find('"', at);
  const std::string coded = text.substr(at + begin.size(), end - at - begin.size());
  const auto bytes = base::decode_base64(coded);
  ASSERT_TRUE(bytes);
  write("a b\xC3\xBC.bin", *bytes);
  text.replace(at, end - at, "a%20b%C3%BC.bin");
  EXPECT_EQ(import_text("a.gltf", text).mesh->triangles.size(), 1U);
}

// Many programs write it so; assimp 5.2 refuses the whole file.
TEST_F(Import, ReadsColladaWithBlanksBeforeNumbers) {
  const std::string collada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.5"/><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="c"><phong>
<diffuse><color> 0.3 0.3 0.3 1</color></diffuse></phong></technique></profile_COMMON></effect></library_effects>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">
 0 0 0 1 0 0 0 2 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p> 0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  const ImportResult result = import_text("a.dae", collada);
  ASSERT_TRUE(result.mesh);
  ASSERT_EQ(result.mesh->triangles.size(), 1U);
  EXPECT_EQ(result.mesh->triangle(0)[2], Vec3(0, 1, 0));
  EXPECT_THAT(result.report.notes, ::testing::Contains(HasSubstr("<unit>")));
}

TEST_F(Import, ReadsUnigrafixWithTheFilesThatItIncludes) {
  fs::create_directories(folder_ / "parts");
  write("parts/leg.ug", "def leg; v a 0 0 0; v b 1 0 0; v c 0 0 2; f (a b c); end;");
  write("parts/table.ug", "include leg.ug; def table; a (leg) 4 -tx 3; end;");
  const ImportResult result =
      import_text("room.ug", "include parts/table.ug;\ni desk (table -ty 1);");
  ASSERT_TRUE(result.mesh);
  EXPECT_EQ(result.report.format, "UniGrafix");
  ASSERT_EQ(result.mesh->objects.size(), 4U);
  EXPECT_EQ(result.mesh->objects[3].name, "desk/leg");
  EXPECT_EQ(result.mesh->triangle(3)[1], Vec3(10, 1, 0));
}

TEST_F(Import, IncludesNoFileFromElsewhere) {
  const fs::path inner = folder_ / "inner";
  fs::create_directories(inner);
  write("secret.ug", "v a 0 0 0;");
  fs::create_symlink(folder_ / "secret.ug", inner / "link.ug");
  for (const std::string name : {"../secret.ug", "link.ug", "/etc/passwd"}) {
    const fs::path file = write("inner/scene.ug", "\ninclude " + name + ";");
    EXPECT_THAT(error_of(file), HasSubstr("line 2: '" + name + "' is not in the folder")) << name;
  }
  const fs::path file = write("inner/scene.ug", "include parts.ug;");
  EXPECT_THAT(error_of(file), HasSubstr("line 1: 'parts.ug' is not there"));
}

TEST_F(Import, OpenInventorIsReadOrSaidToBeMissing) {
  const ImportResult result = import_mesh(write("a.iv", "#Inventor V2.1 ascii\nCube { }\n"), {});
  if (result.mesh) {
    EXPECT_EQ(result.report.triangles, 12U);
  } else {
    EXPECT_THAT(result.error,
                ::testing::EndsWith("this build has no reader for Open Inventor (libcoin)"));
  }
}

TEST_F(Import, StepIsReadOrSaidToBeMissing) {
  EXPECT_THAT(error_of(write("a.step", "ISO-10303-21;\n")),
              ::testing::AnyOf(HasSubstr("is no STEP file, or damaged"),
                               HasSubstr("this build has no reader for STEP and IGES")));
}

TEST_F(Import, BezierPatchesAreReadInTheImportProcess) {
  std::string text = "1\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n16\n";
  for (int i = 0; i < 16; ++i) {
    text += std::to_string(i % 4) + " " + std::to_string(i / 4) + " 0\n";
  }
  const ImportResult result = import_mesh(write("flat.BPT", text), {});
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.report.format, "Bezier patches");
  EXPECT_EQ(result.report.triangles, 2U);
  EXPECT_THAT(error_of(write("bad.bpt", "1\n")), HasSubstr("line 1: says it has 1 patches"));
}

}  // namespace
}  // namespace camway::scene
