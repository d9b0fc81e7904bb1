// SPDX-License-Identifier: MIT
#include "tools/json/option_fields.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/planning/request/option_table.h"
#include "tools/json/json_request.h"

namespace camway::tools {
namespace {

using nlohmann::json;
using planning::PlanOptions;

json fields() { return json::parse(option_fields_json()).at("fields"); }

/// The defaults of fields, as an object that a request may have.
json defaults_of(const json& list) {
  json object = json::object();
  for (const json& field : list) {
    if (field.contains("default")) object[field.at("name")] = field.at("default");
  }
  return object;
}

const json& field_of(const json& list, const std::string& name) {
  for (const json& field : list) {
    if (field.at("name") == name) return field;
  }
  throw std::runtime_error("no field " + name);
}

TEST(OptionFields, TheirDefaultsAreThoseOfARequestWithoutOptions) {
  const auto options = parse_as<PlanOptions>(defaults_of(fields()).dump(), "defaults");
  ASSERT_TRUE(options) << options.error;
  EXPECT_EQ(*options, PlanOptions());
}

TEST(OptionFields, NameEveryOptionWithItsHelp) {
  const json list = fields();
  std::set<std::string> names;
  planning::visit_specs<PlanOptions>([&](const planning::FieldSpec& spec) {
    const json& field = field_of(list, std::string(spec.file_name()));
    EXPECT_EQ(field.at("help"), spec.help);
    EXPECT_EQ(field.contains("range"), spec.range.any());
    names.insert(field.at("name"));
  });
  EXPECT_EQ(names.size(), list.size());
}

TEST(OptionFields, EachChoiceIsReadAndNoOther) {
  for (const json& field : fields()) {
    if (field.at("type") != "choice") continue;
    for (const json& choice : field.at("choices")) {
      const json one{{field.at("name"), choice}};
      EXPECT_TRUE(parse_as<PlanOptions>(one.dump(), "choice")) << one;
    }
    const json other{{field.at("name"), "other"}};
    EXPECT_FALSE(parse_as<PlanOptions>(other.dump(), "choice"));
  }
}

TEST(OptionFields, SayUnitsAndRangesAsFilesHaveThem) {
  const json list = fields();
  EXPECT_EQ(field_of(list, "clearance_m").at("unit"), "m");
  EXPECT_EQ(field_of(list, "deadline_s").at("unit"), "s");
  EXPECT_EQ(field_of(list, "default_speed_m_per_s").at("unset"), "1");
  EXPECT_EQ(field_of(list, "max_shrink").at("least"), 0.0);
  EXPECT_EQ(field_of(list, "max_shrink").at("most"), 1.0);
  const json& orientation = field_of(list, "orientation");
  EXPECT_EQ(orientation.at("type"), "object");
  const json& turn = field_of(orientation.at("fields"), "max_turn_deg");
  EXPECT_EQ(turn.at("most"), 180.0);
  EXPECT_EQ(turn.at("default"), 180.0);
  EXPECT_EQ(turn.at("unit"), "°");
  const json& limits = field_of(list, "limits").at("fields");
  EXPECT_EQ(field_of(limits, "acceleration_m_per_s2").at("unit"), "m/s²");
  EXPECT_FALSE(field_of(limits, "speed_m_per_s").contains("default")) << "no limit";
  EXPECT_EQ(field_of(field_of(list, "bounds").at("fields"), "min").at("type"), "vector");
}

}  // namespace
}  // namespace camway::tools
