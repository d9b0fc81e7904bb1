// SPDX-License-Identifier: MIT
#include "tools/json/json_body.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "daemon/planning/request/body_members.h"
#include "tools/json/json_reader.h"

namespace camway::tools {
namespace {

using geometry::Vec3;
using planning::FieldSpec;
using Triangle = std::array<std::uint32_t, 3>;

/// Reads the elements of a list, each by `read(field, element)`. Stops at one element more than a
/// body may have: `planning::validate` then refuses the count, and a longer list costs no memory.
template <class Element, class Read>
void read_list(const Field& list, std::size_t most, std::vector<Element>& elements,
               const Read& read) {
  const std::size_t count = std::min(list.size(), most + 1);
  for (std::size_t i = 0; i < count && !list.failed(); ++i) {
    read(list.element(i), elements.emplace_back());
  }
}

void read_points(const Field& list, std::vector<Vec3>& points) {
  read_list(list, motion::kMaxBodyPoints, points,
            [](const Field& item, Vec3& point) { read_value(item, point); });
}

void read_triangle(const Field& item, Triangle& triangle) {
  if (item.size() != 3) item.fail("must be an array of 3 indices of vertices");
  for (std::size_t k = 0; k < 3 && !item.failed(); ++k) {
    constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
    triangle[k] = static_cast<std::uint32_t>(item.element(k).integer(0, kMost));
  }
}

/// Reads the members of a shape.
struct ShapeReader {
  const Field& body;

  void operator()(const FieldSpec& spec, double& radius_m) const {
    radius_m = body.member(spec.name, spec.old_file).number();
  }
  void operator()(const FieldSpec& spec, Vec3& vector) const {
    const bool may_lack = spec.name == planning::body::kCenter.name;
    if (may_lack && !body.optional_member(spec.name)) return;
    read_value(body.member(spec.name), vector);
  }
  void operator()(const FieldSpec& spec, std::vector<Vec3>& vertices) const {
    read_points(body.member(spec.name), vertices);
  }
  void operator()(const FieldSpec& spec, std::vector<Triangle>& triangles) const {
    read_list(body.member(spec.name), motion::kMaxBodyTriangles, triangles, read_triangle);
  }
  void operator()(const FieldSpec& spec, std::vector<std::vector<Vec3>>& pieces) const {
    const auto points = body.optional_member(planning::body::kPoints.name);
    const auto lists = body.optional_member(spec.name);
    if (points.has_value() == lists.has_value()) {
      body.fail("must have either points or pieces");
    } else if (points) {
      read_points(*points, pieces.emplace_back());
    } else {
      read_list(*lists, motion::kMaxBodyPoints, pieces, read_points);
    }
  }
};

}  // namespace

std::optional<motion::BodyShape> read_body(const Field& field) {
  const Field type = field.member("type");
  const std::string name = type.text();
  const auto* const named = std::ranges::find(planning::kShapeNames, name);
  std::optional<motion::BodyShape> shape =
      planning::blank_shape(static_cast<std::size_t>(named - planning::kShapeNames.begin()));
  if (!shape) {
    type.fail("'" + name + "' is unknown; a body is a camera, box, sphere, convex or mesh");
    return std::nullopt;
  }
  const auto read = [&](auto& part) {
    std::vector<std::string_view> names = {"type"};
    if constexpr (requires { part.pieces_C; }) names.push_back(planning::body::kPoints.name);
    allow_only(field, names, [&](const auto& visit) { planning::visit_shape(visit, part); });
    planning::visit_shape(ShapeReader{field}, part);
  };
  std::visit(read, *shape);
  if (std::holds_alternative<motion::Camera>(*shape)) shape.reset();
  return shape;
}

}  // namespace camway::tools
