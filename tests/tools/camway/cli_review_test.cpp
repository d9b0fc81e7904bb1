// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// The most bytes of a review of the office.
constexpr std::size_t kMostReviewBytes = 2'000'000;

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST(CliReview, ADrawingNamedHtmlIsAPageThatHoldsAll) {
  const TemporaryFolder folder;
  const std::string scenes = CAMWAY_SCENES_FOLDER;
  const std::string request = scenes + "/requests/office-graze-column.json";
  const std::string response = folder.file("answer.json");
  const std::string page = folder.file("review.html");
  ASSERT_EQ(run_camway({"plan", "--request", request, "--response", response}).exit_code, 0);
  const CliRun run =
      run_camway({"draw", "--request", request, "--response", response, "--picture", page});
  if (run.err.find("built without its page") != std::string::npos) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string html = text_of(page);
  EXPECT_LT(html.size(), kMostReviewBytes);
  EXPECT_THAT(html, Not(HasSubstr(R"(src="/page.js")")));
  EXPECT_THAT(html, HasSubstr(R"(http-equiv="Content-Security-Policy" content="default-src)"));
  const std::string begin = R"(<script type="application/json" id="review">)";
  const std::size_t at = html.find(begin) + begin.size();
  const json data = json::parse(html.substr(at, html.find("</script>", at) - at));
  EXPECT_EQ(data.at("answer"), json::parse(text_of(response)));
  EXPECT_EQ(data.at("request").at("scene"), "office");
  EXPECT_EQ(data.at("scene").at("objects").at(0).at("name"), "office") << "no folders of others";
  EXPECT_EQ(data.at("meshes").size(), 1U);
  EXPECT_FALSE(data.at("triangles").empty());
}

}  // namespace
}  // namespace camway::tools
