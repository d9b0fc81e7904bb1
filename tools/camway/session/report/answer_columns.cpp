// SPDX-License-Identifier: MIT
#include "tools/camway/session/report/answer_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace camway::tools {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no number for infinity or for none.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

std::size_t inserted_keyframes(const plan_response_t& answer) {
  return static_cast<std::size_t>(std::ranges::count_if(
      answer.keyframes,
      [](const keyframe_t& keyframe) { return keyframe.origin == keyframe_t::ORIGIN_INSERTED; }));
}

Json path_duration_s(const plan_response_t& answer) {
  if (answer.segments.empty()) return {};
  return number(answer.segments.back().t1_s - answer.segments.front().t0_s);
}

/// A column that needs the whole answer.
struct ResultColumn {
  std::string_view name;
  Json (*value)(const plan_response_t&);
};

constexpr auto kResultColumns = std::to_array<ResultColumn>({
    {"certified", [](const plan_response_t& a) { return Json(a.certified != 0); }},
    {"clearance_m",
     [](const plan_response_t& a) {
       return a.certified != 0 ? number(a.clearance_lower_bound_m) : Json();
     }},
    {"path_duration_s", path_duration_s},
    {"segments", [](const plan_response_t& a) { return Json(a.segments.size()); }},
    {"collisions", [](const plan_response_t& a) { return Json(a.collisions.size()); }},
    {"remaining_collisions", [](const plan_response_t& a) { return Json(a.remaining.size()); }},
    {"inserted_keyframes", [](const plan_response_t& a) { return Json(inserted_keyframes(a)); }},
    {"time_scale", [](const plan_response_t& a) { return number(a.time_scale); }},
    {"deadline_reached", [](const plan_response_t& a) { return Json(a.deadline_reached != 0); }},
    {"motion_ms", [](const plan_response_t& a) { return number(a.motion_ms); }},
    {"detect_ms", [](const plan_response_t& a) { return number(a.detect_ms); }},
    {"correct_ms", [](const plan_response_t& a) { return number(a.correct_ms); }},
    {"certify_ms", [](const plan_response_t& a) { return number(a.certify_ms); }},
    {"total_ms", [](const plan_response_t& a) { return number(a.total_ms); }},
    {"scene_revision", [](const plan_response_t& a) { return Json(a.scene_revision); }},
    {"scene_digest", [](const plan_response_t& a) { return Json(a.scene_digest); }},
    {"message", [](const plan_response_t& a) { return Json(a.message); }},
});

}  // namespace

std::vector<AnswerColumn> answer_columns(const RecordedRequest& request) {
  const auto& answer = request.answer;
  std::vector<AnswerColumn> columns{
      {"received_s", number(request.received_s)},
      {"answered_s", answer ? number(answer->received_s) : Json()},
      {"client", request.ids.client_id},
      {"request_id", request.ids.request_id},
      {"scene", request.scene},
      {"keyframes", request.request ? Json(request.request->keyframes.size()) : Json()},
      {"status", answer ? Json(answer->status) : Json()}};
  for (const ResultColumn& column : kResultColumns) {
    const bool is_known = answer && answer->result;
    columns.push_back({column.name, is_known ? column.value(*answer->result) : Json()});
  }
  return columns;
}

std::vector<std::string_view> answer_column_names() {
  std::vector<std::string_view> names;
  for (const AnswerColumn& column : answer_columns({})) names.push_back(column.name);
  return names;
}

}  // namespace camway::tools
