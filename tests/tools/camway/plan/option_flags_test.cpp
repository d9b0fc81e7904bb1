// SPDX-License-Identifier: MIT
#include "tools/camway/plan/option_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "daemon/planning/request/option_table.h"
#include "tools/json/json_request.h"

namespace camway::tools {
namespace {

using planning::FieldSpec;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Parses `arguments` and applies them to a request with default options.
planning::PlanRequest request_with(std::vector<std::string> arguments) {
  OptionFlags flags;
  CLI::App app;
  flags.add_to(app);
  std::ranges::reverse(arguments);  // as CLI11 takes them
  app.parse(arguments);
  planning::PlanRequest request;
  request.spelling = json_spelling();
  flags.apply(request);
  return request;
}

TEST(OptionFlags, EveryNumberNameAndSwitchHasAFlag) {
  OptionFlags flags;
  CLI::App app;
  flags.add_to(app);
  const std::string help = app.help();
  const planning::PlanOptions options;
  planning::visit_table(
      [&](const FieldSpec& spec, const auto& member) {
        using Member = std::remove_cvref_t<decltype(member)>;
        constexpr bool kIsObject =
            std::is_class_v<Member> && !std::is_same_v<Member, std::optional<double>>;
        std::string flag = "--" + std::string(spec.file_name());
        std::ranges::replace(flag, '_', '-');
        if (!kIsObject) {
          EXPECT_THAT(help, HasSubstr(flag + " "));
        }
      },
      options);
  EXPECT_THAT(help, HasSubstr("--max-turn-deg "));
}

TEST(OptionFlags, OverrideTheOptionsThatAreGiven) {
  EXPECT_EQ(request_with({}).options, planning::PlanOptions{});
  const planning::PlanRequest request =
      request_with({"--objective", "safest", "--clearance-m", "0.25", "--max-inserted-keyframes",
                    "7", "--repair-keyframes", "--clearance-profile", "--default-speed-m-per-s",
                    "2", "--max-turn-deg", "90"});
  planning::PlanOptions expected;
  expected.objective = correction::Objective::kSafest;
  expected.clearance_m = 0.25;
  expected.max_inserted_keyframes = 7;
  expected.repair_keyframes = true;
  expected.clearance_profile = true;
  expected.default_speed_m_per_s = 2.0;
  expected.orientation.max_turn_rad = std::numbers::pi / 2;
  EXPECT_EQ(request.options, expected);
}

TEST(OptionFlags, ErrorsNameTheFlagThatWasGiven) {
  const planning::PlanRequest request = request_with({"--max-shrink", "0.5"});
  EXPECT_EQ(request.name_of("options.max_shrink"), "--max-shrink");
  EXPECT_EQ(request.name_of("options.default_speed_m_per_s"), "options.default_speed_m_per_s");
}

TEST(OptionFlags, TheOldNameOfAFlagIsTaken) {
  const planning::PlanRequest request = request_with({"--clearance", "0.25"});
  EXPECT_EQ(request.options, request_with({"--clearance-m", "0.25"}).options);
  EXPECT_EQ(request.options.clearance_m, 0.25);
  EXPECT_EQ(request.name_of("options.clearance_m"), "--clearance");
  EXPECT_THROW(request_with({"--clearance", "-1"}), CLI::ValidationError);
  EXPECT_THAT(
      [] {
        request_with({"--clearance", "1", "--clearance-m", "1"});
      },
      ThrowsMessage<CLI::ExcludesError>(HasSubstr("--clearance-m excludes --clearance")));
}

TEST(OptionFlags, ValuesBeyondTheRangeAreRefused) {
  EXPECT_THROW(request_with({"--clearance-m", "-1"}), CLI::ValidationError);
  EXPECT_THROW(request_with({"--default-speed-m-per-s", "1e7"}), CLI::ValidationError);
  EXPECT_THROW(request_with({"--max-turn-deg", "181"}), CLI::ValidationError);
  EXPECT_THROW(request_with({"--seed", "0"}), CLI::ValidationError);
}

}  // namespace
}  // namespace camway::tools
