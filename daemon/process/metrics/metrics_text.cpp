// SPDX-License-Identifier: MIT
#include "daemon/process/metrics/metrics_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

#include "daemon/messages/text.h"
#include "lcmtypes/wire/latency_buckets.h"

namespace camway::process {
namespace {

/// Returns `text` as it stands within the quotes of a label.
std::string escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\n') {
      escaped += "\\n";
      continue;
    }
    if (c == '\\' || c == '"') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

class Page {
 public:
  void head(std::string_view name, std::string_view type, std::string_view help) {
    fmt::format_to(std::back_inserter(text_), "# HELP camway_{0} {1}\n# TYPE camway_{0} {2}\n",
                   name, help, type);
  }
  template <class Value>
  void sample(std::string_view name, std::string_view labels, Value value) {
    fmt::format_to(std::back_inserter(text_), "camway_{}{} {}\n", name,
                   labels.empty() ? std::string() : fmt::format("{{{}}}", labels), value);
  }
  template <class Value>
  void gauge(std::string_view name, Value value, std::string_view help) {
    head(name, "gauge", help);
    sample(name, "", value);
  }
  void counter(std::string_view name, std::int64_t value, std::string_view help) {
    head(name, "counter", help);
    sample(name, "", value);
  }
  void histogram(const std::string& name, const latency_t& latency, std::string_view help) {
    head(name, "histogram", help);
    std::int64_t below = 0;
    for (std::size_t i = 0; i < wire::kLatencyBuckets; ++i) {
      if (i < latency.buckets.size()) below += latency.buckets[i];
      const double bound_s = wire::latency_bound_s(i);
      if (i % wire::kLatencyBucketsPerDoubling == 0 && std::isfinite(bound_s)) {
        sample(name + "_bucket", fmt::format("le=\"{}\"", bound_s), below);
      }
    }
    sample(name + "_bucket", "le=\"+Inf\"", below);
    sample(name + "_sum", "", latency.sum_s);
    sample(name + "_count", "", below);
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// `counts`: an array of a `status_t`, whose index is the number of the status.
template <class Counts>
void add_answers(std::string_view kind, const Counts& counts, Page& page) {
  for (std::size_t i = 0; i < std::size(counts); ++i) {
    const std::string_view name = messages::status_name(static_cast<std::int32_t>(i));
    const bool is_named = name != messages::kUnknownStatus;
    if (!is_named && counts[i] == 0) continue;
    page.sample("answers_total",
                fmt::format("kind=\"{}\",status=\"{}\"", kind,
                            is_named ? std::string(name) : std::to_string(i)),
                counts[i]);
  }
}

void add_requests(const status_t& status, Page& page) {
  page.head("answers_total", "counter", "Answers by kind of request and status, repeats apart.");
  add_answers("plan", status.plan_answers, page);
  add_answers("occupancy", status.occupancy_answers, page);
  add_answers("scene", status.scene_answers, page);
  page.counter("repeated_requests_total", status.repeated_requests,
               "Requests that were known already.");
  page.counter("cache_hits_total", status.cache_hits, "Requests answered from the cache.");
  page.counter("overloaded_requests_total", status.overloaded_requests,
               "Requests refused for want of room in the queue.");
  page.counter("malformed_messages_total", status.malformed_messages,
               "Messages that could not be read.");
  page.counter("dropped_answers_total", status.dropped_answers,
               "Answers dropped because too many waited to be sent.");
  page.head("pages_asked_again_total", "counter", "Lost pages that were asked for.");
  page.sample("pages_asked_again_total", "of=\"request\"", status.request_pages_asked_again);
  page.sample("pages_asked_again_total", "of=\"answer\"", status.answer_pages_asked_again);
  page.histogram("receipt_to_answer_seconds", status.receipt_to_answer,
                 "From when all pages of a plan request are there until its answer goes out.");
  page.histogram("waiting_seconds", status.waiting,
                 "From when all pages of a plan request are there until a worker begins.");
  page.histogram("planning_seconds", status.planning, "Planning alone.");
}

void add_distrusted(const status_t& status, Page& page) {
  page.head("distrusted_messages_total", "counter",
            "Messages whose signature is missing or not good, by cause.");
  const auto sample = [&](std::string_view cause, std::int64_t count) {
    page.sample("distrusted_messages_total", fmt::format("cause=\"{}\"", cause), count);
  };
  sample("unsigned", status.unsigned_messages);
  sample("broken", status.broken_envelopes);
  sample("unknown_key", status.unknown_key_messages);
  sample("wrong_key_or_altered", status.altered_messages);
  sample("stale", status.stale_messages);
  sample("replayed", status.replayed_messages);
  sample("crowded", status.crowded_messages);
}

void add_traffic(const status_t& status, Page& page) {
  page.counter("received_messages_total", status.received_messages, "Messages that came in.");
  page.counter("received_bytes_total", status.received_bytes, "Bytes of them.");
  page.counter("sent_messages_total", status.sent_messages, "Messages that went out.");
  page.counter("sent_bytes_total", status.sent_bytes, "Bytes of them.");
  page.counter("unsent_messages_total", status.unsent_messages, "Messages that LCM did not take.");
}

void add_reloads(const status_t& status, Page& page) {
  constexpr double kMicrosecond_s = 1e-6;
  page.counter("failed_reloads_total", status.failed_reloads,
               "Reloads of the configuration that failed.");
  page.gauge(
      "reload_failed", status.reload_failed != 0 ? 1 : 0,
      "1 if the last reload failed, so that what serves is not what the configuration says.");
  page.head("failed_reload_timestamp_seconds", "gauge",
            "When a reload last failed, and why; 0: none did.");
  page.sample("failed_reload_timestamp_seconds",
              fmt::format("reason=\"{}\"", escaped(status.failed_reload)),
              static_cast<double>(status.failed_reload_utime) * kMicrosecond_s);
}

void add_scenes(const status_t& status, Page& page) {
  page.gauge("scenes", status.total_scenes, "Scenes that are held.");
  page.counter("scene_changes_total", status.scene_changes,
               "Revisions of scenes that clients made.");
  page.gauge("watched_paths", status.watched_paths, "Paths that clients left to be watched.");
  page.counter("broken_paths_total", status.broken_paths,
               "Times that a change of a scene broke a watched path.");
  if (status.scenes.empty()) return;
  page.head("scene_revision", "gauge", "Newest revision of a scene.");
  for (const scene_info_t& scene : status.scenes) {
    page.sample("scene_revision", fmt::format("scene=\"{}\"", escaped(scene.name)), scene.revision);
  }
  page.head("scene_triangles", "gauge", "Triangles of a scene.");
  for (const scene_info_t& scene : status.scenes) {
    page.sample("scene_triangles", fmt::format("scene=\"{}\"", escaped(scene.name)),
                scene.num_triangles);
  }
}

/// A planner that was silent for longer counts as lost (`fleet::PlannerBoard::kSilence`).
constexpr double kPlannerSilence_s = 1.0;

void add_fleet(const status_t& status, Page& page) {
  std::int64_t heard = 0;
  std::int64_t slots = 0;
  std::int64_t taken = 0;
  for (const fleet_planner_t& planner : status.planners) {
    if (planner.silent_s >= kPlannerSilence_s) continue;
    ++heard;
    slots += planner.workers;
    taken += std::min(planner.running, planner.workers);
  }
  page.gauge("planners", heard, "Planners of the fleet that are heard.");
  page.head("planner_slots", "gauge", "Requests that the planners can plan at the same time.");
  page.sample("planner_slots", "state=\"free\"", slots - taken);
  page.sample("planner_slots", "state=\"taken\"", taken);
  page.counter("jobs_sent_again_total", status.jobs_sent_again,
               "Requests that were sent again, since their planner was lost or silent.");
  page.counter("differing_answers_total", status.differing_answers,
               "Requests to which two planners gave different answers.");
  page.counter("planned_here_total", status.planned_here,
               "Requests that a front planned by itself, since no planner could.");
  page.gauge("log_in_touch", status.log_in_touch != 0 ? 1 : 0,
             "1 if the log of scenes that the fleet shares can be reached.");
}

}  // namespace

std::string metrics_text(const status_t& status) {
  Page page;
  page.head("build_info", "gauge", "1, with the version of the daemon.");
  page.sample("build_info", fmt::format("version=\"{}\"", escaped(status.version)), 1);
  page.gauge("uptime_seconds", status.uptime_s, "Time since the start.");
  page.gauge("durable", status.daemon_start.durable ? 1 : 0,
             "Whether the scenes outlive the daemon.");
  page.gauge("workers", status.num_workers, "Requests that can be planned at the same time.");
  page.gauge("queued_requests", status.queued_requests, "Requests that wait for a worker.");
  page.gauge("running_requests", status.running_requests, "Requests that are being planned.");
  add_requests(status, page);
  add_distrusted(status, page);
  add_traffic(status, page);
  add_reloads(status, page);
  add_scenes(status, page);
  if (status.role == "front") add_fleet(status, page);
  return page.take();
}

}  // namespace camway::process
