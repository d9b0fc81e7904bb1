// SPDX-License-Identifier: MIT
#include "tools/json/option_fields.h"

#include <array>
#include <cmath>
#include <concepts>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/named_enum.h"
#include "daemon/planning/request/option_table.h"
#include "daemon/planning/request/options.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using Json = nlohmann::ordered_json;
using planning::FieldSpec;

/// Units by the ends of names; the longer ends first.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kUnitsByEnd{{
    {"_m_per_s2", "m/s²"},
    {"_deg_per_s", "°/s"},
    {"_m_per_s", "m/s"},
    {"_deg", "°"},
    {"_m", "m"},
    {"_s", "s"},
}};

std::string_view unit_of(const FieldSpec& spec) {
  if (!spec.unit.empty()) return spec.unit;
  for (const auto& [end, unit] : kUnitsByEnd) {
    if (spec.file_name().ends_with(end)) return unit;
  }
  return {};
}

/// Returns a value as files have it.
double in_files(const FieldSpec& spec, double value) {
  return spec.is_angle() ? degrees(value) : value;
}

void add_range(const FieldSpec& spec, Json& entry) {
  if (!spec.range.any()) return;
  entry["range"] = spec.range_text();
  entry["least"] = in_files(spec, spec.range.least);
  if (std::isfinite(spec.range.most)) entry["most"] = in_files(spec, spec.range.most);
}

/// Adds the default that the table names: an object as it is, a sentence as `unset`.
void add_unset(const FieldSpec& spec, Json& entry) {
  if (spec.unset.empty()) return;
  if (spec.unset.starts_with('{')) {
    entry["default"] = Json::parse(spec.unset);
  } else {
    entry["unset"] = spec.unset;
  }
}

template <class Struct>
Json fields_of(const Struct& defaults);

void add_value(const FieldSpec&, bool value, Json& entry) {
  entry["type"] = "boolean";
  entry["default"] = value;
}
void add_value(const FieldSpec& spec, double value, Json& entry) {
  entry["type"] = "number";
  if (std::isfinite(value)) entry["default"] = in_files(spec, value);
}
void add_value(const FieldSpec&, const std::optional<double>&, Json& entry) {
  entry["type"] = "number";
}
template <class Count>
requires std::integral<Count>
void add_value(const FieldSpec&, Count value, Json& entry) {
  entry["type"] = "count";
  entry["default"] = value;
}
template <base::NamedEnum Choice>
void add_value(const FieldSpec&, Choice value, Json& entry) {
  entry["type"] = "choice";
  entry["default"] = base::name_of(value);
  entry["choices"] = names_of(value);
}
void add_value(const FieldSpec&, const geometry::Vec3& value, Json& entry) {
  entry["type"] = "vector";
  entry["default"] = {value.x(), value.y(), value.z()};
}
void add_value(const FieldSpec&, const std::array<std::optional<double>, 3>&, Json& entry) {
  entry["type"] = "vector";
}
void add_value(const FieldSpec&, const geometry::Bounds& bounds, Json& entry) {
  entry["type"] = "object";
  entry["fields"] = fields_of(geometry::optional_bounds_of(bounds));
}
template <class Struct>
requires std::is_class_v<Struct>
void add_value(const FieldSpec&, const Struct& defaults, Json& entry) {
  entry["type"] = "object";
  entry["fields"] = fields_of(defaults);
}

template <class Struct>
Json fields_of(const Struct& defaults) {
  Json list = Json::array();
  const auto add = [&list](const FieldSpec& spec, const auto& value) {
    Json entry{{"name", spec.file_name()}};
    add_value(spec, value, entry);
    if (const std::string_view unit = unit_of(spec); !unit.empty()) entry["unit"] = unit;
    add_range(spec, entry);
    add_unset(spec, entry);
    entry["help"] = spec.help;
    list.push_back(std::move(entry));
  };
  planning::visit_table(add, defaults);
  return list;
}

}  // namespace

std::string option_fields_json() {
  Json root;
  root["fields"] = fields_of(planning::PlanOptions());
  return root.dump();
}

}  // namespace camway::tools
