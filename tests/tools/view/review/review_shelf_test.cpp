// SPDX-License-Identifier: MIT
#include "tools/view/review/review_shelf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <utility>

#include "daemon/scene/snapshot/snapshot.h"
#include "tests/tools/view/fake_backend.h"
#include "tools/json/json_document.h"
#include "tools/view/here/planner_here.h"

namespace camway::view {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kShelfHtml[] =
    R"(<!doctype html><meta charset="utf-8"><link rel="stylesheet" href="/page.css">)"
    R"(<script defer src="/page.js"></script><body>hall</body>)";
const PageFiles kShelfPage{
    {kShelfHtml, ""}, {"alert(1)", ""}, {"b { color: red }", ""}, "default-src 'none'"};

constexpr std::size_t kMuch = 1'000'000;

/// Returns the JSON in an element of a shelf; null if there is no such element.
json part(const std::string& elements, const std::string& name) {
  const std::string begin = "<script type=\"application/json\" id=\"review-" + name + "\">";
  const std::size_t at = elements.find(begin);
  if (at == std::string::npos) return nullptr;
  const std::size_t from = at + begin.size();
  return json::parse(elements.substr(from, elements.find("</script>", from) - from));
}

/// Joins the review of a number as the script of a report does.
std::string page_of(const std::string& elements, const std::string& number) {
  json review = part(elements, number);
  const json scene = part(elements, "scenes").at(review.at("scene").get<std::size_t>());
  review["scene"] = scene;
  review["meshes"] = json::object();
  for (const json& object : scene.at("objects")) {
    const std::string digest = object.at("digest");
    review["meshes"][digest] = part(elements, "meshes").at(object.value("mesh_digest", digest));
  }
  const json page = part(elements, "page");
  return page.at(0).get<std::string>() + json_for_html(review.dump()) +
         page.at(1).get<std::string>();
}

/// Returns the data in the page of a review.
json data_in(const std::string& html) {
  const std::string begin = R"(<script type="application/json" id="review">)";
  const std::size_t at = html.find(begin) + begin.size();
  return json::parse(html.substr(at, html.find("</script>", at) - at));
}

/// A scene of a triangle and a box that is moved.
class ReviewShelfTest : public ::testing::Test {
 protected:
  void SetUp() override {
    scene::Mesh mesh;
    mesh.vertices = {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
    mesh.triangles = {{0, 1, 2}};
    backend_ = plan_here(scene::make_snapshot("hall", mesh).snapshot);
    meshes_ = std::make_shared<MeshDesk>(*backend_);
    change(SceneOrder::Kind::kAdd, {5, 0, 9});
  }
  /// Adds the object "box" to the scene, or moves it.
  void change(SceneOrder::Kind kind, const geometry::Vec3& position_m) {
    SceneOrder order;
    order.kind = kind;
    order.scene = "hall";
    order.object = "box";
    order.form = BoxForm{{1, 1, 1}};
    order.position_m = position_m;
    std::promise<Answer> promise;
    backend_->ask_scene(order, [&](Answer answer) { promise.set_value(std::move(answer)); });
    const Answer answer = promise.get_future().get();
    ASSERT_EQ(answer.code, code::kOk) << answer.error;
  }
  static ReviewOrder order(const std::string& message) {
    const json request = json::parse(kSmallRequest);
    auto plan = read_plan(request);
    plan->scene = "hall";
    const json answer{{"status", "ok"}, {"message", message}, {"triangle", 0}};
    return {*std::move(plan), answer.dump()};
  }
  ReviewShelf::Put put(ReviewShelf& shelf, std::size_t number, const ReviewOrder& order) {
    return shelf.put(number, order, *backend_, *meshes_);
  }

  std::unique_ptr<Backend> backend_;
  std::shared_ptr<MeshDesk> meshes_;
};

TEST_F(ReviewShelfTest, ItsPartsJoinToThePageOfAReview) {
  ReviewShelf shelf(kShelfPage, kMuch);
  ReviewOrder compared = order("one");
  compared.compared = {"now", "recorded", R"({"status":"ok","message":"earlier","triangle":1})"};
  ASSERT_EQ(put(shelf, 3, compared).code, code::kOk);
  ASSERT_EQ(put(shelf, 12, order("two")).code, code::kOk);
  const std::string elements = shelf.elements();
  EXPECT_EQ(shelf.bytes(), elements.size());
  for (const auto& [number, order] : {std::pair("3", compared), std::pair("12", order("two"))}) {
    const ReviewFile made = make_review(order, kShelfPage, *backend_, *meshes_);
    ASSERT_EQ(made.code, code::kOk) << made.error;
    const std::string joined = page_of(elements, number);
    EXPECT_EQ(data_in(joined), data_in(made.html));
    const auto without_data = [](const std::string& html) {
      const std::size_t at = html.find("id=\"review\">");
      return html.substr(0, at) + html.substr(html.find("</script>", at));
    };
    EXPECT_EQ(without_data(joined), without_data(made.html));
  }
  const json data = part(elements, "3");
  EXPECT_EQ(data.at("compared").at("otherName"), "recorded");
  EXPECT_EQ(data.at("compared").at("other").at("message"), "earlier");
  EXPECT_EQ(data.at("triangles").size(), 2U) << "those that either answer names";
  EXPECT_TRUE(shelf.holds(3));
  EXPECT_FALSE(shelf.holds(4));
}

TEST_F(ReviewShelfTest, HoldsEachSceneAndEachMeshOnce) {
  ReviewShelf shelf(kShelfPage, kMuch);
  ASSERT_EQ(put(shelf, 0, order("")).code, code::kOk);
  ASSERT_EQ(put(shelf, 1, order("")).code, code::kOk);
  EXPECT_EQ(part(shelf.elements(), "scenes").size(), 1U);
  EXPECT_EQ(part(shelf.elements(), "meshes").size(), 2U);
  change(SceneOrder::Kind::kMove, {7, 0, 9});
  ASSERT_EQ(put(shelf, 2, order("")).code, code::kOk);
  const std::string elements = shelf.elements();
  EXPECT_EQ(shelf.bytes(), elements.size());
  EXPECT_EQ(part(elements, "scenes").size(), 2U) << "each revision";
  EXPECT_EQ(part(elements, "meshes").size(), 2U) << "a moved box has the same mesh";
  EXPECT_EQ(part(elements, "1").at("scene"), 0);
  EXPECT_EQ(part(elements, "2").at("scene"), 1);
  EXPECT_EQ(data_in(page_of(elements, "2")).at("meshes").size(), 2U);
}

TEST_F(ReviewShelfTest, TakesWhatFitsAndNoByteMore) {
  ReviewShelf measured(kShelfPage, kMuch);
  ASSERT_EQ(put(measured, 5, order("")).code, code::kOk);
  const std::size_t bytes = measured.bytes();
  ReviewShelf exact(kShelfPage, bytes);
  EXPECT_EQ(put(exact, 5, order("")).code, code::kOk);
  EXPECT_EQ(put(exact, 6, order("")).code, code::kTooLarge);
  EXPECT_EQ(exact.size(), 1U);
  EXPECT_EQ(exact.bytes(), bytes);
  ReviewShelf less(kShelfPage, bytes - 1);
  EXPECT_EQ(put(less, 5, order("")).code, code::kTooLarge);
  EXPECT_EQ(less.bytes(), 0U);
  EXPECT_EQ(less.elements(), "");
  ReviewShelf small(kShelfPage, bytes / 2);
  EXPECT_EQ(put(small, 5, order("")).code, code::kTooLarge) << "the scene does not fit";
  EXPECT_EQ(put(small, 6, order("")).code, code::kTooLarge);
}

TEST_F(ReviewShelfTest, NoTextEndsTheElementThatHoldsIt) {
  const std::string hostile = "</script><script>alert(2)</script><!--<script>";
  ReviewShelf shelf(kShelfPage, kMuch);
  ReviewOrder review = order(hostile);
  review.compared = {hostile, hostile, json{{"message", hostile}}.dump()};
  ASSERT_EQ(put(shelf, 0, review).code, code::kOk);
  const std::string elements = shelf.elements();
  EXPECT_THAT(elements, Not(HasSubstr("alert(2)</script>")));
  EXPECT_THAT(elements, Not(HasSubstr("<!--")));
  EXPECT_EQ(part(elements, "0").at("answer").at("message"), hostile);
  EXPECT_EQ(part(elements, "0").at("compared").at("name"), hostile);
}

TEST_F(ReviewShelfTest, SaysWhyItTakesNone) {
  ReviewShelf bare({}, kMuch);
  EXPECT_EQ(put(bare, 0, order("")).code, code::kNotOffered);
  EXPECT_EQ(bare.elements(), "");
  ReviewShelf shelf(kShelfPage, kMuch);
  ReviewOrder elsewhere = order("");
  elsewhere.plan.scene = "mars";
  const ReviewShelf::Put done = put(shelf, 0, elsewhere);
  EXPECT_EQ(done.code, code::kNotFound);
  EXPECT_THAT(done.error, HasSubstr("mars"));
  EXPECT_EQ(shelf.bytes(), 0U);
}

}  // namespace
}  // namespace camway::view
