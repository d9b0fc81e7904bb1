// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/row.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/service/watches/answer_quality.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using Message = plan_response_t;

const Message* message_of(const std::optional<RecordedAnswer>& answer) {
  return answer && answer->result ? &*answer->result : nullptr;
}

/// Sets both values by `value_of(message)`.
template <class ValueOf>
void set_both(ThenAndNow& into, const Message* then, const Message* now, const ValueOf& value_of) {
  if (then != nullptr) into.then = value_of(*then);
  if (now != nullptr) into.now = value_of(*now);
}

void set_measures(Row& row, const Message* then, const Message* now) {
  set_both(row.inserted, then, now, [](const Message& answer) -> std::optional<double> {
    return static_cast<double>(std::ranges::count_if(answer.keyframes, [](const keyframe_t& each) {
      return each.origin == keyframe_t::ORIGIN_INSERTED;
    }));
  });
  set_both(row.clearance_m, then, now, [](const Message& answer) -> std::optional<double> {
    if (answer.certified == 0) return std::nullopt;
    return answer.clearance_lower_bound_m;
  });
  const auto measure = [&](ThenAndNow& into, double path_measures_t::*member) {
    set_both(into, then, now, [&](const Message& answer) -> std::optional<double> {
      if (answer.has_measures == 0) return std::nullopt;
      return answer.measures.*member;
    });
  };
  measure(row.length_m, &path_measures_t::length_m);
  measure(row.deviation_m, &path_measures_t::largest_deviation_m);
  set_both(row.mean_shift_deg, then, now, [](const Message& answer) -> std::optional<double> {
    if (answer.has_measures == 0 || !service::AnswerQuality::of(answer).tells_shift) {
      return std::nullopt;
    }
    return degrees(answer.measures.mean_shift_rad);
  });
  set_both(row.total_ms, then, now,
           [](const Message& answer) -> std::optional<double> { return answer.total_ms; });
}

}  // namespace

std::string divergence_text(const Difference& difference) {
  if (difference.has_same_bits()) return {};
  return fmt::format("first differs in the {}: {}",
                     names_of(Stage{})[std::size_t(difference.stage)], difference.what());
}

Row row_of(const ComparedRequest& compared) {
  Row row;
  const RecordedRequest& recorded = *compared.recorded;
  row.client = recorded.ids.client_id;
  row.request = recorded.ids.request_id;
  row.scene = recorded.scene;
  if (recorded.answer) row.status_then = recorded.answer->status;
  if (compared.now) row.status_now = compared.now->status;
  row.verdict = compared.verdict;
  row.explanation = compared.note;
  const std::string divergence = divergence_text(compared.difference);
  if (!row.explanation.empty() && !divergence.empty()) row.explanation += "; ";
  row.explanation += divergence;
  if (compared.scene_changed) row.explanation += " (the scene has other triangles than it had)";
  if (compared.verdict != Verdict::kNotCompared) {
    row.path_m = compared.difference.path_m;
    row.shift_deg = degrees(compared.difference.shift_rad);
  }
  set_measures(row, message_of(recorded.answer), message_of(compared.now));
  return row;
}

}  // namespace camway::tools
