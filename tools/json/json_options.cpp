// SPDX-License-Identifier: MIT
#include <string>
#include <string_view>

#include "tools/json/json_io.h"
#include "tools/json/json_reader.h"

namespace camway::tools {
namespace {

using correction::OrientationRule;

/// Records an error if `key` is there although the policy does not use it.
void refuse_without(std::string_view policy, const Field& field, std::string_view key) {
  if (const auto member = field.optional_member(key)) {
    member->fail("counts only with \"policy\": \"" + std::string(policy) + "\"");
  }
}

}  // namespace

void read_value(const Field& field, correction::MotionLimits& limits) {
  read_table(field, [&](const auto& visit) { planning::visit_limits(visit, limits); });
}

void read_value(const Field& field, correction::OrientationPolicy& policy) {
  read_table(field, [&](const auto& visit) { planning::visit_orientation(visit, policy); });
  policy.up_W = planning::direction_of(policy.up_W);
  if (policy.rule != OrientationRule::kLevel) refuse_without("level", field, "up");
  if (policy.rule == OrientationRule::kTarget) {
    static_cast<void>(field.member("target"));
  } else {
    refuse_without("target", field, "target");
    refuse_without("target", field, "cone_deg");
  }
}

void read_value(const Field& field, planning::PlanOptions& options) {
  read_table(field, [&](const auto& visit) { planning::visit_options(visit, options); });
}

planning::FieldSpelling json_spelling(const DocumentNotes& notes) {
  return [old_names = notes.old_names](std::string_view path) {
    const std::string name = planning::spell(path, planning::Spelling::kFile);
    const auto old_name = old_names.find(name);
    return old_name == old_names.end() ? name : old_name->second;
  };
}

}  // namespace camway::tools
