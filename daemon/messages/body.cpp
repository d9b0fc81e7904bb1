// SPDX-License-Identifier: MIT
#include "daemon/messages/body.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "daemon/messages/members.h"
#include "daemon/planning/request/body_members.h"
#include "lcmtypes/wire/layout.h"

namespace camway::messages {
namespace {

using geometry::Vec3;
using motion::BodyShape;
using planning::FieldSpec;
using Points = std::vector<std::vector<double>>;

static_assert(wire::kMaxBodyPoints == motion::kMaxBodyPoints);
static_assert(wire::kMaxBodyTriangles == motion::kMaxBodyTriangles);
static_assert(planning::kShapeNames[body_t::MESH] == "mesh");

/// Writes the members of a shape.
struct ShapeWriter {
  template <class Mine, class Wire>
  void operator()(const FieldSpec&, const Mine& mine, Wire& wire) const {
    ToWire{}(mine, wire);
  }
  void operator()(const FieldSpec&, const std::vector<std::vector<Vec3>>& pieces,
                  std::vector<std::int32_t>& sizes, Points& points) const {
    for (const std::vector<Vec3>& piece : pieces) {
      sizes.push_back(static_cast<std::int32_t>(piece.size()));
      ToWire{}(piece, points);
    }
  }
};

/// Reads the members of a shape. Keeps the first error.
struct ShapeReader {
  std::string& error;

  template <class Mine, class Wire>
  void operator()(const FieldSpec&, Mine& mine, const Wire& wire) const {
    FromWire{}(mine, wire);
  }
  void operator()(const FieldSpec&, std::vector<std::array<std::uint32_t, 3>>& triangles,
                  const std::vector<std::vector<std::int32_t>>& wire) const {
    FromWire{}(triangles, wire);
    for (std::size_t i = 0; i < wire.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (wire[i][k] >= 0) continue;
        refuse("triangles" + index(i) + index(k) + ": is " + std::to_string(wire[i][k]) +
               ", which is below 0");
      }
    }
  }
  void operator()(const FieldSpec&, std::vector<std::vector<Vec3>>& pieces,
                  const std::vector<std::int32_t>& sizes, const Points& points) const {
    std::span left(points);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      if (sizes[i] < 0 || static_cast<std::size_t>(sizes[i]) > left.size()) {
        return refuse("piece_sizes" + index(i) + ": is " + std::to_string(sizes[i]) + ", and " +
                      std::to_string(left.size()) + " points are left");
      }
      const auto size = static_cast<std::size_t>(sizes[i]);
      FromWire{}(pieces.emplace_back(), left.first(size));
      left = left.subspan(size);
    }
    if (left.empty()) return;
    refuse("piece_sizes: " + std::to_string(left.size()) + " points belong to no piece");
  }

  static std::string index(std::size_t i) { return "[" + std::to_string(i) + "]"; }
  void refuse(const std::string& fault) const {
    if (error.empty()) error = "body." + fault;
  }
};

/// Returns an error about a member that is not zero or empty though the shape does not use it: its
/// sender meant it.
std::string idle_member(const body_t& wire, const BodyShape& shape) {
  std::vector<const void*> used = {&wire.type};
  const auto note = [&](const FieldSpec&, const auto&, const auto&... members) {
    (used.push_back(&members), ...);
  };
  std::visit([&](const auto& part) { planning::visit_shape(note, part, wire); }, shape);
  std::string idle;
  wire::for_each_member<body_t>([&](const auto& described) {
    const auto& member = wire.*described.member;
    const bool is_used = std::ranges::count(used, static_cast<const void*>(&member)) > 0;
    if (!is_used && !wire::is_blank(member)) idle = described.name;
  });
  if (idle.empty()) return {};
  return "body." + idle + ": does not count with this body.type; leave it zero or empty, or set " +
         "the type that it belongs to";
}

}  // namespace

body_t wire_body(const BodyShape& shape) {
  body_t wire{};
  wire.type = static_cast<std::int8_t>(shape.index());
  std::visit([&](const auto& part) { planning::visit_shape(ShapeWriter{}, part, wire); }, shape);
  wire::set_counts(wire);
  return wire;
}

base::Result<std::optional<BodyShape>> body_of(const body_t& wire) {
  std::optional<BodyShape> shape = planning::blank_shape(static_cast<std::size_t>(wire.type));
  if (!shape) return base::Failure{"body.type: " + std::to_string(wire.type) + " is unknown"};
  std::string error = idle_member(wire, *shape);
  const ShapeReader reader{error};
  std::visit([&](auto& part) { planning::visit_shape(reader, part, wire); }, *shape);
  if (!error.empty()) return base::Failure{std::move(error)};
  if (wire.type == body_t::CAMERA) shape.reset();
  return shape;
}

}  // namespace camway::messages
