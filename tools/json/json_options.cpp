// SPDX-License-Identifier: MIT
#include "tools/json/json_options.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tools/json/json_reader.h"

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
  static void read(const Field& field, const FieldSpec&, std::uint64_t& seed) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    seed = static_cast<std::uint64_t>(field.integer(1, kMost));
  }
  template <class Member>
  static void read(const Field& field, const FieldSpec&, Member& member) {
    read_value(field, member);
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

}  // namespace

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
