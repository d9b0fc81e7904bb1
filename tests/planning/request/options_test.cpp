// SPDX-License-Identifier: MIT
#include "daemon/planning/request/options.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

#include "daemon/motion/spline/derive_times.h"
#include "daemon/planning/request/option_table.h"

namespace camway::planning {
namespace {

/// Returns the default of an option as a cell of the table.
template <class Member>
std::string default_text(const FieldSpec& spec, const Member& member) {
  if (!spec.unset.empty())
    return spec.unset[0] == '{' ? fmt::format("`{}`", spec.unset) : std::string(spec.unset);
  if constexpr (base::NamedEnum<Member>) {
    return fmt::format("`{}`", base::name_of(member));
  } else if constexpr (std::is_same_v<Member, bool>) {
    return fmt::format("`{}`", member);
  } else if constexpr (std::is_arithmetic_v<Member>) {
    return fmt::format("{}", member);
  } else {
    return "an option of this type has to say its default";
  }
}

std::vector<std::string> expected_rows() {
  std::vector<std::string> rows;
  const PlanOptions defaults;
  const auto add = [&rows](const FieldSpec& spec, const auto& member) {
    rows.push_back(fmt::format("| `{}` | {}{} | {} | {} |", spec.file_name(), spec.help,
                               spec.has_section ? "; see below" : "",
                               spec.range.any() ? spec.range_text() : "",
                               default_text(spec, member)));
  };
  visit_table(add, defaults);
  return rows;
}

/// Returns the rows of the table under the heading "## Options".
std::vector<std::string> rows_in_document() {
  std::ifstream document(CAMWAY_REQUESTS_PAGE);
  std::vector<std::string> rows;
  std::string line;
  while (std::getline(document, line) && line != "## Options") {
  }
  while (std::getline(document, line) && !line.starts_with("**") && !line.starts_with("## ")) {
    if (line.starts_with("| `")) rows.push_back(line);
  }
  return rows;
}

// The order differs: the page begins with the most common options.
TEST(OptionTable, IsThatOfTheDocuments) {
  const std::vector<std::string> rows = rows_in_document();
  for (const std::string& expected : expected_rows()) {
    EXPECT_EQ(std::ranges::count(rows, expected), 1) << "docs/requests.md needs this row:\n"
                                                     << expected;
  }
  EXPECT_EQ(rows.size(), expected_rows().size())
      << "docs/requests.md has an option that does not exist";
}

TEST(OptionTable, NamesTheSpeedThatDerivedTimesHave) {
  EXPECT_EQ(option::kDefaultSpeed.unset, fmt::format("{}", motion::kNominalSpeed_m_per_s));
}

TEST(OptionTable, RangesReadAsSentences) {
  EXPECT_EQ(option::kDeadline.range_text(), "above 0 and finite");
  EXPECT_EQ(option::kMaxShrink.range_text(), "at least 0 and below 1");
  EXPECT_EQ(option::kDefaultSpeed.range_text(), "from 1e-06 to 1e+06");
  std::vector<std::string> angles;
  visit_specs<correction::OrientationPolicy>([&](const FieldSpec& spec) {
    if (spec.is_angle()) angles.push_back(spec.range_text());
  });
  visit_specs<correction::MotionLimits>([](const FieldSpec& spec) {
    if (spec.range.any()) {
      EXPECT_EQ(spec.range_text(), "above 0") << spec.name;
    }
  });
  EXPECT_EQ(angles, (std::vector<std::string>{"above 0 and at most 180 degrees",
                                              "between 0 and 180 degrees"}));
}

TEST(OptionTable, MembersAreSpelledAsMessagesAndFilesHaveThem) {
  EXPECT_EQ(spell("options.clearance_m", Spelling::kWire), "options.clearance_m");
  EXPECT_EQ(spell("options.clearance_m", Spelling::kFile), "options.clearance_m");
  EXPECT_EQ(spell("options.limits.turn_rate", Spelling::kWire),
            "options.limits.turn_rate_rad_per_s");
  EXPECT_EQ(spell("options.limits.turn_rate", Spelling::kFile),
            "options.limits.turn_rate_deg_per_s");
  EXPECT_EQ(spell("camera.fov_x", Spelling::kWire), "camera.fov_x_rad");
  EXPECT_EQ(spell("keyframes[3].time", Spelling::kWire), "keyframes[3].time_s");
  EXPECT_EQ(spell("keyframes[3].time", Spelling::kFile), "keyframes[3].time");
  EXPECT_EQ(spell("keyframes[3].image", Spelling::kWire), "keyframes[3].image");
  EXPECT_EQ(spell("body.size[2]", Spelling::kWire), "body.size_m[2]");
  EXPECT_EQ(spell("body.size[2]", Spelling::kFile), "body.size[2]");
  EXPECT_EQ(spell("camera", Spelling::kWire), "camera");
}

}  // namespace
}  // namespace camway::planning
