// SPDX-License-Identifier: MIT
#include "tools/json/json_options.h"

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "daemon/planning/request/body_members.h"
#include "tools/json/json_reader.h"

namespace camway::tools {

namespace {

using correction::OrientationRule;
using planning::FieldSpec;

/// Records an error if `key` is there although the policy does not use it.
void refuse_without(std::string_view policy, const Field& field, std::string_view key) {
  if (const auto member = field.optional_member(key)) {
    member->fail("counts only with \"policy\": \"" + std::string(policy) + "\"");
  }
}

/// The members that a document has by their old names: the old name by the path of the member.
using OldNames = std::map<std::string, std::string, std::less<>>;

/// Notes the members that `object` has by their old names.
struct OldNameFinder {
  const Field& object;
  OldNames& found;

  void operator()(const FieldSpec& spec) const {
    if (spec.old_file.empty()) return;
    const auto member = object.optional_member(spec.old_file);
    if (member) found.emplace(object.path() + "." + std::string(spec.name), member->path());
  }
};

OldNames old_names_in(const Field& request) {
  OldNames found;
  const auto body = request.optional_member("body");
  if (body) planning::visit_body(OldNameFinder{*body, found});
  const auto options = request.optional_member("options");
  if (!options) return found;
  planning::visit_options(OldNameFinder{*options, found});
  const auto limits = options->optional_member("limits");
  if (limits) planning::visit_limits(OldNameFinder{*limits, found});
  return found;
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

planning::PlanOptions read_options(const Field& field) {
  planning::PlanOptions options;
  read_table(field, [&](const auto& visit) { planning::visit_options(visit, options); });
  return options;
}

motion::Camera read_camera(const Field& field) {
  allow_only(field, {}, [](const auto& visit) { planning::visit_camera(visit); });
  motion::Camera camera;
  const auto need = [&](const FieldSpec& spec, double& member) {
    static_cast<void>(field.member(spec.file_name()));
    JsonReader{field}(spec, member);
  };
  planning::visit_camera(need, camera);
  return camera;
}

planning::FieldSpelling json_spelling() {
  return [](std::string_view path) { return planning::spell(path, planning::Spelling::kFile); };
}

planning::FieldSpelling json_spelling(const Field& request) {
  return [old_names = old_names_in(request), otherwise = json_spelling()](std::string_view path) {
    const auto old_name = old_names.find(path);
    return old_name == old_names.end() ? otherwise(path) : old_name->second;
  };
}

}  // namespace camway::tools
