// SPDX-License-Identifier: MIT
#include "tools/json/json_reader.h"

#include <limits>

namespace camway::tools {
namespace {

constexpr std::int64_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();

void read_corner(const Field& parent, std::string_view key, geometry::Vec3& corner_W) {
  const auto list = parent.optional_member(key);
  if (!list) return;
  if (list->size() != 3) list->fail("must be an array of 3, each a number or null");
  for (std::size_t axis = 0; axis < 3 && !list->failed(); ++axis) {
    const Field item = list->element(axis);
    if (!item.is_null()) corner_W[static_cast<Eigen::Index>(axis)] = item.number();
  }
}

}  // namespace

void read_value(const Field& field, std::int32_t& count) {
  count = static_cast<std::int32_t>(field.integer(0, std::numeric_limits<std::int32_t>::max()));
}

void read_value(const Field& field, std::uint32_t& triangle_or_side) {
  constexpr auto kSides = static_cast<std::int64_t>(geometry::Bounds::kSides);
  triangle_or_side = static_cast<std::uint32_t>(field.integer(-kSides, kMaxIndex));
}

void read_value(const Field& field, std::size_t& keyframe) {
  keyframe = static_cast<std::size_t>(field.integer(0, planning::kMaxKeyframes));
}

void read_value(const Field& field, std::vector<std::uint32_t>& triangles) {
  const std::size_t count = field.size();
  for (std::size_t i = 0; i < count && !field.failed(); ++i) {
    triangles.push_back(static_cast<std::uint32_t>(field.element(i).integer(0, kMaxIndex)));
  }
}

void read_value(const Field& field, std::tuple<double&, double&> both) {
  double numbers[2] = {};
  field.numbers(numbers, 2);
  both = std::tuple(numbers[0], numbers[1]);
}

void read_value(const Field& field, geometry::Quat& orientation) {
  geometry::Vec4 wxyz = geometry::Vec4::Zero();
  field.numbers(wxyz.data(), 4);
  orientation = geometry::from_wxyz(wxyz);
}

void read_value(const Field& field, geometry::Bounds& bounds) {
  field.allow_only({"min", "max"});
  bounds = {};
  read_corner(field, "min", bounds.min_W);
  read_corner(field, "max", bounds.max_W);
}

}  // namespace camway::tools
