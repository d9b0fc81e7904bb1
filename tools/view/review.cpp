// SPDX-License-Identifier: MIT
#include "tools/view/review.h"

#include <fmt/format.h>

#include <future>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/base/base64.h"
#include "tools/answers/interpolation.h"
#include "tools/json/json_response.h"

namespace camway::view {
namespace {

using Json = nlohmann::json;

/// Calls `ask` with a function that takes an answer, and waits for that.
template <class Ask>
Answer wait_for(const Ask& ask) {
  const auto promise = std::make_shared<std::promise<Answer>>();
  ask([promise](Answer answer) { promise->set_value(std::move(answer)); });
  return promise->get_future().get();
}

void add_index(const Json& value, std::set<std::int64_t>& indices) {
  if (value.is_number_integer() && indices.size() < kMostIndices) {
    indices.insert(value.get<std::int64_t>());
  }
}

/// Adds the numbers of triangles that an answer names: those of witnesses, closed surfaces, cages.
void add_indices(const Json& value, std::set<std::int64_t>& indices) {
  if (value.is_array()) {
    for (const Json& element : value) add_indices(element, indices);
  }
  if (!value.is_object()) return;
  for (const auto& [key, member] : value.items()) {
    if (key == "triangle") add_index(member, indices);
    if (key == "triangles" && member.is_array()) {
      for (const Json& index : member) add_index(index, indices);
    } else {
      add_indices(member, indices);
    }
  }
}

/// Returns JSON that can stand in an element of HTML: nothing in it begins a tag.
std::string for_html(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

/// Collects the data of a review. Each step returns false if it failed; then `failure` says why.
class ReviewData {
 public:
  ReviewData(const ReviewOrder& order, Backend& backend, MeshDesk& meshes)
      : order_(order), backend_(backend), meshes_(meshes) {}

  bool collect() { return interpolate() && describe() && add_meshes() && add_triangles(); }
  [[nodiscard]] const Answer& failed() const { return failed_; }
  [[nodiscard]] std::string json() const {
    return fmt::format(
        R"({{"request":{},"answer":{},"before":{},"scene":{},"meshes":{{{}}},"triangles":{}}})",
        *order_.plan.text, order_.answer, before_, scene_, mesh_members_, triangles_);
  }

 private:
  bool fail(int code, std::string error) {
    failed_ = failure(code, std::move(error));
    return false;
  }
  bool interpolate() {
    base::Result<std::string> text = tools::interpolated_text(order_.plan.request);
    if (!text) return fail(code::kInvalid, "request: the path cannot be written: " + text.error);
    before_ = *std::move(text);
    return true;
  }
  bool describe() {
    SceneOrder order;
    order.kind = SceneOrder::Kind::kDescribe;
    order.scene = order_.plan.scene;
    Answer answer = wait_for([&](Done done) { backend_.ask_scene(order, std::move(done)); });
    if (answer.code != code::kOk) return fail(answer.code, std::move(answer.error));
    scene_ = std::move(answer.json);
    return true;
  }
  bool add_meshes() {
    std::set<std::string> digests;
    const Json scene = Json::parse(scene_);
    for (const Json& object : scene.at("objects")) digests.insert(object.at("digest"));
    for (const std::string& digest : digests) {
      const GlbAnswer mesh = meshes_.wait_for(order_.plan.scene, digest);
      if (!mesh.glb) return fail(mesh.code, mesh.error);
      mesh_members_ += fmt::format("{}{}:\"{}\"", mesh_members_.empty() ? "" : ",",
                                   json_string(digest), base::encode_base64(*mesh.glb));
    }
    return true;
  }
  bool add_triangles() {
    std::set<std::int64_t> indices;
    add_indices(Json::parse(order_.answer), indices);
    const std::vector<std::int64_t> list(indices.begin(), indices.end());
    Answer answer =
        wait_for([&](Done done) { backend_.triangles(order_.plan.scene, list, std::move(done)); });
    if (answer.code != code::kOk) return fail(answer.code, std::move(answer.error));
    triangles_ = Json::parse(answer.json).at("triangles").dump();
    return true;
  }

  const ReviewOrder& order_;
  Backend& backend_;
  MeshDesk& meshes_;
  Answer failed_;
  std::string before_;
  std::string scene_;
  std::string mesh_members_;
  std::string triangles_;
};

/// Replaces `from`, which must stand in `text` exactly once. Returns whether it did.
bool replace_once(std::string& text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) return false;
  text.replace(at, from.size(), to);
  return true;
}

/// Puts script, style and data into the page. Returns nothing if it has no places for them.
std::optional<std::string> assembled(const PageFiles& page, const std::string& data) {
  std::string html(page.html.text);
  const std::string policy = fmt::format(
      "<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">",
      page.inline_policy);
  const std::string style = fmt::format("<style>{}</style>", page.style.text);
  const std::string end = fmt::format(
      "<script type=\"application/json\" id=\"review\">{}</script>\n<script>{}</script>\n</body>",
      for_html(data), page.script.text);
  // The script comes last, since it may hold any text.
  const bool fits = replace_once(html, R"(<script defer src="/page.js"></script>)", "") &&
                    replace_once(html, R"(<meta charset="utf-8">)", policy) &&
                    replace_once(html, R"(<link rel="stylesheet" href="/page.css">)", style) &&
                    replace_once(html, "</body>", end);
  if (!fits) return std::nullopt;
  return html;
}

}  // namespace

base::Result<ReviewOrder> read_review(const Json& document) {
  tools::DocumentNotes notes;
  const tools::Field root(document, notes);
  root.allow_only({"request", "answer"});
  for (const char* const part : {"request", "answer"}) static_cast<void>(root.member(part));
  if (root.failed()) return base::Failure{notes.error};
  base::Result<PlanOrder> plan = read_plan(document.at("request"));
  if (!plan) return base::Failure{plan.error};
  const auto result = tools::read_document<planning::PlanResult>(document.at("answer"), "answer");
  if (!result) return base::Failure{result.error};
  return ReviewOrder{*std::move(plan),
                     document.at("answer").dump(-1, ' ', false, Json::error_handler_t::replace)};
}

ReviewFile make_review(const ReviewOrder& order, const PageFiles& page, Backend& backend,
                       MeshDesk& meshes) {
  if (page.script.text.empty()) {
    return {{}, code::kNotOffered, "there is no review: this program was built without its page"};
  }
  ReviewData data(order, backend, meshes);
  if (!data.collect()) return {{}, data.failed().code, data.failed().error};
  std::optional<std::string> html = assembled(page, data.json());
  if (!html) return {{}, code::kOurFault, "the page has no places for its data"};
  return {*std::move(html)};
}

}  // namespace camway::view
