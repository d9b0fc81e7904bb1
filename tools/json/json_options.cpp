// SPDX-License-Identifier: MIT
#include "tools/json/json_options.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using correction::MotionLimits;
using correction::OrientationPolicy;
using correction::OrientationRule;
using planning::FieldSpec;
using planning::PlanOptions;

/// Records an error for the first member that is not in the table.
template <class VisitTable>
void allow_only(const Field& field, const VisitTable& visit_table) {
  std::vector<std::string_view> names;
  std::vector<std::string_view> old_names;
  visit_table([&](const FieldSpec& spec) {
    names.push_back(spec.file_name());
    if (!spec.old_file.empty()) old_names.push_back(spec.old_file);
  });
  field.allow_only(names, old_names);
}

/// Records an error if `key` is there although the policy does not use it.
void refuse_without(std::string_view policy, const Field& field, std::string_view key) {
  if (const auto member = field.optional_member(key)) {
    member->fail("counts only with \"policy\": \"" + std::string(policy) + "\"");
  }
}

/// Reads those members of a struct that the object has.
struct MemberReader {
  const Field& object;

  template <class Member>
  void operator()(const FieldSpec& spec, Member& member) const {
    const auto field = object.optional_member(spec.file_name(), spec.old_file);
    if (field) read(*field, spec, member);
  }

 private:
  static void read(const Field& field, const FieldSpec& spec, double& value) {
    value = spec.is_angle() ? radians(field.number()) : field.number();
  }
  static void read(const Field& field, const FieldSpec&, std::optional<double>& value) {
    value = field.number();
  }
  static void read(const Field& field, const FieldSpec&, bool& value) { value = field.boolean(); }
  static void read(const Field& field, const FieldSpec&, std::int32_t& value) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    value = static_cast<std::int32_t>(field.integer(0, kMost));
  }
  static void read(const Field& field, const FieldSpec&, std::uint64_t& value) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    value = static_cast<std::uint64_t>(field.integer(1, kMost));
  }
  template <base::NamedEnum Enum>
  static void read(const Field& field, const FieldSpec&, Enum& value) {
    value = named(field, base::named_values<Enum>());
  }
  static void read(const Field& field, const FieldSpec&, geometry::Vec3& point) {
    field.numbers(point.data(), 3);
  }
  static void read(const Field& field, const FieldSpec&, geometry::Bounds& bounds) {
    bounds = read_bounds(field);
  }
  static void read(const Field& field, const FieldSpec&, MotionLimits& limits) {
    allow_only(field, [](const auto& visit) { planning::visit_limits(visit); });
    planning::visit_limits(MemberReader{field}, limits);
  }
  static void read(const Field& field, const FieldSpec&, OrientationPolicy& policy) {
    allow_only(field, [](const auto& visit) { planning::visit_orientation(visit); });
    planning::visit_orientation(MemberReader{field}, policy);
    policy.up_W = planning::direction_of(policy.up_W);
    if (policy.rule != OrientationRule::kLevel) refuse_without("level", field, "up");
    if (policy.rule == OrientationRule::kTarget) {
      static_cast<void>(field.member("target"));
    } else {
      refuse_without("target", field, "target");
      refuse_without("target", field, "cone_deg");
    }
  }
};

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

geometry::Bounds read_bounds(const Field& field) {
  field.allow_only({"min", "max"});
  geometry::Bounds bounds;
  read_corner(field, "min", bounds.min_W);
  read_corner(field, "max", bounds.max_W);
  return bounds;
}

PlanOptions read_options(const Field& field) {
  allow_only(field, [](const auto& visit) { planning::visit_options(visit); });
  PlanOptions options;
  planning::visit_options(MemberReader{field}, options);
  return options;
}

motion::Camera read_camera(const Field& field) {
  allow_only(field, [](const auto& visit) { planning::visit_camera(visit); });
  motion::Camera camera;
  const MemberReader read{field};
  const auto need = [&](const FieldSpec& spec, double& member) {
    static_cast<void>(field.member(spec.file_name()));
    read(spec, member);
  };
  planning::visit_camera(need, camera);
  return camera;
}

}  // namespace camway::tools
