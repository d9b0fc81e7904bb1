// SPDX-License-Identifier: MIT
#include "daemon/cli_support/flag_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>

namespace camway::cli_support {
namespace {

using ::testing::HasSubstr;

enum class Colour : std::uint8_t { kRed, kGreen };

struct Values {
  double length_m = 1.0;
  int count = 1;
  std::optional<Colour> colour;
  std::vector<std::string> files;
  std::string out;
  std::vector<double> box_m;
  bool is_dry = false;
};

/// How often the command ran.
int runs = 0;

/// Returns the error of a program with two commands for `words`; empty if it accepts them.
std::string said_of(const std::vector<std::string>& words) {
  static constexpr std::array<std::pair<std::string_view, Colour>, 2> kColours{
      {{"red", Colour::kRed}, {"green", Colour::kGreen}}};
  CLI::App app("", "tool");
  app.require_subcommand(1);
  Values values;
  CLI::App* const paint = app.add_subcommand("paint", "");
  paint->add_option("--length", values.length_m)->check(above_0());
  paint->add_option("--count", values.count)->check(whole_number(1, 9));
  paint->add_option("--file", values.files)->required();
  paint->add_option("--out", values.out);
  paint->add_option("--picture", values.out)->type_name("FILE");
  add_numbers(*paint, "--box", values.box_m, "X,Y,Z", "",
              {"above 0", [](double value) { return value > 0.0; }});
  paint->add_flag("--dry", values.is_dry);
  paint->callback([] { ++runs; });
  add_choice(*paint, "--colour", values.colour, kColours, "");
  CLI::App* const scene = app.add_subcommand("scene", "");
  scene->require_subcommand(1);
  scene->add_subcommand("upload", "");
  refuse_missing_values(app);
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    app.parse(reversed);
    return {};
  } catch (const CLI::ParseError& error) {
    return command_line_fault(app, error);
  }
}

TEST(CommandLine, UnknownWordsAreNamedWithTheNearestRightOneAndTheHelp) {
  const std::pair<std::vector<std::string>, const char*> kCases[] = {
      {{"pant"}, "'pant' is no command of tool; did you mean paint? (see tool --help)"},
      {{"apint", "--file", "a"}, "'apint' is no command of tool; did you mean paint?"},
      {{"walk"}, "'walk' is no command of tool (see tool --help)"},
      {{"scene", "uplaod"},
       "'uplaod' is no command of tool scene; did you mean upload? (see tool scene --help)"},
      // Although --file is missing, too: the unknown word is mostly the mistake.
      {{"paint", "--fiel", "a"},
       "'--fiel' is no flag of tool paint; did you mean --file? (see tool paint --help)"},
      {{"paint", "--file", "a", "--lenght=2"},
       "'--lenght' is no flag of tool paint; did you mean --length?"},
      {{"paint", "--file", "a", "--weight", "2"}, "'--weight' is no flag of tool paint (see"},
      {{"paint", "b"}, "'b' is a word too many for tool paint; did you mean --file b? (see"},
      {{}, "a command is missing: paint, scene (see tool --help)"},
      {{"scene"}, "a command is missing: upload (see tool scene --help)"},
      {{"paint"}, "--file is required (see tool paint --help)"},
  };
  for (const auto& [words, said] : kCases) EXPECT_THAT(said_of(words), HasSubstr(said));
  EXPECT_EQ(said_of({"paint", "--file", "a", "--colour", "red", "--count", "9"}), "");
}

TEST(CommandLine, ValuesOutOfRangeAreToldInWordsAndShortNumbers) {
  const std::pair<std::vector<std::string>, const char*> kCases[] = {
      {{"--length", "-1"}, "--length: must be a number above 0, not '-1' (see tool paint --help)"},
      {{"--length", "inf"}, "--length: must be a number above 0, not 'inf'"},
      {{"--length", "nan"}, "--length: must be a number above 0, not 'nan'"},
      {{"--length", "2m"}, "--length: must be a number above 0, not '2m'"},
      {{"--count", "10"}, "--count: must be a whole number, 1 to 9, not '10'"},
      {{"--count", "1.5"}, "--count: must be a whole number, 1 to 9, not '1.5'"},
      {{"--count", "99999999999999999999"}, "--count: must be a whole number"},
      {{"--box", "1,nan,1"},
       "--box: must be X,Y,Z, each a number above 0, not 'nan' (see tool paint --help)"},
      {{"--box", "1,1,x"}, "--box: must be X,Y,Z, each a number above 0, not 'x'"},
      {{"--colour", "gren"},
       "--colour: must be one of red, green, not 'gren'; did you mean green?"},
      {{"--colour", "blue"}, "--colour: must be one of red, green, not 'blue' (see"},
  };
  for (const auto& [flags, said] : kCases) {
    std::vector<std::string> words{"paint", "--file", "a"};
    words.insert(words.end(), flags.begin(), flags.end());
    EXPECT_THAT(said_of(words), HasSubstr(said));
  }
}

TEST(CommandLine, AFlagWithoutItsValueIsNamed) {
  const std::pair<std::vector<std::string>, const char*> kCases[] = {
      // "2" is no word too many.
      {{"--length", "--count", "2"}, "--length: needs a value; '--count' is a flag (see tool pai"},
      {{"--length", "--count=2"}, "--length: needs a value; '--count' is a flag"},
      {{"--out", "--dry"}, "--out: needs a value; '--dry' is a flag"},
      {{"--out", "--help"}, "--out: needs a value; '--help' is a flag"},
      {{"--out", "-h"}, "--out: needs a value; '-h' is a flag"},
      {{"--file", "--out", "b"}, "--file: needs a value; '--out' is a flag"},
      {{"--box", "--out", "b"}, "--box: needs a value; '--out' is a flag"},
      {{"--length"}, "--length: needs a value (see tool paint --help)"},
      {{"--length", "1", "--length"}, "--length: needs a value"},
      {{"--box"}, "--box: needs a value"},
      {{"b", "--file"}, "--file: needs a value"},
      {{"--picture", ""}, "--picture: needs a value; it is empty (see tool paint --help)"},
      {{"--picture="}, "--picture: needs a value"},
  };
  const int before = runs;
  for (const auto& [flags, said] : kCases) {
    std::vector<std::string> words{"paint", "--file", "a"};
    words.insert(words.end(), flags.begin(), flags.end());
    EXPECT_THAT(said_of(words), HasSubstr(said)) << ::testing::PrintToString(flags);
  }
  EXPECT_EQ(runs, before) << "a command ran though its line was wrong";
  EXPECT_EQ(said_of({"paint", "--file", "a", "--out", "--fiel"}), "") << "is no flag";
  EXPECT_EQ(said_of({"paint", "--file", "a", "--out", "./--dry"}), "");
  EXPECT_EQ(runs, before + 2);
}

TEST(CommandLine, AWrongNumberOfValuesIsToldInWords) {
  const std::pair<std::vector<std::string>, const char*> kCases[] = {
      {{"--length", "1", "--length", "2"}, "--length: given twice (see tool paint --help)"},
      {{"--length=1", "--length=2", "--length=3"}, "--length: given 3 times"},
      {{"--colour", "red", "--colour", "red"}, "--colour: given twice"},
      {{"--box", "1,1,1", "--box", "2,2,2"}, "--box: given twice"},
      {{"--box", "1", "1", "1", "--box", "2,2,2"}, "--box: given twice"},
      {{"--box", "1,1"}, "--box: takes 3 values (X,Y,Z), not 2"},
      {{"--box", "1,1,1,1"}, "--box: takes 3 values (X,Y,Z), not 4"},
      {{"--box", "1,1,1,1,1,1"}, "--box: takes 3 values (X,Y,Z), not 6"},
      {{"--box", "1,1", "--box", "1,1"}, "--box: takes 3 values (X,Y,Z), not 4"},
      {{"--box", "1,1,1", "b"}, "'b' is a word too many"},
  };
  for (const auto& [flags, said] : kCases) {
    std::vector<std::string> words{"paint", "--file=a"};
    words.insert(words.end(), flags.begin(), flags.end());
    EXPECT_THAT(said_of(words), HasSubstr(said)) << ::testing::PrintToString(flags);
  }
  EXPECT_EQ(said_of({"paint", "--file", "a", "--file", "b", "--box", "1", "2", "3"}), "");
  EXPECT_EQ(said_of({"paint", "--file", "a", "--dry", "--dry"}), "") << "says nothing else";
}

TEST(CommandLine, TheNearestWordIsNotFar) {
  const std::vector<std::string> words{"plan", "check", "info", "occupancy", "up"};
  EXPECT_EQ(nearest_word("paln", words), "plan");
  EXPECT_EQ(nearest_word("chek", words), "check");
  EXPECT_EQ(nearest_word("ocupency", words), "occupancy");
  EXPECT_EQ(nearest_word("plan", words), "plan");
  EXPECT_EQ(nearest_word("draw", words), "");
  EXPECT_EQ(nearest_word("pu", words), "up") << "swapped letters count as one change";
  EXPECT_EQ(nearest_word("xy", words), "") << "two changes make any word of two letters";
  EXPECT_EQ(nearest_word("", words), "");
}

TEST(CommandLine, RangesHaveTheirEnds) {
  const auto passes = [](const CLI::Validator& check, std::string text) {
    return check(text).empty();
  };
  EXPECT_TRUE(passes(at_least_0(), "0"));
  EXPECT_FALSE(passes(at_least_0(), "-1e-300"));
  EXPECT_TRUE(passes(between(0.5, 2.0), "0.5"));
  EXPECT_TRUE(passes(between(0.5, 2.0), "2"));
  EXPECT_FALSE(passes(between(0.5, 2.0), "2.001"));
  EXPECT_FALSE(passes(above_0(), "0"));
  EXPECT_FALSE(passes(above_0(), ""));
  EXPECT_TRUE(passes(whole_number(1), "9223372036854775807"));
  EXPECT_FALSE(passes(whole_number(1), "9223372036854775808"));
  EXPECT_FALSE(passes(whole_number(1), "0"));
  EXPECT_TRUE(passes(numbers_in("X", {}), "-1e300"));
  EXPECT_FALSE(passes(numbers_in("X", {}), "inf"));
}

}  // namespace
}  // namespace camway::cli_support
