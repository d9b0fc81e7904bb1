// SPDX-License-Identifier: MIT
#include "tools/view/review/review.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "daemon/base/base64.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tests/tools/view/door_client.h"
#include "tests/tools/view/fake_backend.h"
#include "tools/json/json_document.h"
#include "tools/view/door.h"
#include "tools/view/here/planner_here.h"

namespace camway::view {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kReviewHtml[] =
    R"(<!doctype html><meta charset="utf-8"><link rel="stylesheet" href="/page.css">)"
    R"(<script defer src="/page.js"></script><body>hall</body>)";

const PageFiles kReviewPage{
    {kReviewHtml, ""}, {"alert(1)", ""}, {"b { color: red }", ""}, "default-src 'none'"};

/// The data in a review.
json data_of(const std::string& html) {
  const std::string begin = R"(<script type="application/json" id="review">)";
  const std::size_t at = html.find(begin) + begin.size();
  return json::parse(html.substr(at, html.find("</script>", at) - at));
}

/// A door in a scene of two triangles.
class ViewReview : public ::testing::Test {
 protected:
  void SetUp() override {
    scene::Mesh mesh;
    mesh.vertices = {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}, {0, 0, 7}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
    backend_ = plan_here(scene::make_snapshot("hall", mesh).snapshot);
    auto opened = Door::open({.token = kSecret, .page = kReviewPage}, *backend_);
    ASSERT_TRUE(opened) << opened.error;
    door_ = *std::move(opened);
  }
  Reached post(const json& document) {
    return HttpClient(door_->port(), kSecret).post("/v1/review", document.dump());
  }
  json small_request() { return json::parse(kSmallRequest); }
  json answer_to(const json& request) {
    return HttpClient(door_->port(), kSecret).post("/v1/plan", request.dump()).json();
  }

  std::unique_ptr<Backend> backend_;
  std::unique_ptr<Door> door_;
};

TEST_F(ViewReview, IsAPageThatHoldsAll) {
  const json request = small_request();
  const json answer = answer_to(request);
  const Reached got = post({{"request", request}, {"answer", answer}});
  ASSERT_EQ(got.code, 200) << got.body;
  EXPECT_EQ(got.type, "text/html; charset=utf-8");
  EXPECT_THAT(got.header("Content-Disposition"), HasSubstr("attachment"));
  EXPECT_THAT(
      got.body,
      HasSubstr(R"(<meta charset="utf-8">)"
                "\n"
                R"(<meta http-equiv="Content-Security-Policy" content="default-src 'none'">)"));
  EXPECT_THAT(got.body, HasSubstr("<style>b { color: red }</style>"));
  EXPECT_THAT(got.body, HasSubstr("<script>alert(1)</script>\n</body>"));
  EXPECT_THAT(got.body, Not(HasSubstr("/page.")));
  const json data = data_of(got.body);
  EXPECT_EQ(data.at("request"), request);
  EXPECT_EQ(data.at("answer"), answer);
  HttpClient client(door_->port(), kSecret);
  EXPECT_EQ(data.at("before"), client.post("/v1/interpolate", request.dump()).json());
  const json scene = client.get("/v1/scenes/hall").json();
  EXPECT_EQ(data.at("scene"), scene);
  ASSERT_EQ(data.at("meshes").size(), 1U);
  const std::string digest = scene.at("objects").at(0).at("digest");
  EXPECT_EQ(base::decode_base64(data.at("meshes").at(digest).get<std::string>()),
            client.get("/v1/scenes/hall/meshes/" + digest).body);
}

TEST_F(ViewReview, HasTheTrianglesThatTheAnswerNames) {
  const json request = small_request();
  json answer = answer_to(request);
  answer["anything"] = {{{"triangle", 1}}, {{"deeper", {{"triangles", {0, 0, 99, -2, "x"}}}}}};
  const json data = data_of(post({{"request", request}, {"answer", answer}}).body);
  EXPECT_EQ(data.at("triangles"), json::parse(R"({"0": [[0, 0, 5], [1, 0, 5], [0, 1, 5]],
                            "1": [[0, 0, 5], [1, 0, 5], [0, 0, 7]]})"));
}

TEST_F(ViewReview, NoTextEndsTheElementThatHoldsIt) {
  json request = small_request();
  json answer = answer_to(request);
  const std::string hostile = "</script><script>alert(2)</script><!--<script>\xe2\x80\xa8]]>&";
  answer["message"] = hostile;
  request["comment"] = hostile;
  const Reached got = post({{"request", request}, {"answer", answer}});
  ASSERT_EQ(got.code, 200) << got.body;
  EXPECT_THAT(got.body, Not(HasSubstr("alert(2)</script>")));
  EXPECT_THAT(got.body, Not(HasSubstr("<!--")));
  const json data = data_of(got.body);
  EXPECT_EQ(data.at("answer").at("message"), hostile);
  EXPECT_EQ(data.at("request").at("comment"), hostile);
}

TEST_F(ViewReview, SaysWhatIsWrongWithItsParts) {
  const json request = small_request();
  const json answer = answer_to(request);
  const auto error = [&](const json& document, int code) {
    const Reached got = post(document);
    EXPECT_EQ(got.code, code) << document;
    return got.json().at("error").get<std::string>();
  };
  EXPECT_EQ(error(json::object(), 400), "request: is missing");
  EXPECT_EQ(error({{"request", request}}, 400), "answer: is missing");
  EXPECT_THAT(error({{"request", request}, {"answer", answer}, {"x", 1}}, 400), HasSubstr("x: "));
  EXPECT_THAT(error({{"request", request}, {"answer", 7}}, 400), HasSubstr("answer"));
  EXPECT_THAT(error({{"request", request}, {"answer", {{"status", "fine"}}}}, 400),
              HasSubstr("answer: status: "));
  json other = request;
  other["scene"] = "mars.obj";
  EXPECT_THAT(error({{"request", other}, {"answer", answer}}, 404), HasSubstr("mars"));
}

TEST_F(ViewReview, NeedsThePage) {
  auto bare = Door::open({.token = kSecret}, *backend_);
  HttpClient client((*bare)->port(), kSecret);
  const json request = small_request();
  const json document{{"request", request}, {"answer", answer_to(request)}};
  const Reached got = client.post("/v1/review", document.dump());
  EXPECT_EQ(got.code, 501);
  EXPECT_THAT(got.json().at("error").get<std::string>(), HasSubstr("built without its page"));
}

TEST_F(ViewReview, SaysThatAPageHasNoPlaces) {
  const auto meshes = std::make_shared<MeshDesk>(*backend_);
  const json request = small_request();
  auto order = read_review({{"request", request}, {"answer", answer_to(request)}});
  ASSERT_TRUE(order) << order.error;
  order->plan.scene = "hall";
  for (const char* const part : {"</body>", "/page.js", "/page.css", "charset"}) {
    std::string html = kReviewHtml;
    html.erase(html.find(part), 3);
    PageFiles page = kReviewPage;
    page.html.text = html;
    EXPECT_EQ(make_review(*order, page, *backend_, *meshes).code, 500) << part;
  }
  EXPECT_EQ(make_review(*order, kReviewPage, *backend_, *meshes).code, 200);
}

}  // namespace
}  // namespace camway::view
