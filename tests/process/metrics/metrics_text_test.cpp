// SPDX-License-Identifier: MIT
#include "daemon/process/metrics/metrics_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "daemon/service/core/latency_histogram.h"
#include "tests/support/prometheus_checker.h"

namespace camway::process {
namespace {

using testing::PrometheusChecker;

TEST(MetricsText, IsWhatPrometheusReads) {
  status_t status{};
  status.version = "1.2 \"odd\\one\"\n";
  status.plan_answers[0] = 3;
  status.scene_answers[11] = 1;
  status.occupancy_answers[15] = 2;
  status.sent_bytes = 1'234'567'890'123;
  status.reload_failed = 1;
  status.failed_reload_utime = 1'500'000;
  status.failed_reload = "c.toml:3: 'a\"b'";
  service::LatencyHistogram latency;
  for (const double seconds : {1e-6, 2e-3, 2e-3, 1.5, 1e4}) latency.add(seconds);
  status.receipt_to_answer = latency.to_wire();
  status.scenes.resize(1);
  status.scenes[0].name = "office";
  status.scenes[0].revision = 7;

  const PrometheusChecker page(metrics_text(status));
  EXPECT_EQ(page.faults(), "");
  EXPECT_EQ(page.value(R"(camway_build_info{version="1.2 \"odd\\one\"\n"})"), 1);
  EXPECT_EQ(page.value(R"(camway_answers_total{kind="plan",status="ok"})"), 3);
  EXPECT_EQ(page.value(R"(camway_answers_total{kind="scene",status="limit"})"), 1);
  EXPECT_EQ(page.value(R"(camway_answers_total{kind="occupancy",status="15"})"), 2);
  EXPECT_EQ(page.value("camway_reload_failed"), 1);
  EXPECT_EQ(page.value(R"(camway_failed_reload_timestamp_seconds{reason="c.toml:3: 'a\"b'"})"),
            1.5);
  EXPECT_EQ(page.value("camway_sent_bytes_total"), 1'234'567'890'123);
  EXPECT_EQ(page.value(R"(camway_scene_revision{scene="office"})"), 7);
  EXPECT_EQ(page.value(R"(camway_receipt_to_answer_seconds_bucket{le="1e-05"})"), 1);
  EXPECT_EQ(page.value(R"(camway_receipt_to_answer_seconds_bucket{le="0.00256"})"), 3);
  EXPECT_EQ(page.value(R"(camway_receipt_to_answer_seconds_bucket{le="+Inf"})"), 5);
  EXPECT_EQ(page.value("camway_waiting_seconds_count"), 0);
}

TEST(MetricsText, EachCounterStandsUnderItsOwnName) {
  status_t status{};
  std::int64_t next = 100;
  for (std::int64_t* counter : {&status.repeated_requests,
                                &status.cache_hits,
                                &status.overloaded_requests,
                                &status.malformed_messages,
                                &status.dropped_answers,
                                &status.request_pages_asked_again,
                                &status.answer_pages_asked_again,
                                &status.unsigned_messages,
                                &status.broken_envelopes,
                                &status.unknown_key_messages,
                                &status.altered_messages,
                                &status.stale_messages,
                                &status.replayed_messages,
                                &status.crowded_messages,
                                &status.received_messages,
                                &status.received_bytes,
                                &status.sent_messages,
                                &status.sent_bytes,
                                &status.unsent_messages,
                                &status.scene_changes,
                                &status.broken_paths,
                                &status.failed_reloads}) {
    *counter = next++;
  }
  const PrometheusChecker page(metrics_text(status));
  next = 100;
  for (const char* name : {"repeated_requests_total",
                           "cache_hits_total",
                           "overloaded_requests_total",
                           "malformed_messages_total",
                           "dropped_answers_total",
                           R"(pages_asked_again_total{of="request"})",
                           R"(pages_asked_again_total{of="answer"})",
                           R"(distrusted_messages_total{cause="unsigned"})",
                           R"(distrusted_messages_total{cause="broken"})",
                           R"(distrusted_messages_total{cause="unknown_key"})",
                           R"(distrusted_messages_total{cause="wrong_key_or_altered"})",
                           R"(distrusted_messages_total{cause="stale"})",
                           R"(distrusted_messages_total{cause="replayed"})",
                           R"(distrusted_messages_total{cause="crowded"})",
                           "received_messages_total",
                           "received_bytes_total",
                           "sent_messages_total",
                           "sent_bytes_total",
                           "unsent_messages_total",
                           "scene_changes_total",
                           "broken_paths_total",
                           "failed_reloads_total"}) {
    EXPECT_EQ(page.value(std::string("camway_") + name), next++) << name;
  }
}

TEST(MetricsText, AFrontTellsOfItsPlanners) {
  status_t status{};
  status.role = "alone";
  EXPECT_EQ(metrics_text(status).find("planner"), std::string::npos);
  status.role = "front";
  status.log_in_touch = 1;
  status.jobs_sent_again = 3;
  status.differing_answers = 4;
  status.planned_here = 5;
  status.planners.resize(3);
  status.planners[0].workers = 8;
  status.planners[0].running = 3;
  status.planners[1].workers = 1;
  status.planners[1].running = 2;  // a planner that lies
  status.planners[2].workers = 9;
  status.planners[2].silent_s = 1.0;  // one that is lost
  const PrometheusChecker page(metrics_text(status));
  EXPECT_EQ(page.faults(), "");
  EXPECT_EQ(page.value("camway_planners"), 2);
  EXPECT_EQ(page.value(R"(camway_planner_slots{state="free"})"), 5);
  EXPECT_EQ(page.value(R"(camway_planner_slots{state="taken"})"), 4);
  EXPECT_EQ(page.value("camway_jobs_sent_again_total"), 3);
  EXPECT_EQ(page.value("camway_differing_answers_total"), 4);
  EXPECT_EQ(page.value("camway_planned_here_total"), 5);
  EXPECT_EQ(page.value("camway_log_in_touch"), 1);
}

/// The checker detects the faults for which it was made.
TEST(MetricsText, TheCheckerFindsFaults) {
  const auto faults = [](const std::string& text) { return PrometheusChecker(text).faults(); };
  const std::string head = "# HELP a_total b\n# TYPE a_total counter\n";
  EXPECT_EQ(faults(head + "a_total 1\n"), "");
  EXPECT_NE(faults(head + "a_total 1"), "");
  EXPECT_NE(faults(head + "a_total one\n"), "");
  EXPECT_NE(faults(head + "a_total 1\na_total 2\n"), "");
  EXPECT_NE(faults(head + "b_total 1\n"), "");
  EXPECT_NE(faults(head + "a_total{b=c} 1\n"), "");
  EXPECT_NE(faults("a_total 1\n"), "");
  EXPECT_NE(faults(head), "");
  const std::string histogram = "# HELP h b\n# TYPE h histogram\nh_sum 1\n";
  EXPECT_EQ(faults(histogram + "h_bucket{le=\"1\"} 1\nh_bucket{le=\"+Inf\"} 2\nh_count 2\n"), "");
  EXPECT_NE(faults(histogram + "h_bucket{le=\"1\"} 3\nh_bucket{le=\"+Inf\"} 2\nh_count 2\n"), "");
  EXPECT_NE(faults(histogram + "h_bucket{le=\"1\"} 1\nh_bucket{le=\"+Inf\"} 2\nh_count 3\n"), "");
  EXPECT_NE(faults(histogram + "h_bucket{le=\"1\"} 1\nh_count 1\n"), "");
}

}  // namespace
}  // namespace camway::process
