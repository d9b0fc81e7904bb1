// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <variant>

#include "daemon/motion/body/body.h"
#include "daemon/planning/request/field_spec.h"

/// The members of bodies, as `options.h` has those of options. Messages, files and the spelling of
/// names follow this list.
namespace camway::planning {

/// Names of the shapes in files. Their order is that of `motion::BodyShape` and of the wire.
inline constexpr std::array<std::string_view, 5> kShapeNames = {"camera", "box", "sphere", "convex",
                                                                "mesh"};

/// The number on the wire of a mesh that is solid. In files a mesh has a member for that.
inline constexpr std::size_t kSolidMesh = kShapeNames.size();
/// Names of the numbers on the wire.
inline constexpr std::array<std::string_view, kSolidMesh + 1> kShapeNumberNames = {
    "camera", "box", "sphere", "convex", "mesh", "solid mesh"};

/// Returns the shape with this number, its members as they are by default; nothing for a number
/// that no shape has.
inline std::optional<motion::BodyShape> blank_shape(std::size_t number) {
  const std::array<motion::BodyShape, kShapeNumberNames.size()> shapes = {
      motion::Camera{},      motion::BoxShape{},  motion::SphereShape{},
      motion::ConvexShape{}, motion::MeshShape{}, motion::MeshShape{{}, {}, /*solid=*/true}};
  if (number >= shapes.size()) return std::nullopt;
  return shapes[number];
}

/// Returns the number of a shape.
inline std::size_t number_of(const motion::BodyShape& shape) {
  const auto* const mesh = std::get_if<motion::MeshShape>(&shape);
  return mesh != nullptr && mesh->solid ? kSolidMesh : shape.index();
}

namespace body {

inline constexpr FieldSpec kSize{.name = "size", .wire = "size_m", .is_needed = true};
inline constexpr FieldSpec kRadius{.name = "radius_m", .old_file = "radius", .is_needed = true};
inline constexpr FieldSpec kCenter{.name = "center", .wire = "center_m"};
inline constexpr FieldSpec kPieces{.name = "pieces", .wire = "piece_sizes"};
inline constexpr FieldSpec kPoints{.name = "points", .wire = "points_m"};  ///< of a single piece
inline constexpr FieldSpec kVertices{.name = "vertices", .wire = "points_m", .is_needed = true};
inline constexpr FieldSpec kSolid{.name = "solid", .wire = "type"};  ///< in files only
inline constexpr FieldSpec kTriangles{.name = "triangles", .is_needed = true};

}  // namespace body

/// Calls `visit(spec, member, wire...)` for each member that `shape` has. `wire` is the client's
/// struct or the message, which has two members for pieces and one for all points. Without it, only
/// the members of the shape are visited.
template <class Visit, class Shape, class... Wire>
void visit_shape(const Visit& visit, Shape& shape, Wire&... wire) {
  if constexpr (requires { shape.size_m; }) visit(body::kSize, shape.size_m, wire.size_m...);
  if constexpr (requires { shape.radius_m; })
    visit(body::kRadius, shape.radius_m, wire.radius_m...);
  if constexpr (requires { shape.center_C; })
    visit(body::kCenter, shape.center_C, wire.center_m...);
  if constexpr (requires { shape.pieces_C, (wire.pieces_m, ...); }) {
    visit(body::kPieces, shape.pieces_C, wire.pieces_m...);
  } else if constexpr (requires { shape.pieces_C; }) {
    visit(body::kPieces, shape.pieces_C, wire.piece_sizes..., wire.points_m...);
  }
  if constexpr (requires { shape.vertices_C, (wire.vertices_m, ...); }) {
    visit(body::kVertices, shape.vertices_C, wire.vertices_m...);
  } else if constexpr (requires { shape.vertices_C; }) {
    visit(body::kVertices, shape.vertices_C, wire.points_m...);
  }
  if constexpr (requires { shape.triangles; }) {
    visit(body::kTriangles, shape.triangles, wire.triangles...);
  }
  if constexpr (sizeof...(Wire) == 0) {
    if constexpr (requires { shape.solid; }) visit(body::kSolid, shape.solid);
  }
}

/// Calls `visit(spec)` for the members of all shapes.
template <class Visit>
void visit_body(const Visit& visit) {
  for (std::size_t number = 0; number < kShapeNames.size(); ++number) {
    const auto visit_members = [&](const auto& shape) {
      visit_shape([&](const FieldSpec& spec, const auto&) { visit(spec); }, shape);
    };
    std::visit(visit_members, *blank_shape(number));
  }
  visit(body::kPoints);
}

}  // namespace camway::planning
