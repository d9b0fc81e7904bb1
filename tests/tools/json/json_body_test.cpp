// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/planning/request/validate.h"
#include "tools/json/json_request.h"

namespace camway::tools {
namespace {

using geometry::Vec3;
using ::testing::StartsWith;

/// Returns a request with this body, and a camera if asked for.
std::string request_with(const std::string& body, bool with_camera = false) {
  return R"({"keyframes": [{"position": [0, 0, 0], "orientation": [1, 0, 0, 0]},
                           {"position": [0, 0, 1], "orientation": [1, 0, 0, 0]}],)" +
         std::string(with_camera ? R"("camera": {"fov_x_deg": 90, "fov_y_deg": 60, "near": 0.1},)"
                                 : "") +
         "\"body\": " + body + "}";
}

planning::PlanRequest read(const std::string& body, bool with_camera = false) {
  const auto parsed = parse_as<RequestFile>(request_with(body, with_camera), "R.json");
  EXPECT_TRUE(parsed) << parsed.error;
  return parsed.value.value_or(RequestFile{});
}

TEST(JsonBody, ReadsABox) {
  const auto request = read(R"({"type": "box", "size": [1, 2, 3], "center": [4, 5, 6]})");
  const auto& box = std::get<motion::BoxShape>(request.body.value());
  EXPECT_EQ(box.size_m, Vec3(1, 2, 3));
  EXPECT_EQ(box.center_C, Vec3(4, 5, 6));
  EXPECT_FALSE(planning::validate(request)) << "a body needs no camera";
  EXPECT_EQ(
      std::get<motion::BoxShape>(*read(R"({"type": "box", "size": [1, 2, 3]})").body).center_C,
      Vec3::Zero());
}

TEST(JsonBody, ReadsASphere) {
  const auto request = read(R"({"type": "sphere", "radius_m": 0.5, "center": [0, 0, -1]})", true);
  const auto& sphere = std::get<motion::SphereShape>(request.body.value());
  EXPECT_EQ(sphere.radius_m, 0.5);
  EXPECT_EQ(sphere.center_C, Vec3(0, 0, -1));
  EXPECT_EQ(request.camera.near_m, 0.1) << "for the picture";
}

TEST(JsonBody, ReadsTheRadiusByItsOldName) {
  const auto request = read(R"({"type": "sphere", "radius": 0.5})");
  EXPECT_EQ(std::get<motion::SphereShape>(request.body.value()).radius_m, 0.5);
  const auto fault = planning::validate(read(R"({"type": "sphere", "radius": -1})"));
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->message, StartsWith("body.radius: is -1 m"));
  EXPECT_EQ(parse_as<RequestFile>(request_with(R"({"type": "sphere", "radius": 1, "radius_m": 1})"),
                                  "R.json")
                .error,
            "R.json: body: has both radius_m and radius, its old name; leave one out");
}

TEST(JsonBody, ReadsConvexPieces) {
  const auto one = read(R"({"type": "convex", "points": [[1, 2, 3], [4, 5, 6]]})");
  const auto& points = std::get<motion::ConvexShape>(one.body.value()).pieces_C;
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0][1], Vec3(4, 5, 6));
  const auto two = read(R"({"type": "convex", "pieces": [[[1, 2, 3]], [[4, 5, 6], [7, 8, 9]]]})");
  const auto& pieces = std::get<motion::ConvexShape>(two.body.value()).pieces_C;
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[1][1], Vec3(7, 8, 9));
}

TEST(JsonBody, ReadsAMesh) {
  const auto request = read(
      R"({"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 2, 1]],
          "_source": "drone.obj"})");
  const auto& mesh = std::get<motion::MeshShape>(request.body.value());
  EXPECT_EQ(mesh.vertices_C[2], Vec3(0, 1, 0));
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
}

TEST(JsonBody, ACameraIsTheDefault) {
  EXPECT_FALSE(read(R"({"type": "camera"})", true).body);
  EXPECT_THAT(parse_as<RequestFile>(request_with(R"({"type": "camera"})"), "R.json").error,
              StartsWith("R.json: camera: is missing"));
}

TEST(JsonBody, NamesTheFieldAtFault) {
  const std::pair<const char*, const char*> cases[] = {
      {"7", "body: must be an object, not a number"},
      {"{}", "body.type: is missing"},
      {R"({"type": 3})", "body.type: must be a string"},
      {R"({"type": "cone"})",
       "body.type: 'cone' is unknown; there are camera, box, sphere, convex, mesh"},
      {R"({"type": "camera", "near": 1})", "body.near: is unknown; body has type"},
      {R"({"type": "box"})", "body.size: is missing"},
      {R"({"type": "box", "size": 2})", "body.size: must be an array of 3 numbers, not a number"},
      {R"({"type": "box", "size": [1, 2, 3], "centre": [0, 0, 0]})",
       "body.centre: is unknown; body has type, size, center"},
      {R"({"type": "box", "size": [1, 2, 3], "radius": 1})", "body.radius: is unknown"},
      {R"({"type": "sphere"})", "body.radius_m: is missing"},
      {R"({"type": "convex"})", "body: must have either points or pieces"},
      {R"({"type": "convex", "points": [[0, 0, 0]], "pieces": []})",
       "body: must have either points or pieces"},
      {R"({"type": "convex", "points": [[0, 0]]})",
       "body.points[0]: must be an array of 3 numbers, not an array of 2"},
      {R"({"type": "convex", "pieces": [[[0, 0, 0]], 5]})", "body.pieces[1]: must be an array"},
      {R"({"type": "mesh", "vertices": [[0, 0, 0]], "triangles": [[0, 0]]})",
       "body.triangles[0]: must be an array of 3, not of 2"},
      {R"({"type": "mesh", "vertices": [[0, 0, 0]], "triangles": [[0, 0, -1]]})",
       "body.triangles[0][2]: is -1; it must be a whole number from 0"},
      {R"({"type": "mesh", "vertices": [[0, 0, 0]], "triangles": [[0, 0, 0.5]]})",
       "body.triangles[0][2]: is 0.5; it must be a whole number"},
  };
  for (const auto& [body, expected] : cases) {
    const auto parsed = parse_as<RequestFile>(request_with(body), "R.json");
    EXPECT_FALSE(parsed) << body;
    EXPECT_THAT(parsed.error, StartsWith(std::string("R.json: ") + expected)) << body;
  }
}

TEST(JsonBody, LeavesRangesToValidation) {
  const auto fault_of = [](const std::string& body) {
    const auto fault = planning::validate(read(body));
    return fault ? fault->message : std::string();
  };
  EXPECT_THAT(fault_of(R"({"type": "box", "size": [1, 0, 3]})"),
              StartsWith("body.size[1]: is 0 m; it must be above 0"));
  EXPECT_THAT(fault_of(R"({"type": "sphere", "radius_m": -1})"),
              StartsWith("body.radius_m: is -1 m"));
  EXPECT_THAT(fault_of(R"({"type": "convex", "points": []})"), StartsWith("body.points: is empty"));
  EXPECT_THAT(fault_of(R"({"type": "convex", "pieces": []})"), StartsWith("body.pieces: is empty"));
  EXPECT_THAT(fault_of(R"({"type": "mesh", "vertices": [[0, 0, 0]], "triangles": [[0, 1, 0]]})"),
              StartsWith("body.triangles[0][1]: is 1, but there are 1 vertices"));
  std::string points;
  for (int i = 0; i < 600; ++i) points += std::string(i == 0 ? "" : ", ") + "[0, 0, 0]";
  EXPECT_THAT(fault_of(R"({"type": "convex", "points": [)" + points + "]}"),
              StartsWith("body.points: passes the 512 points"));
}

TEST(JsonBody, ReadsWhetherAMeshIsSolid) {
  const std::string mesh =
      R"({"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": )";
  const std::string closed = "[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]";
  EXPECT_FALSE(std::get<motion::MeshShape>(*read(mesh + closed + "}").body).solid);
  const auto request = read(mesh + closed + R"(, "solid": true})");
  EXPECT_TRUE(std::get<motion::MeshShape>(*request.body).solid);
  EXPECT_FALSE(planning::validate(request));
  const auto fault = planning::validate(read(mesh + R"([[0, 2, 1]], "solid": true})"));
  ASSERT_TRUE(fault);
  EXPECT_THAT(
      fault->message,
      StartsWith("body.triangles: are no closed surface: the edge between vertices 0 and 1"));
}

TEST(JsonBody, ReadsTheNameOfAMeshFile) {
  const auto parsed = parse_as<RequestFile>(
      request_with(R"({"type": "mesh", "file": "a/piano.obj", "scale": 0.001, "solid": true})"),
      "R.json");
  ASSERT_TRUE(parsed) << parsed.error;
  ASSERT_TRUE(parsed->body_file);
  EXPECT_EQ(parsed->body_file->file, "a/piano.obj");
  EXPECT_EQ(parsed->body_file->scale, 0.001);
  EXPECT_TRUE(parsed->body_file->solid);
  EXPECT_TRUE(planning::validate(*parsed)) << "the file is still to be read";
  const auto error_of = [](const std::string& body) {
    return parse_as<RequestFile>(request_with(body), "R.json").error;
  };
  EXPECT_EQ(error_of(R"({"type": "box", "file": "a.obj"})"),
            "R.json: body.type: must be mesh for a body with a file");
  EXPECT_EQ(error_of(R"({"type": "mesh", "file": "a.obj", "scale": 0})"),
            "R.json: body.scale: must be above 0 and finite");
  EXPECT_THAT(error_of(R"({"type": "mesh", "file": "a.obj", "vertices": []})"),
              StartsWith("R.json: body.vertices: is unknown"));
}

}  // namespace
}  // namespace camway::tools
