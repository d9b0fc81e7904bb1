// SPDX-License-Identifier: MIT
#include "tools/json/json_body.h"

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace camway::tools {
namespace {

using geometry::Vec3;

Vec3 read_point(const Field& field) {
  Vec3 point;
  field.numbers(point.data(), 3);
  return point;
}

Vec3 read_center(const Field& body) {
  const std::optional<Field> center = body.optional_member("center");
  return center ? read_point(*center) : Vec3::Zero();
}

/// Stops reading at one element more than a body may have: `planning::validate` then refuses the
/// count, and a longer list costs no memory.
std::vector<Vec3> read_points(const Field& list) {
  std::vector<Vec3> points;
  const std::size_t count = std::min(list.size(), motion::kMaxBodyPoints + 1);
  for (std::size_t i = 0; i < count; ++i) points.push_back(read_point(list.element(i)));
  return points;
}

motion::BodyShape read_box(const Field& body) {
  body.allow_only({"type", "size", "center"});
  return motion::BoxShape{read_center(body), read_point(body.member("size"))};
}

motion::BodyShape read_sphere(const Field& body) {
  body.allow_only({"type", kRadius.name, "center"}, {kRadius.old_file});
  return motion::SphereShape{read_center(body),
                             body.member(kRadius.name, kRadius.old_file).number()};
}

motion::BodyShape read_convex(const Field& body) {
  body.allow_only({"type", "points", "pieces"});
  const std::optional<Field> points = body.optional_member("points");
  const std::optional<Field> pieces = body.optional_member("pieces");
  if (points.has_value() == pieces.has_value()) {
    body.fail("must have either points or pieces");
    return motion::ConvexShape{};
  }
  motion::ConvexShape convex;
  if (points) {
    convex.pieces_C.push_back(read_points(*points));
    return convex;
  }
  const std::size_t count = std::min(pieces->size(), motion::kMaxBodyPoints + 1);
  for (std::size_t i = 0; i < count; ++i) {
    convex.pieces_C.push_back(read_points(pieces->element(i)));
  }
  return convex;
}

motion::BodyShape read_mesh(const Field& body) {
  body.allow_only({"type", "vertices", "triangles"});
  motion::MeshShape mesh;
  mesh.vertices_C = read_points(body.member("vertices"));
  const Field triangles = body.member("triangles");
  const std::size_t count = std::min(triangles.size(), motion::kMaxBodyTriangles + 1);
  for (std::size_t i = 0; i < count && !body.failed(); ++i) {
    const Field item = triangles.element(i);
    if (item.size() != 3) item.fail("must be an array of 3 indices of vertices");
    if (item.failed()) break;
    std::array<std::uint32_t, 3>& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = static_cast<std::uint32_t>(
          item.element(k).integer(0, std::numeric_limits<std::uint32_t>::max()));
    }
  }
  return mesh;
}

}  // namespace

std::optional<motion::BodyShape> read_body(const Field& field) {
  const Field type_field = field.member("type");
  const std::string type = type_field.text();
  if (type == "box") return read_box(field);
  if (type == "sphere") return read_sphere(field);
  if (type == "convex") return read_convex(field);
  if (type == "mesh") return read_mesh(field);
  if (type != "camera") {
    type_field.fail("'" + type + "' is unknown; a body is a camera, box, sphere, convex or mesh");
  }
  field.allow_only({"type"});
  return std::nullopt;
}

}  // namespace camway::tools
