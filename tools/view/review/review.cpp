// SPDX-License-Identifier: MIT
#include "tools/view/review/review.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "tools/json/json_response.h"

namespace camway::view {
namespace {

using Json = nlohmann::json;

/// Returns the data of a review; nothing if that failed (`ReviewSource::failed`).
std::optional<std::string> data_of(const ReviewOrder& order, ReviewSource& source) {
  const std::optional<ReviewScene> scene = source.scene(order.plan.scene);
  if (!scene) return std::nullopt;
  std::string meshes;
  for (const ReviewScene::Mesh& each : scene->meshes) {
    const std::optional<std::string> mesh = source.mesh(order.plan.scene, each.digest);
    if (!mesh) return std::nullopt;
    meshes +=
        fmt::format(R"({}{}:"{}")", meshes.empty() ? "" : ",", json_string(each.digest), *mesh);
  }
  const std::optional<std::string> members = source.plan_members(order);
  if (!members) return std::nullopt;
  return fmt::format(R"({{{},"scene":{},"meshes":{{{}}}}})", *members, scene->description, meshes);
}

/// Replaces `from`, which must stand in `text` exactly once. Returns whether it did.
bool replace_once(std::string& text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) return false;
  text.replace(at, from.size(), to);
  return true;
}

}  // namespace

std::optional<ReviewFrame> review_frame(const PageFiles& page) {
  std::string html(page.html.text);
  const std::string policy = fmt::format(
      "<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">",
      page.inline_policy);
  const std::string style = fmt::format("<style>{}</style>", page.style.text);
  const bool fits = replace_once(html, R"(<script defer src="/page.js"></script>)", "") &&
                    replace_once(html, R"(<meta charset="utf-8">)", policy) &&
                    replace_once(html, R"(<link rel="stylesheet" href="/page.css">)", style);
  constexpr std::string_view kBodyEnd = "</body>";
  const std::size_t end = html.find(kBodyEnd);
  if (!fits || end == std::string::npos || html.find(kBodyEnd, end + 1) != std::string::npos) {
    return std::nullopt;
  }
  return ReviewFrame{
      html.substr(0, end) + R"(<script type="application/json" id="review">)",
      fmt::format("</script>\n<script>{}</script>\n{}", page.script.text, html.substr(end))};
}

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
  if (page.script.text.empty()) return {{}, code::kNotOffered, kNoPage};
  ReviewSource source(backend, meshes);
  const std::optional<std::string> data = data_of(order, source);
  if (!data) return {{}, source.failed().code, source.failed().error};
  const std::optional<ReviewFrame> frame = review_frame(page);
  if (!frame) return {{}, code::kOurFault, "the page has no places for its data"};
  return {frame->begin + json_for_html(*data) + frame->end};
}

}  // namespace camway::view
