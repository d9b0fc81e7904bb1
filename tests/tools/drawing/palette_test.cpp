// SPDX-License-Identifier: MIT
#include "tools/drawing/palette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace camway::draw {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string hex_of(const Color& color) {
  char text[8];
  const auto byte = [](double share) { return static_cast<unsigned>(std::lround(255 * share)); };
  std::snprintf(text, sizeof text, "#%02X%02X%02X", byte(color.red), byte(color.green),
                byte(color.blue));
  return text;
}

/// Returns the text of a member of an object of the page's table.
std::string member_of(const std::string& source, const std::string& object,
                      const std::string& member) {
  const std::size_t begin = source.find("const " + object + " ");
  const std::string body = source.substr(begin, source.find('}', begin) - begin);
  std::smatch found;
  const std::regex pattern("\\b" + member + ": '([^']*)'");
  return std::regex_search(body, found, pattern) ? found[1].str() : "";
}

/// The page of `camway view` and the pictures of `camway draw` call things alike.
TEST(Palette, IsThatOfThePage) {
  const fs::path model = fs::path(CAMWAY_PAGE_SOURCES) / "model";
  const std::string page = text_of(model / "palette.ts");
  const std::vector<std::pair<std::string, Color>> colors{
      {"before", palette::kBefore},     {"collision", palette::kCollision},
      {"after", palette::kAfter},       {"corrected", palette::kCorrected},
      {"inserted", palette::kInserted}, {"infeasible", palette::kInfeasible}};
  for (const auto& [name, color] : colors) {
    EXPECT_EQ(member_of(page, "kPalette", name), hex_of(color)) << name;
  }
  EXPECT_EQ(member_of(page, "kGivenKeyframe", "light"), hex_of(palette::kGiven));
  const std::vector<std::pair<std::string, std::string_view>> words{
      {"before", names::kBefore},        {"collision", names::kCollision}, {"after", names::kAfter},
      {"corrected", names::kCorrected},  {"inserted", names::kInserted},   {"given", names::kGiven},
      {"infeasible", names::kInfeasible}};
  for (const auto& [name, word] : words) EXPECT_EQ(member_of(page, "kNames", name), word) << name;
}

}  // namespace
}  // namespace camway::draw
