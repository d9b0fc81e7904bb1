// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>

#include <nlohmann/json.hpp>

#include "tools/camway/replay/compare/report.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: a distance that is none is null, as a missing value.
Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json whole_number(const std::optional<double>& value) {
  return value ? Json(static_cast<std::int64_t>(*value)) : Json();
}

void add_both(Json& into, const std::string& name, const std::string& unit,
              const ThenAndNow& values) {
  into[name + "_then" + unit] = number(values.then);
  into[name + "_now" + unit] = number(values.now);
}

Json json_of(const Difference& difference) {
  if (difference.has_same_bits()) return {};
  return {{"stage", base::name_of(difference.stage)},
          {"member", difference.member},
          {"then", difference.then},
          {"now", difference.now}};
}

Json json_of(const ComparedRequest& compared, Times times) {
  const Row row = row_of(compared);
  const bool was_compared = row.verdict != Verdict::kNotCompared;
  Json item{{"client", row.client},
            {"request", row.request},
            {"scene", row.scene},
            {"received_s", compared.recorded->received_s},
            {"verdict", base::name_of(row.verdict)},
            {"reason", compared.note},
            {"status_then", row.status_then},
            {"status_now", row.status_now},
            {"same_bits", was_compared && compared.difference.has_same_bits()},
            {"same_scene", !compared.scene_changed},
            {"first_difference", json_of(compared.difference)}};
  item["path_m"] = number(row.path_m);
  item["shift_deg"] = number(row.shift_deg);
  item["inserted_then"] = whole_number(row.inserted.then);
  item["inserted_now"] = whole_number(row.inserted.now);
  add_both(item, "clearance", "_m", row.clearance_m);
  add_both(item, "length", "_m", row.length_m);
  add_both(item, "deviation", "_m", row.deviation_m);
  add_both(item, "mean_shift", "_deg", row.mean_shift_deg);
  if (times == Times::kShown) add_both(item, "total", "_ms", row.total_ms);
  return item;
}

Json json_of(const Thresholds& thresholds) {
  return {{"tolerance_m", thresholds.tolerance_m},
          {"tolerance_shift_deg", number(degrees(thresholds.tolerance_shift_rad))},
          {"clearance_loss_m", number(thresholds.clearance_loss_m)},
          {"longer", number(thresholds.longer)},
          {"slower", number(thresholds.slower)}};
}

}  // namespace

std::string json_report(const ReportHead& head, const std::vector<ComparedRequest>& compared) {
  Json counts;
  for (const auto& [name, verdict] : base::named_values<Verdict>()) {
    counts[std::string(name)] = count(compared, verdict);
  }
  Json requests = Json::array();
  for (const ComparedRequest& each : compared) requests.push_back(json_of(each, head.times));
  const Json report{{"format", "camway_replay"},
                    {"version", 1},
                    {"title", head.title},
                    {"then", head.then},
                    {"now", head.now},
                    {"thresholds", json_of(head.thresholds)},
                    {"counts", std::move(counts)},
                    {"notes", all_notes(head, compared)},
                    {"requests", std::move(requests)}};
  return json_text(report, 1) + '\n';
}

}  // namespace camway::tools
