// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/messages/plan.h"
#include "daemon/messages/text.h"
#include "daemon/planning/plan.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr char kHtml[] =
    R"(<!doctype html><meta charset="utf-8"><link rel="stylesheet" href="/page.css">)"
    R"(<script defer src="/page.js"></script><body>hall</body>)";
const view::PageFiles kPage{
    {kHtml, ""},          {"show()", ""}, {"b { color: red }", ""},
    "default-src 'none'", "sort()",       "default-src 'none'; script-src 'sha256-x'"};

/// Returns the JSON in an element of reviews; nothing if there is no such element.
std::optional<json> part(const std::string& html, const std::string& name) {
  const std::string begin = "<script type=\"application/json\" id=\"review-" + name + "\">";
  const std::size_t at = html.find(begin);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t from = at + begin.size();
  return json::parse(html.substr(from, html.find("</script>", from) - from));
}

/// Four requests past a wall: one has the same answer now, the next ones differ and regressed, and
/// the last one has no answer now.
class ReportPageTest : public ::testing::Test {
 protected:
  ReportPageTest() {
    snapshot_ = scene::make_snapshot("wall", wall_mesh()).snapshot;
    for (int id = 0; id < 4; ++id) {
      RecordedRequest& request = requests_[static_cast<std::size_t>(id)];
      request.ids = {"client", id, 0};
      request.scene = "wall";
      request.request = simple_request({{1.0 + 0.1 * id, 0, 1}, {1.0 + 0.1 * id, 0, -1}});
      planning::PlanResult result = planning::plan(*snapshot_, *request.request);
      request.answer = answer_of(result);
      ComparedRequest& item = compared_.emplace_back();
      item.recorded = &request;
      if (id == 3) continue;
      if (id == 1) result.path = other_.path;
      if (id == 2) result.status = planning::Status::kPartial;
      if (id == 0) other_ = result;
      item.now = answer_of(result);
      static_cast<Judgement&>(item) = judge(request, answers_of(item), {});
    }
    head_.title = "session";
    head_.times = Times::kHidden;
  }

  static RecordedAnswer answer_of(const planning::PlanResult& result) {
    RecordedAnswer answer;
    answer.result = messages::to_wire(result, {});
    answer.status = messages::status_name(answer.result->status);
    answer.scene_digest = "digest";
    return answer;
  }
  ReportPage page(const PageOptions& options, const view::PageFiles& files = kPage) {
    const SceneOf scene_of = [this](const RecordedRequest&) { return snapshot_; };
    return report_page(head_, compared_, scene_of, options, files);
  }
  /// The requests that a page can show in 3D, by their numbers.
  static std::vector<int> shown(const ReportPage& page) {
    std::vector<int> numbers;
    for (int i = 0; i < 4; ++i) {
      if (part(page.html, std::to_string(i))) numbers.push_back(i);
    }
    return numbers;
  }

  std::shared_ptr<const scene::Snapshot> snapshot_;
  std::array<RecordedRequest, 4> requests_;
  planning::PlanResult other_;
  std::vector<ComparedRequest> compared_;
  ReportHead head_;
};

TEST_F(ReportPageTest, ShowsRequestsThatDifferWithBothAnswers) {
  const ReportPage made = page({});
  EXPECT_THAT(made.omissions, IsEmpty());
  EXPECT_THAT(shown(made), ElementsAre(1, 2));
  EXPECT_EQ(part(made.html, "scenes")->size(), 1U);
  EXPECT_EQ(part(made.html, "meshes")->size(), 1U);
  const json review = *part(made.html, "2");
  EXPECT_EQ(review.at("answer").at("status"), "partial");
  EXPECT_FALSE(review.at("answer").contains("timing_ms"));
  EXPECT_EQ(review.at("answer").at("scene_digest"), "digest");
  EXPECT_EQ(review.at("compared").at("name"), "now");
  EXPECT_EQ(review.at("compared").at("otherName"), "recorded");
  EXPECT_EQ(review.at("compared").at("other").at("status"), "ok");
  EXPECT_EQ(review.at("request").at("scene"), "wall");
  EXPECT_EQ(review.at("request").at("keyframes").size(), 2U);
  EXPECT_THAT(made.html, HasSubstr("data-review=\"2\""));
  EXPECT_THAT(made.html, HasSubstr("href=\"#r2\""));
  const PageOptions no_pictures{.pictures = 0};
  EXPECT_TRUE(page(no_pictures).html == page(no_pictures).html) << "the same for the same requests";
}

TEST_F(ReportPageTest, ShowsAllRequestsOrNone) {
  const ReportPage all = page({.reviewed = Reviewed::kAll});
  EXPECT_THAT(shown(all), ElementsAre(0, 1, 2, 3));
  for (const char* const number : {"0", "3"}) {
    EXPECT_FALSE(part(all.html, number)->contains("compared")) << "there is one answer";
    EXPECT_EQ(part(all.html, number)->at("answer").at("status"), "ok");
  }
  const ReportPage none = page({.reviewed = Reviewed::kNone});
  EXPECT_THAT(shown(none), IsEmpty());
  EXPECT_FALSE(part(none.html, "page"));
  EXPECT_THAT(none.omissions, IsEmpty());
}

TEST_F(ReportPageTest, IsNoLargerThanItMayBe) {
  const std::size_t whole = page({.pictures = 1}).html.size();
  const std::size_t bare = page({.reviewed = Reviewed::kNone, .pictures = 0}).html.size() + 3000;
  ASSERT_LT(bare, whole);
  EXPECT_EQ(page({.pictures = 0, .most_bytes = 1}).html.find("data-review"), std::string::npos);
  constexpr std::size_t kSteps = 6;
  std::size_t last = 0;
  for (std::size_t step = 0; step <= kSteps; ++step) {
    // The last step has room for what an estimate takes as larger than it is.
    const std::size_t most = bare + (whole - bare) * step / (kSteps - 1);
    const ReportPage made = page({.pictures = 1, .most_bytes = most});
    EXPECT_LE(made.html.size(), most) << step;
    EXPECT_GE(shown(made).size(), last) << "more room shows no less";
    last = shown(made).size();
    if (last == 1) {
      EXPECT_THAT(shown(made), ElementsAre(2)) << "the worst first";
    }
    if (step == kSteps) {
      EXPECT_THAT(made.omissions, IsEmpty());
    }
  }
  EXPECT_THAT(page({.pictures = 1, .most_bytes = bare}).omissions,
              ElementsAre("2 of 2 requests are not shown in 3D: the page would have more than 0 MB "
                          "(--most-mb)",
                          HasSubstr("no floor plans beyond the first 0")));
}

TEST_F(ReportPageTest, SaysWhyRequestsAreNotShown) {
  requests_[1].request.reset();
  requests_[1].error = "a <member> of another version";
  const ReportPage one = page({});
  EXPECT_THAT(shown(one), ElementsAre(2));
  EXPECT_THAT(one.omissions, ElementsAre("1 of 2 requests cannot be shown in 3D: a <member> of "
                                         "another version"));
  EXPECT_THAT(one.html, HasSubstr("a &lt;member&gt; of another version"));
  snapshot_ = nullptr;
  EXPECT_THAT(page({}).omissions,
              ElementsAre("2 of 2 requests cannot be shown in 3D: its scene is not known "
                          "(--scene, --root)"));
}

TEST_F(ReportPageTest, IsAPageWithoutScriptWhereTheProgramHasNone) {
  const ReportPage made = page({}, {});
  EXPECT_THAT(made.html, Not(HasSubstr("<script")));
  EXPECT_THAT(made.html, HasSubstr("data:image/svg+xml;base64,"));
  EXPECT_THAT(made.omissions, ElementsAre(HasSubstr("built without its page")));
}

}  // namespace
}  // namespace camway::tools
