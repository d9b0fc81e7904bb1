// SPDX-License-Identifier: MIT
#include "tools/view/daemon/status_json.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "daemon/process/settings/bounds_text.h"

namespace camway::view {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson scene_info_json(const SceneInfo& scene) {
  const geometry::OptionalBounds bounds{scene.body_bounds.min_m, scene.body_bounds.max_m};
  return {{"name", scene.name},
          {"revision", scene.revision},
          {"digest", scene.digest},
          {"triangles", scene.num_triangles},
          {"bounds_min_m", scene.bounds_min_m},
          {"bounds_max_m", scene.bounds_max_m},
          {"body_bounds", process::bounds_text(geometry::bounds_of(bounds))},
          {"occupancy_resolution_m", scene.occupancy_resolution_m}};
}

/// The quantiles that are given, and their names.
constexpr std::array<std::pair<const char*, double>, 3> kGivenQuantiles{
    {{"p50", 0.5}, {"p99", 0.99}, {"p999", 0.999}}};
constexpr double kMsPerS = 1e3;

/// Returns a latency as JSON, with times in milliseconds.
OrderedJson latency_json(const Latency& latency) {
  OrderedJson json{{"count", latency.count}, {"sum_s", latency.sum_s}};
  for (const auto& [name, q] : kGivenQuantiles) {
    json[std::string(name) + "_ms"] = latency.quantile_s(q) * kMsPerS;
  }
  return json;
}

/// Returns the counts of the statuses that occurred, by name.
OrderedJson answers_json(const std::array<std::int64_t, 16>& answers) {
  OrderedJson json = OrderedJson::object();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers.at(i) != 0) json[to_string(static_cast<Status>(i))] = answers.at(i);
  }
  return json;
}

/// Returns what became of the requests.
OrderedJson request_counts_json(const DaemonStatus& status) {
  return {{"queued_requests", status.queued_requests},
          {"running_requests", status.running_requests},
          {"answered_requests", status.answered_requests},
          {"repeated_requests", status.repeated_requests},
          {"overloaded_requests", status.overloaded_requests},
          {"malformed_messages", status.malformed_messages},
          {"cache_hits", status.cache_hits},
          {"dropped_answers", status.dropped_answers},
          {"unsent_messages", status.unsent_messages},
          {"request_pages_asked_again", status.request_pages_asked_again},
          {"answer_pages_asked_again", status.answer_pages_asked_again},
          {"scene_changes", status.scene_changes}};
}

/// Returns how many messages came and went, and how many were not trusted.
OrderedJson message_counts_json(const DaemonStatus& status) {
  return {{"unsigned_messages", status.unsigned_messages},
          {"broken_envelopes", status.broken_envelopes},
          {"unknown_key_messages", status.unknown_key_messages},
          {"altered_messages", status.altered_messages},
          {"stale_messages", status.stale_messages},
          {"replayed_messages", status.replayed_messages},
          {"crowded_messages", status.crowded_messages},
          {"received_messages", status.received_messages},
          {"received_bytes", status.received_bytes},
          {"sent_messages", status.sent_messages},
          {"sent_bytes", status.sent_bytes}};
}

OrderedJson planner_json(const FleetPlanner& planner) {
  return {{"id", planner.id},
          {"host", planner.host},
          {"pid", planner.pid},
          {"version", planner.version},
          {"workers", planner.workers},
          {"running", planner.running},
          {"behind", planner.is_behind},
          {"other_version", planner.is_other_version},
          {"silent_s", planner.silent_s}};
}

/// Returns the role of the daemon, and its planners.
OrderedJson fleet_json(const DaemonStatus& status) {
  OrderedJson planners = OrderedJson::array();
  for (const FleetPlanner& planner : status.planners) planners.push_back(planner_json(planner));
  return {{"role", status.role},
          {"log_in_touch", status.log_in_touch},
          {"jobs_sent_again", status.jobs_sent_again},
          {"differing_answers", status.differing_answers},
          {"planned_here", status.planned_here},
          {"planners", std::move(planners)}};
}

/// Returns the answers by status, and how long they took.
OrderedJson all_answers_json(const DaemonStatus& status) {
  return {{"plan_answers", answers_json(status.plan_answers)},
          {"occupancy_answers", answers_json(status.occupancy_answers)},
          {"scene_answers", answers_json(status.scene_answers)},
          {"receipt_to_answer", latency_json(status.receipt_to_answer)},
          {"waiting", latency_json(status.waiting)},
          {"planning", latency_json(status.planning)}};
}

}  // namespace

OrderedJson status_json(const DaemonStatus& status) {
  OrderedJson json{{"version", status.version},
                   {"uptime_s", status.uptime_s},
                   {"start_id", status.daemon_start.id},
                   {"durable", status.daemon_start.durable},
                   {"workers", status.num_workers}};
  json.update(request_counts_json(status));
  json.update(message_counts_json(status));
  json.update(all_answers_json(status));
  json.update(fleet_json(status));
  json.update({{"watched_paths", status.watched_paths},
               {"broken_paths", status.broken_paths},
               {"signed_only", status.signed_only},
               {"failed_reloads", status.failed_reloads},
               {"failed_reload_utime", status.failed_reload_utime},
               {"failed_reload", status.failed_reload},
               {"reload_failed", status.reload_failed},
               {"recording_folder", status.recording_folder},
               {"recorded_bytes", status.recorded_bytes},
               {"not_recorded", status.not_recorded},
               {"recording_trouble", status.recording_trouble},
               {"total_scenes", status.total_scenes}});
  json["scenes"] = OrderedJson::array();
  for (const SceneInfo& scene : status.scenes) json["scenes"].push_back(scene_info_json(scene));
  return json;
}

}  // namespace camway::view
