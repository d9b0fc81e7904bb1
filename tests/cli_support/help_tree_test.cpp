// SPDX-License-Identifier: MIT
#include "daemon/cli_support/help_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "daemon/cli_support/flag_checks.h"

namespace camway::cli_support {
namespace {

using Json = nlohmann::json;

/// Returns the option of `command` with that flag or word.
Json option_of(const Json& command, const std::string& name) {
  for (const Json& option : command["options"]) {
    const Json& names = option["names"];
    if (option["word"] == name || std::count(names.begin(), names.end(), name) > 0) return option;
  }
  return {};
}

class HelpTree : public testing::Test {
 protected:
  HelpTree() {
    CLI::App* const load = app_.add_subcommand("load", "Loads");
    load->footer("Example: program load");
    load->add_option("FILE", file_, "What is loaded")->required()->type_name("FILE");
    CLI::Option* const up =
        load->add_option("-u,--up", up_, "Which way")->check(one_of({"y", "z"}));
    load->add_option("--size", sizes_, "How large")->check(above_0())->excludes(up)->group("More");
    load->add_flag("--fast", is_fast_, "Soon")->needs(up);
    load->add_flag("--secret", is_fast_, "For nobody")->group("");
  }

  [[nodiscard]] Json tree() const { return Json::parse(help_tree(app_)); }

  CLI::App app_{"A program", "program"};
  std::string file_;
  std::string up_;
  std::vector<double> sizes_;
  bool is_fast_ = false;
};

TEST_F(HelpTree, HasTheCommandsWithTheirTexts) {
  EXPECT_EQ(tree()["name"], "program");
  EXPECT_EQ(tree()["description"], "A program");
  ASSERT_EQ(tree()["commands"].size(), 1U);
  EXPECT_EQ(tree()["commands"][0]["name"], "load");
  EXPECT_EQ(tree()["commands"][0]["footer"], "Example: program load");
}

TEST_F(HelpTree, TellsFlagsFromWordsAndSwitchesFromValues) {
  const Json load = tree()["commands"][0];
  EXPECT_EQ(option_of(load, "--up")["names"], Json({"-u", "--up"}));
  EXPECT_TRUE(option_of(load, "FILE")["names"].empty());
  EXPECT_EQ(option_of(load, "FILE")["required"], true);
  EXPECT_EQ(option_of(load, "FILE")["form"], "FILE");
  EXPECT_EQ(option_of(load, "--fast")["form"], "");
  EXPECT_NE(option_of(load, "--size")["form"], "");
}

TEST_F(HelpTree, SaysWhatAnOptionTakesAndWithWhich) {
  const Json load = tree()["commands"][0];
  EXPECT_EQ(option_of(load, "--up")["check"], "y|z");
  EXPECT_EQ(option_of(load, "--size")["check"], "above 0");
  EXPECT_EQ(option_of(load, "--size")["repeats"], true);
  EXPECT_EQ(option_of(load, "--up")["repeats"], false);
  EXPECT_EQ(option_of(load, "--size")["group"], "More");
  EXPECT_EQ(option_of(load, "--size")["excludes"], Json({"--up"}));
  EXPECT_EQ(option_of(load, "--fast")["needs"], Json({"--up"}));
}

TEST_F(HelpTree, LeavesOutWhatTheHelpHides) {
  EXPECT_TRUE(option_of(tree()["commands"][0], "--secret").is_null());
}

TEST(HelpTreeFlag, IsTheOnlyWordOfItsCommandLine) {
  const std::array<const char*, 3> words{"program", "--help-tree", "load"};
  EXPECT_TRUE(asks_for_help_tree(2, words.data()));
  EXPECT_FALSE(asks_for_help_tree(3, words.data()));
  EXPECT_FALSE(asks_for_help_tree(1, words.data()));
}

}  // namespace
}  // namespace camway::cli_support
