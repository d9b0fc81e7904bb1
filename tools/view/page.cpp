// SPDX-License-Identifier: MIT
#include "tools/view/page.h"

#include <fmt/format.h>

#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "tools/drawing/floor_plan.h"

namespace camway::view {
namespace {

constexpr std::size_t kPageSamples = 1500;

constexpr std::string_view kOffers = R"(<ul>
<li><code>POST /v1/plan</code>, <code>POST /v1/check</code></li>
<li><code>GET /v1/status</code>, <code>GET /v1/version</code></li>
<li><code>GET /v1/scenes</code>, <code>GET /v1/scenes/NAME</code></li>
<li><code>POST /v1/scenes/NAME/objects</code></li>
<li><code>PATCH</code> and <code>DELETE /v1/scenes/NAME/objects/OBJECT</code></li>
<li><code>/v1/socket</code>: all of this over a WebSocket, with progress and events</li>
</ul>
<p>docs/http.md of Camway has the reference.</p>
)";

constexpr std::string_view kStyle =
    R"(body { font-family: sans-serif; margin: 2em; max-width: 80em; }
img { max-width: 100%; border: 1px solid #bbb; }
code { background: #eee; padding: 0 0.2em; }
)";

std::vector<motion::Keyframe> keyframes_given(const planning::PlanResult& result) {
  std::vector<motion::Keyframe> given = result.keyframes;
  std::erase_if(given, [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  });
  return given;
}

}  // namespace

std::string as_html(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string first_page(const std::string& scene, const LastPlan* last) {
  std::string plan = "<p>Nothing was planned yet.</p>\n";
  if (last != nullptr) {
    plan = fmt::format("<p><strong>{}</strong>: {}</p>\n",
                       as_html(planning::to_string(last->result.status)),
                       as_html(last->result.message));
    if (!last->result.path.empty()) {
      plan += "<p><img src=\"/plan.svg\" alt=\"Floor plan of the path\"></p>\n";
    }
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\">"
      "<title>{0} - Camway</title><link rel=\"stylesheet\" href=\"/page.css\"></head>\n<body>\n"
      "<h1>{0}</h1>\n{1}<h2>What the door offers</h2>\n{2}</body>\n</html>\n",
      as_html(scene), plan, kOffers);
}

std::string_view page_style() { return kStyle; }

std::string plan_picture(const LastPlan& last) {
  draw::FloorPlan plan;
  plan.title = last.request.scene;
  plan.subtitle =
      fmt::format("{}: {}", planning::to_string(last.result.status), last.result.message);
  if (last.mesh) plan.mesh = *last.mesh;
  plan.corners_C = motion::near_corners_C(last.request.camera);
  plan.keyframes = last.result.keyframes;
  plan.before = draw::sample(motion::interpolate(keyframes_given(last.result)), kPageSamples);
  plan.after = draw::sample(last.result.path, kPageSamples);
  plan.collisions = last.result.collisions;
  plan.remaining_collisions = last.result.remaining_collisions;
  return draw::floor_plan_svg(plan);
}

}  // namespace camway::view
