// SPDX-License-Identifier: MIT
#include "tools/view/page/embed/embedded_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace camway::view {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The most bytes of the page as it is sent.
constexpr std::size_t kMostBytes = 350'000;
/// The most bytes of the script of a report.
constexpr std::size_t kMostReportBytes = 10'000;

class EmbeddedPage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (page_.script.text.empty()) {
      GTEST_SKIP() << "the program was built without its page";
    }
  }
  const PageFiles page_ = embedded_page();
};

TEST(PageOfTheProgram, IsThereInAnyCase) {
  const PageFiles page = embedded_page();
  EXPECT_THAT(std::string(page.html.text), StartsWith("<!doctype html>"));
  EXPECT_THAT(std::string(page.html.gzip), StartsWith("\x1f\x8b"));
  EXPECT_EQ(page.script.text.empty(), page.script.gzip.empty());
}

TEST_F(EmbeddedPage, IsSmall) {
  const std::size_t bytes =
      page_.html.gzip.size() + page_.script.gzip.size() + page_.style.gzip.size();
  RecordProperty("bytes", static_cast<int>(bytes));
  EXPECT_LE(bytes, kMostBytes);
  EXPECT_LT(page_.script.gzip.size(), page_.script.text.size());
}

TEST_F(EmbeddedPage, HasThePlacesOfScriptAndStyle) {
  const std::string html(page_.html.text);
  EXPECT_THAT(html, HasSubstr(R"(<link rel="stylesheet" href="/page.css">)"));
  EXPECT_THAT(html, HasSubstr(R"(<script defer src="/page.js"></script>)"));
  EXPECT_THAT(html, HasSubstr("</body>"));
}

TEST_F(EmbeddedPage, APageThatHoldsAllMayAskNobody) {
  const std::string policy(page_.inline_policy);
  EXPECT_THAT(policy, StartsWith("default-src 'none'; script-src 'sha256-"));
  EXPECT_EQ(policy.find("connect-src"), std::string::npos);
  EXPECT_EQ(policy.find('\n'), std::string::npos);
}

TEST_F(EmbeddedPage, AReportMayRunItsScriptAndThatOfTheReviewsInIt) {
  EXPECT_FALSE(page_.report_script.empty());
  EXPECT_LT(page_.report_script.size(), kMostReportBytes);
  const std::string policy(page_.report_policy);
  EXPECT_THAT(policy, StartsWith("default-src 'none'; script-src 'sha256-"));
  const std::string review(page_.inline_policy);
  const std::size_t hash = review.find("'sha256-");
  EXPECT_THAT(policy, HasSubstr(review.substr(hash, review.find("' ", hash) - hash)));
  EXPECT_EQ(policy.find("connect-src"), std::string::npos);
  EXPECT_EQ(policy.find("script-src 'unsafe-inline'"), std::string::npos);
}

}  // namespace
}  // namespace camway::view
