// SPDX-License-Identifier: MIT
#include "tools/json/json_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct BadDocument {
  const char* text;
  const char* expected;
};

TEST(JsonDocument, NamesSourceLineAndColumnOfBadSyntax) {
  const BadDocument cases[] = {
      {"{", "line 1, column"},
      {"{\n  \"a\": 1,\n  \"b\" 2\n}", "line 3, column 7"},
      {"{\"a\": NaN}", "line 1, column 7"},
      {"{\"a\": Infinity}", "line 1, column 7"},
      {"[1, 2,]", "line 1, column 7"},
      {"[1] [2]", "line 1, column 5"},
      {"\"\xff\"", "line 1, column 2"},
      {"[1,\n 1e999]", "line 2, column 6: number overflow"},
      {"[-1e999]", "number overflow"},
  };
  for (const BadDocument& bad : cases) {
    const auto parsed = parse_document(bad.text, "R.json");
    EXPECT_FALSE(parsed) << bad.text;
    EXPECT_THAT(parsed.error, StartsWith("R.json: ")) << bad.text;
    EXPECT_THAT(parsed.error, HasSubstr(bad.expected)) << bad.text;
    EXPECT_THAT(parsed.error, ::testing::Not(HasSubstr("json.exception"))) << bad.text;
  }
}

TEST(JsonDocument, SaysSoWhereThereIsNothing) {
  for (const char* nothing : {"", " \n\t"}) {
    EXPECT_EQ(parse_document(nothing, "a.json", 10).error, "a.json: is empty");
  }
}

TEST(JsonDocument, RefusesAKeyThatStandsTwice) {
  const auto parsed = parse_document(R"({"a": {"near": 1, "near": 2}})", "R.json");
  EXPECT_FALSE(parsed);
  EXPECT_EQ(parsed.error, "R.json: line 1, column 24: the key 'near' stands twice");
  EXPECT_EQ(parse_document("{\"a\": 1,\n \"b\": [\n],\n  \"a\" : 2}", "R.json").error,
            "R.json: line 4, column 5: the key 'a' stands twice");
}

TEST(JsonDocument, RefusesDeepNestingAndTakesWhatIsJustNotTooDeep) {
  const std::string just(kMaxDocumentDepth, '[');
  const std::string closed = just + std::string(kMaxDocumentDepth, ']');
  EXPECT_TRUE(parse_document(closed, "R.json"));
  const auto deeper = parse_document("[" + closed + "]", "R.json");
  EXPECT_FALSE(deeper);
  EXPECT_THAT(deeper.error, HasSubstr("line 1, column 33: nested deeper than 32"));
  // Deep enough to exhaust the stack of a recursive reader.
  EXPECT_FALSE(parse_document(std::string(5'000'000, '['), "R.json"));
}

TEST(JsonDocument, RefusesMoreValuesThanItsLimit) {
  constexpr std::string_view kTenValues = R"([0, "a", true, null, {"b": [1.5, 2], "c": {}}])";
  EXPECT_TRUE(parse_document(kTenValues, "R.json"));
  EXPECT_TRUE(parse_document(kTenValues, "R.json", 10));
  const auto parsed = parse_document(kTenValues, "R.json", 9);
  EXPECT_FALSE(parsed);
  EXPECT_THAT(parsed.error, HasSubstr("more than 9 values"));
}

TEST(JsonDocument, SaysWhyAFileCannotBeRead) {
  EXPECT_THAT(read_text("/nonexistent/R.json").error, HasSubstr("/nonexistent/R.json: cannot"));
  EXPECT_THAT(read_text("/").error, HasSubstr("/: is a directory"));
}

TEST(Field, ReportsTheFirstErrorWithItsPath) {
  const auto document = parse_document(R"({"list": [{"a": 1}, {"a": "x", "b": true}]})", "R.json");
  ASSERT_TRUE(document);
  DocumentNotes notes;
  const std::string& error = notes.error;
  const Field root(*document, notes);
  const Field list = root.member("list");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list.element(0).member("a").number(), 1.0);
  EXPECT_EQ(error, "");
  const Field second = list.element(1);
  EXPECT_EQ(second.member("a").number(), 0.0);
  EXPECT_EQ(error, "list[1].a: must be a number, not a string");
  EXPECT_EQ(second.member("b").text(), "");
  EXPECT_EQ(root.member("nothing").number(), 0.0);
  EXPECT_EQ(error, "list[1].a: must be a number, not a string");
}

TEST(Field, NotesOldNames) {
  const auto document = parse_document(R"({"list": [{"a": 1}, {"old_a": 2}]})", "R.json");
  ASSERT_TRUE(document);
  DocumentNotes notes;
  const Field root(*document, notes);
  const Field list = root.member("list");
  EXPECT_EQ(list.element(0).member("a", "old_a").number(), 1.0);
  EXPECT_EQ(list.element(1).member("a", "old_a").number(), 2.0);
  ASSERT_EQ(notes.old_names.size(), 1U);
  EXPECT_EQ(notes.old_names["list[1].a"], "list[1].old_a");
}

TEST(Field, TakesWholeNumbersWithinTheirRangeOnly) {
  const auto document = parse_document("[7, 7.0, -1, 18446744073709551615, \"7\"]", "R.json");
  ASSERT_TRUE(document);
  const auto error_of = [&](std::size_t index) {
    DocumentNotes notes;
    static_cast<void>(Field(*document, notes).element(index).integer(0, 100));
    return notes.error;
  };
  EXPECT_EQ(error_of(0), "");
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_THAT(error_of(i), StartsWith("[" + std::to_string(i) + "]: "));
    EXPECT_THAT(error_of(i), HasSubstr("must be a whole number from 0 to 100"));
  }
}

}  // namespace
}  // namespace camway::tools
