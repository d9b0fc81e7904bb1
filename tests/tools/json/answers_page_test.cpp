// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/named_enum.h"
#include "tests/messages/plan_samples.h"
#include "tools/json/json_response.h"

/// docs/answers.md names every member that an answer can have, and no other.
namespace camway::tools {
namespace {

std::vector<std::string> lines_of_page() {
  std::ifstream page(CAMWAY_ANSWERS_PAGE);
  std::vector<std::string> lines;
  for (std::string line; std::getline(page, line);) lines.push_back(line);
  return lines;
}

void add_words(const std::string& text, std::set<std::string>& words) {
  std::string word;
  for (const char c : text + ' ') {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word += c;
    } else if (!word.empty()) {
      words.insert(std::exchange(word, {}));
    }
  }
}

/// Returns the words in `code` of a line.
std::set<std::string> code_of(const std::string& line) {
  std::set<std::string> words;
  std::istringstream parts(line);
  bool is_code = false;
  for (std::string part; std::getline(parts, part, '`'); is_code = !is_code) {
    if (is_code) add_words(part, words);
  }
  return words;
}

/// Returns the words in code of the page, that of blocks included.
std::set<std::string> code_of_page() {
  std::set<std::string> words;
  bool is_block = false;
  for (const std::string& line : lines_of_page()) {
    if (line.starts_with("```")) {
      is_block = !is_block;
    } else if (is_block) {
      add_words(line, words);
    } else {
      words.merge(code_of(line));
    }
  }
  return words;
}

/// Returns the words in code of the first column of all tables whose first column is `title`.
std::set<std::string> first_column(const std::string& title) {
  std::set<std::string> words;
  bool is_table = false;
  for (const std::string& line : lines_of_page()) {
    if (line.starts_with("| " + title + " |")) is_table = true;
    if (!line.starts_with("|")) is_table = false;
    if (is_table) words.merge(code_of(line.substr(0, line.find('|', 1))));
  }
  return words;
}

void add_names(const nlohmann::json& value, std::set<std::string>& names) {
  for (const auto& [name, member] : value.items()) {
    if (value.is_object()) names.insert(name);
    if (member.is_structured()) add_names(member, names);
  }
}

/// Returns the names of all members that occur in the answers of random results.
std::set<std::string> names_in_answers() {
  testing::Random random(testing::kSeed);
  std::set<std::string> names;
  for (int trial = 0; trial < 50; ++trial) {
    planning::PlanResult result = testing::sample_result(3, random);
    result.keyframe = 1;
    result.viewing_distance_m = 4.5;
    const auto text =
        write_plan_response(result, {.scene = "room",
                                     .scene_digest = "0",
                                     .scene_reading = scene::ImportOptions{.voxel_m = 0.1},
                                     .vertical_axis = scene::VerticalAxis::kZ,
                                     .warnings = {"w"}});
    if (!text) ADD_FAILURE() << text.error;
    add_names(nlohmann::json::parse(text.value.value_or("{}")), names);
  }
  return names;
}

TEST(AnswersPage, NamesEveryMember) {
  const std::set<std::string> words = code_of_page();
  for (const std::string& name : names_in_answers()) {
    EXPECT_TRUE(words.contains(name)) << "docs/answers.md does not name " << name;
  }
}

TEST(AnswersPage, ItsTablesNameNothingElse) {
  const std::set<std::string> names = names_in_answers();
  const std::set<std::string> fields = first_column("field");
  EXPECT_GT(fields.size(), 20U);
  for (const std::string& field : fields) {
    EXPECT_TRUE(names.contains(field)) << "no answer has the " << field << " of docs/answers.md";
  }
}

TEST(AnswersPage, HasEveryStatusAndEveryKindOfCorrection) {
  std::set<std::string> expected;
  for (const auto& [name, status] : base::named_values<planning::Status>()) expected.emplace(name);
  expected.erase("unknown_scene");  // of a daemon alone
  EXPECT_EQ(first_column("status"), expected);
  const std::set<std::string> words = code_of_page();
  for (const auto& [name, kind] : base::named_values<correction::CorrectionKind>()) {
    EXPECT_TRUE(words.contains(std::string(name))) << name;
  }
}

}  // namespace
}  // namespace camway::tools
