// SPDX-License-Identifier: MIT
#include "tools/json/json_names.h"

#include <functional>
#include <map>
#include <string>

#include "tools/json/json_body.h"

namespace camway::tools {
namespace {

using planning::FieldSpec;

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
  if (const auto body = request.optional_member("body")) OldNameFinder{*body, found}(kRadius);
  const auto options = request.optional_member("options");
  if (!options) return found;
  planning::visit_options(OldNameFinder{*options, found});
  if (const auto limits = options->optional_member("limits")) {
    planning::visit_limits(OldNameFinder{*limits, found});
  }
  return found;
}

}  // namespace

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
