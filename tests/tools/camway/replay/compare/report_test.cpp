// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numbers>

#include <nlohmann/json.hpp>

#include "daemon/messages/plan.h"
#include "daemon/messages/text.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/tools/camway/replay/log_builder.h"
#include "tools/camway/replay/compare/pictures.h"
#include "tools/camway/replay/compare/plots.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kHostile[] = "<script>alert('x\"&\x1b[2J</script>";

/// One request whose answer became partial, with hostile names.
class ReportTest : public ::testing::Test {
 protected:
  ReportTest() {
    planning::PlanResult result;
    result.status = planning::Status::kOk;
    result.keyframes = simple_request({{0, 0, 1}, {1, 0, -1}}).keyframes;
    result.keyframes[1].time_s = 1.0;
    result.path = motion::interpolate(result.keyframes);
    result.certificate = {true, 0.5};
    result.measures.emplace().length_m = 2.0;
    result.timing.total_ms = 8.0;
    recorded_.ids = {"client", 7, 0};
    recorded_.scene = kHostile;
    recorded_.request = simple_request({{0, 0, 1}, {1, 0, -1}});
    recorded_.answer = answer_of(result);
    result.status = planning::Status::kPartial;
    result.certificate = {};
    result.path = {};
    result.remaining_collisions = {{0.0, 1.0}};
    result.remaining_names = {{kHostile, kHostile}};
    ComparedRequest& item = compared_.emplace_back();
    item.recorded = &recorded_;
    item.now = answer_of(result);
    static_cast<Judgement&>(item) = judge(recorded_, answers_of(item), {});
    head_.title = kHostile;
    head_.notes = {kHostile};
  }

  static RecordedAnswer answer_of(const planning::PlanResult& result) {
    RecordedAnswer answer;
    answer.result = messages::to_wire(result, {});
    answer.status = messages::status_name(answer.result->status);
    return answer;
  }

  RecordedRequest recorded_;
  std::vector<ComparedRequest> compared_;
  ReportHead head_;
};

TEST_F(ReportTest, TextNamesVerdictReasonAndDivergence) {
  const std::string text = text_report(head_, compared_);
  EXPECT_THAT(text, HasSubstr("ok -> partial"));
  EXPECT_THAT(text, HasSubstr("REGRESSED: status ok -> partial; first differs in the path: "
                              "segments 1 -> 0"));
  EXPECT_THAT(text, HasSubstr("0.5 -> -")) << "the clearance";
  EXPECT_THAT(text, HasSubstr("verdict: REGRESSED: 1 request: 0 same, 0 better, 0 different, "
                              "0 worse, 1 regressed, 0 not compared"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
}

TEST_F(ReportTest, JsonHasTheDocumentedMembers) {
  const auto json = nlohmann::json::parse(json_report(head_, compared_));
  EXPECT_EQ(json["format"], "camway_replay");
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["title"], kHostile) << "JSON carries any text";
  EXPECT_EQ(json["counts"]["regressed"], 1);
  EXPECT_EQ(json["counts"]["same"], 0);
  const auto& item = json["requests"][0];
  EXPECT_EQ(item["client"], "client");
  EXPECT_EQ(item["request"], 7);
  EXPECT_EQ(item["verdict"], "regressed");
  EXPECT_EQ(item["reason"], "status ok -> partial");
  EXPECT_EQ(item["first_difference"]["stage"], "path");
  EXPECT_EQ(item["first_difference"]["member"], "segments");
  EXPECT_EQ(item["first_difference"]["then"], "1");
  EXPECT_TRUE(item["path_m"].is_null()) << "infinite";
  EXPECT_EQ(item["clearance_then_m"], 0.5);
  EXPECT_TRUE(item["clearance_now_m"].is_null());
  EXPECT_EQ(item["length_now_m"], 2.0);
  EXPECT_EQ(item["mean_shift_now_deg"], 0.0) << "nothing was changed";
  EXPECT_EQ(item["total_then_ms"], 8.0);
  head_.times = Times::kHidden;
  EXPECT_THAT(json_report(head_, compared_), Not(HasSubstr("_ms")));
}

TEST_F(ReportTest, TheMeanShiftIsMissingWhereAnAnswerDoesNotTellIt) {
  recorded_.answer->result->measures.largest_deviation_m = 0.5;
  path_measures_t& now = compared_[0].now->result->measures;
  now.largest_shift_rad = now.mean_shift_rad = std::numbers::pi / 180.0;
  const auto json = nlohmann::json::parse(json_report(head_, compared_));
  EXPECT_TRUE(json["requests"][0]["mean_shift_then_deg"].is_null());
  EXPECT_DOUBLE_EQ(json["requests"][0]["mean_shift_now_deg"].get<double>(), 1.0);
}

TEST_F(ReportTest, TextAndJsonHaveTheNoteOnChangedScenesAndWholeNumbers) {
  compared_[0].scene_changed = true;
  const std::string note = "1 answer was computed on other triangles than the scene has now";
  EXPECT_THAT(text_report(head_, compared_), HasSubstr("note: " + note));
  EXPECT_THAT(html_report(head_, compared_, {}), HasSubstr(note));
  const auto json = nlohmann::json::parse(json_report(head_, compared_));
  EXPECT_EQ(json["notes"].back(), note);
  EXPECT_TRUE(json["requests"][0]["inserted_then"].is_number_integer());
}

TEST_F(ReportTest, JsonTakesTextThatIsNotUtf8) {
  recorded_.scene = "\xff\xfe";
  EXPECT_FALSE(nlohmann::json::parse(json_report(head_, compared_), nullptr, false).is_discarded());
}

TEST_F(ReportTest, HtmlEscapesWhatTheLogSays) {
  PageParts parts;
  parts.pictures = {{0, kHostile}};
  parts.notes = {kHostile};
  const std::string html = html_report(head_, compared_, parts);
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;x&quot;&amp;?[2J"));
  EXPECT_THAT(html, HasSubstr("data:image/svg+xml;base64,"));
}

TEST_F(ReportTest, HtmlAsksNobody) {
  const std::string html = html_report(head_, compared_, {});
  EXPECT_THAT(html, HasSubstr("content=\"default-src 'none'; style-src 'unsafe-inline'; img-src "
                              "data:\""));
  for (const char* link : {"http://", "https://", "src=\"/", "href=", "<script"}) {
    EXPECT_THAT(html, Not(HasSubstr(link)));
  }
  EXPECT_THAT(html, HasSubstr("Length (m)"));
}

TEST_F(ReportTest, HtmlHasAButtonForAReviewAndALinkToAPicture) {
  compared_.push_back(compared_[0]);
  PageParts parts;
  parts.script = "sort()";
  parts.policy = "default-src 'none'; script-src 'sha256-x'";
  const auto counts = [&] {
    const std::string html = html_report(head_, compared_, parts);
    const auto count = [&](const std::string& text) {
      std::size_t found = 0;
      for (std::size_t at = html.find(text); at != std::string::npos; at = html.find(text, at + 1))
        ++found;
      return found;
    };
    EXPECT_EQ(count("<script>sort()</script>"), 1U);
    EXPECT_EQ(count("content=\"default-src 'none'; script-src 'sha256-x'\""), 1U);
    return std::array{count("data-review=\"0\""), count("data-review=\"1\""),
                      count("href=\"#r1\""),      count("id=\"r1\""),
                      count("id=\"no-webgl\""),   count("<i>shelf</i>")};
  };
  EXPECT_THAT(counts(), ::testing::ElementsAre(0, 0, 0, 0, 0, 0));
  parts.reviews = {1};
  parts.review_elements = "<i>shelf</i>";
  EXPECT_THAT(counts(), ::testing::ElementsAre(0, 1, 0, 0, 1, 1));
  parts.pictures = {{1, "<svg/>"}};
  EXPECT_THAT(counts(), ::testing::ElementsAre(0, 2, 1, 1, 1, 1)) << "one at the picture, too";
}

TEST_F(ReportTest, PicturesShowTheWorstVerdictsFirst) {
  compared_.push_back(compared_[0]);
  compared_[0].verdict = Verdict::kDifferent;
  const SceneOf no_scene = [](const RecordedRequest&) { return nullptr; };
  const auto pictures = [&](std::size_t most, std::size_t most_bytes = 1'000'000) {
    return pictures_of(compared_, no_scene, head_, {most, most_bytes});
  };
  const Pictures one = pictures(1);
  ASSERT_EQ(one.list.size(), 1U);
  EXPECT_EQ(one.list[0].index, 1U);
  EXPECT_FALSE(one.is_cut);
  EXPECT_THAT(one.list[0].svg, HasSubstr("<svg"));
  EXPECT_TRUE(pictures(0).list.empty());
  const std::size_t bytes = one.list[0].svg.size();
  const Pictures cut = pictures(2, bytes);
  EXPECT_EQ(cut.list.size(), 1U);
  EXPECT_TRUE(cut.is_cut);
  EXPECT_TRUE(pictures(1, bytes - 1).list.empty());
  compared_[0].difference = {};
  compared_[0].verdict = Verdict::kSame;
  EXPECT_EQ(pictures(5).list.size(), 1U) << "the same needs no picture";
}

TEST(ReplayPlots, TakeAnyNumbers) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::vector<PlotMark> marks;
  for (const double value : {0.0, -1.0, 1e-300, 5.0, 1e308, kInfinity, kNan}) {
    for (const double other : {0.0, 2.0, kInfinity, -kInfinity, kNan}) {
      marks.push_back({value, other, Verdict::kWorse, kHostile});
    }
  }
  for (const std::string& svg : {then_now_plot("a", marks), by_request_plot("b", marks)}) {
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_THAT(svg, Not(HasSubstr("<script>")));
    EXPECT_LT(svg.size(), 100'000U);
  }
  EXPECT_EQ(then_now_plot("a", {}), "");
  EXPECT_EQ(then_now_plot("a", {{kNan, 1.0, Verdict::kSame, ""}}), "");
}

}  // namespace
}  // namespace camway::tools
