// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <camway/plan_response_t.hpp>
#include <camway/watch_t.hpp>

#include "client/engine/watch_list.h"
#include "lcmtypes/wire/check.h"

namespace camway::testing_support {

/// The request that is watched.
inline constexpr std::int64_t kId = 7;

/// The daemon and the scene that an answer comes from.
struct From {
  std::int64_t start_id = 0;
  bool is_durable = false;
  const char* digest = "same";
};

/// A watch list whose messages and calls the test collects.
class WatchListTest : public ::testing::Test {
 protected:
  WatchListTest()
      : context_([] {
          ClientOptions options;
          options.client_id = "tester";
          options.watch_lease_s = 30.0;
          return options;
        }()),
        list_(context_,
              {[this](Outgoing message) { sent_.push_back(std::move(message)); },
               [this](std::shared_ptr<Call> call) { calls_.push_back(std::move(call)); }}) {
    PlanRequest request;
    request.request_id = kId;
    request.scene = "office";
    request.keyframes.resize(2);
    list_.add(request, [this](const WatchEvent& event) { events_.push_back(event); });
  }

  /// The status of a daemon that has run for so long.
  static DaemonStatus up_for(double uptime_s, std::int64_t start_id = 1,
                             std::int64_t scene_revision = 0) {
    DaemonStatus status;
    status.uptime_s = uptime_s;
    status.daemon_start.id = start_id;
    if (scene_revision > 0) {
      SceneInfo scene;
      scene.name = "office";
      scene.revision = scene_revision;
      status.scenes = {scene};
    }
    return status;
  }

  /// Steps like the engine for some time, with a heartbeat each second if `beats`.
  void live(Clock::duration how_long, bool beats) {
    for (Clock::duration passed{}; passed < how_long; passed += std::chrono::milliseconds(50)) {
      step_at(std::chrono::milliseconds(50));
      if (beats && passed % std::chrono::seconds(1) == Clock::duration::zero()) {
        list_.take_heartbeat(up_for(1000.0), now_);
      }
    }
  }

  std::ptrdiff_t told(WatchEvent::Kind kind) const {
    return std::ranges::count(events_, kind, &WatchEvent::kind);
  }

  static Bytes answer(std::int64_t revision, std::int32_t status = plan_response_t::STATUS_OK,
                      const From& from = {}) {
    plan_response_t page{};
    page.scene = "office";
    page.scene_digest = from.digest;
    page.daemon_start.id = from.start_id;
    page.daemon_start.durable = from.is_durable ? 1 : 0;
    page.client_id = "tester";
    page.request_id = kId;
    page.num_pages = 1;
    page.status = status;
    page.scene_revision = revision;
    page.near_scale = page.time_scale = 1.0;
    if (status == plan_response_t::STATUS_OK) {
      page.certified = 1;
      page.segments.resize(1);
      page.segments[0].t1_s = 1.0;
      page.num_segments = 1;
    }
    return wire::encode(page);
  }

  /// Ends the last call with this answer.
  void finish_call(const Bytes& bytes) {
    ASSERT_FALSE(calls_.empty());
    const std::shared_ptr<Call> call = calls_.back();
    call->take_answer(bytes, now_);
    call->finish(call->answered() ? Outcome::kAnswered : Outcome::kSilence);
  }

  void report(std::int64_t serial, std::int8_t state, std::int64_t revision,
              std::int64_t answer_revision, std::int64_t answers = 0,
              std::int64_t offer_revision = 0, std::int64_t start_id = 0) {
    watch_report_t message{};
    message.daemon_start.id = start_id;
    message.client_id = "tester";
    message.request_id = answers;
    path_state_t path{};
    path.request_id = kId;
    path.serial = serial;
    path.state = state;
    path.scene_revision = revision;
    path.answer_revision = answer_revision;
    path.offer_revision = offer_revision;
    message.paths = {path};
    message.num_paths = 1;
    if (state == path_state_t::BROKEN) {
      broken_interval_t interval{};
      interval.request_id = kId;
      interval.t_begin_s = 0.25;
      interval.t_end_s = 0.5;
      message.intervals = {interval};
      message.num_intervals = 1;
    }
    list_.take_report(wire::encode(message), now_);
  }

  /// Returns the messages since the last call of this function.
  std::vector<watch_t> sent() {
    std::vector<watch_t> messages;
    for (const Outgoing& message : std::exchange(sent_, {})) {
      EXPECT_EQ(message.channel, "CAMWAY_WATCH");
      messages.push_back(wire::decode<watch_t>(message.bytes).message.value());
    }
    return messages;
  }

  /// Returns these messages without requests for a sign of life.
  std::vector<watch_t> sent_renewals() {
    std::vector<watch_t> messages = sent();
    std::erase_if(messages, [](const watch_t& message) { return message.num_paths == 0; });
    return messages;
  }

  void step_at(Clock::duration later) {
    now_ += later;
    list_.step(now_);
  }

  /// Adds a path that is answered at revision 3 and known to be watched.
  void begin() {
    step_at({});
    finish_call(answer(3));
    report(100, path_state_t::FREE, 3, 3);
    step_at({});
    sent();
  }

  Context context_;
  Clock::time_point now_ = Clock::now();
  std::vector<Outgoing> sent_;
  std::vector<std::shared_ptr<Call>> calls_;
  std::vector<WatchEvent> events_;
  WatchList list_;
};

}  // namespace camway::testing_support
