// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/record/event_log.h"
#include "lcmtypes/wire/check.h"
#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

/// A stand-in for a daemon: keeps every request, and answers planning requests if told to.
class Listener {
 public:
  enum class Manner { kAnswers, kAnswersWhenQuiet, kAnswersHalf, kIsSilent };

  explicit Listener(Manner manner) : manner_(manner) {
    // The tests prove nothing on a network without multicast.
    EXPECT_TRUE(lcm_.good()) << "LCM cannot use the network";
    if (!lcm_.good()) return;
    lcm_.subscribe("CAMWAY_.*_REQUEST", &Listener::on_request, this)->setQueueCapacity(1000);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        if (lcm_.handleTimeout(20) == 0) answer_all();
      }
    });
  }

  struct Received {
    std::string channel;
    std::vector<std::uint8_t> data;
    Clock::time_point time;
    std::size_t answered_before = 0;  ///< requests that had been answered when it came
  };
  /// Returns the messages so far, as soon as there are `count`, or after 10 s.
  std::vector<Received> received(std::size_t count) {
    const Clock::time_point limit = Clock::now() + std::chrono::seconds(10);
    for (;;) {
      {
        const std::lock_guard lock(mutex_);
        if (received_.size() >= count || Clock::now() > limit) return received_;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

 private:
  void on_request(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    const std::vector<std::uint8_t> data(bytes, bytes + buffer->data_size);
    {
      const std::lock_guard lock(mutex_);
      received_.push_back({channel, data, Clock::now(), answered_});
    }
    if (manner_ == Manner::kIsSilent) return;
    if (const auto change = wire::decode<scene_request_t>(data); change.message) {
      changes_.push_back({change.message->client_id, change.message->request_id, 0});
    }
    if (const auto request = wire::decode<plan_request_t>(data); request.message) {
      if (manner_ == Manner::kAnswersHalf && ++asked_ % 2 == 0) return;
      pending_.push_back({request.message->client_id, request.message->request_id, 0});
    }
    if (manner_ != Manner::kAnswersWhenQuiet) answer_all();
  }

  void answer_all() {
    for (const messages::RequestIds& ids : pending_) {
      const auto answer =
          messages::plain_answer(plan_response_t::STATUS_OVERLOADED, "busy", {ids, "wall", 1, ""});
      lcm_.publish("CAMWAY_PLAN_RESPONSE_" + ids.client_id, &answer);
      ++answered_;
    }
    pending_.clear();
    for (const messages::RequestIds& ids : changes_) {
      scene_response_t answer{};
      answer.client_id = ids.client_id;
      answer.request_id = ids.request_id;
      answer.status = scene_response_t::STATUS_OK;
      lcm_.publish("CAMWAY_SCENE_RESPONSE_" + ids.client_id, &answer);
      ++answered_;
    }
    changes_.clear();
  }

  Manner manner_;
  // Used by the thread alone.
  std::vector<messages::RequestIds> pending_, changes_;
  std::size_t asked_ = 0;     ///< planning requests
  std::size_t answered_ = 0;  ///< requests
  lcm::LCM lcm_;
  std::mutex mutex_;  ///< guards received_
  std::vector<Received> received_;
  std::jthread thread_;  ///< last: it uses the others
};

/// Returns the id of a planning request.
std::int64_t id_of(const std::vector<std::uint8_t>& data) {
  const auto sender = wire::peek_sender(wire::layout_of<plan_request_t>(), data);
  EXPECT_TRUE(sender);
  return sender ? sender->request_id : 0;
}

/// Returns a request that moves an object of the scene `wall`.
scene_request_t move_request(std::int64_t id) {
  scene_request_t request{};
  request.client_id = "mover";
  request.request_id = id;
  request.operation = scene_request_t::MOVE;
  request.scene = "wall";
  request.object = "crate";
  return request;
}

class Publish : public ::testing::Test {
 protected:
  Publish() {
    for (int i = 0; i < 6; ++i) {
      log_.add_request(simple_request({{1, 0, 1}, {1, 0, -1}}), {"client", i, 0});
      log_.add_event("OTHER_CHANNEL", {1, 2, 3});
    }
    log_.add_event("CAMWAY_OCCUPANCY_REQUEST", {7, 7});
    log_.add_event("CAMWAY_PLAN_REQUEST", {8, 8, 8});  // malformed, and sent as it was
    file_ = folder_.write("log", log_.bytes());
  }

  TemporaryFolder folder_;
  LogBuilder log_;
  std::string file_;
};

TEST_F(Publish, SendsTheRecordedRequestsWithNewIdsAndCountsAnswersByStatus) {
  Listener listener(Listener::Manner::kAnswers);
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out,
              HasSubstr("sent 8 messages; 6 of 6 planning requests answered: 6 overloaded"));
  const auto received = listener.received(8);
  ASSERT_EQ(received.size(), 8U);
  const std::int64_t shift = id_of(received[0].data);
  EXPECT_NE(shift, 0);
  std::size_t at = 0;
  record::read_event_log(file_, [&](record::LogEvent&& event) {
    if (event.channel == "OTHER_CHANNEL") return;
    EXPECT_EQ(received[at].channel, event.channel);
    auto request = wire::decode<plan_request_t>(event.data);
    if (request.message) request.message->request_id += shift;
    EXPECT_EQ(received[at].data, request.message ? wire::encode(*request.message) : event.data);
    ++at;
  });
}

TEST_F(Publish, SendsOtherIdsInEachRun) {
  Listener listener(Listener::Manner::kAnswers);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(run_camway({"replay", file_, "--publish", "--speed", "0", "--id", "1"}).exit_code, 0);
  }
  const auto received = listener.received(2);
  ASSERT_EQ(received.size(), 2U);
  EXPECT_NE(id_of(received[0].data), id_of(received[1].data))
      << "a daemon would repeat its first answer";
}

/// A log with changes of a scene: one that was made, one that was refused, and one that restores a
/// revision, with a planning request before and after.
class PublishChanges : public Publish {
 protected:
  PublishChanges() {
    LogBuilder log;
    log.add_request(simple_request({{1, 0, 1}, {1, 0, -1}}), {"client", 1, 0});
    add_change(log, move_request(1), scene_response_t::STATUS_OK, 2);
    add_change(log, move_request(2), scene_response_t::STATUS_INVALID, 0);
    scene_request_t restoring = move_request(3);
    restoring.operation = scene_request_t::RESTORE;
    add_change(log, restoring, scene_response_t::STATUS_OK, 3);
    planning::PlanRequest later = simple_request({{1, 0, 1}, {1, 0, -1}});
    log.add_request(later, {"client", 2, 0});
    file_ = folder_.write("changes", log.bytes());
  }

 private:
  static void add_change(LogBuilder& log, const scene_request_t& request, std::int32_t status,
                         std::int64_t revision) {
    log.add_event("CAMWAY_SCENE_REQUEST", wire::encode(request));
    scene_response_t answer{};
    answer.client_id = request.client_id;
    answer.request_id = request.request_id;
    answer.status = status;
    answer.scene.name = request.scene;
    answer.scene.revision = revision;
    log.add_event("CAMWAY_SCENE_RESPONSE_mover", wire::encode(answer));
  }
};

TEST_F(PublishChanges, SendsThoseThatWereMadeAndWaitsForTheirAnswers) {
  Listener listener(Listener::Manner::kAnswersWhenQuiet);
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("sent 3 messages; 2 of 2 planning requests answered"));
  EXPECT_THAT(run.out, HasSubstr("1 of 1 change of scenes made"));
  EXPECT_THAT(run.out, HasSubstr("note: 1 change of scenes was not sent: the session has no"));
  const auto received = listener.received(3);
  ASSERT_EQ(received.size(), 3U);
  const auto change = wire::decode<scene_request_t>(received[1].data);
  ASSERT_TRUE(change.message);
  EXPECT_EQ(change.message->request_id, id_of(received[0].data)) << "shifted as the others";
  EXPECT_EQ(received[2].answered_before, 2U) << "the change was answered before it came";
}

TEST_F(PublishChanges, AreNotPartOfASelection) {
  Listener listener(Listener::Manner::kAnswers);
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0", "--id", "1..9"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("sent 2 messages; 2 of 2 planning requests answered"));
  EXPECT_THAT(run.out, HasSubstr("2 changes of scenes were not sent: a selection sends planning "
                                 "requests alone"));
}

TEST_F(Publish, KeepsTheRecordedRhythm) {
  Listener listener(Listener::Manner::kAnswers);
  // The log's events are 1 ms apart: 12 ms from first to last request are 600 ms at this speed.
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0.02"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto received = listener.received(8);
  ASSERT_EQ(received.size(), 8U);
  // Only a lower limit: a busy machine may be late, never early. Half, because the first may be
  // late.
  EXPECT_GE(received.back().time - received.front().time, std::chrono::milliseconds(300));
}

TEST_F(Publish, SendsEachRequestWhenTheOneBeforeIsAnswered) {
  Listener listener(Listener::Manner::kAnswersWhenQuiet);
  const CliRun run = run_camway({"replay", file_, "--publish", "--lockstep"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto received = listener.received(8);
  ASSERT_EQ(received.size(), 8U);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_EQ(received[i].answered_before, i) << "answers that were sent before it came";
  }
}

TEST_F(Publish, LockstepGoesOnWhenNobodyAnswers) {
  Listener listener(Listener::Manner::kIsSilent);
  const CliRun run = run_camway({"replay", file_, "--publish", "--lockstep", "--wait-s", "0.05"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_EQ(listener.received(8).size(), 8U);
}

TEST_F(Publish, SendsAllSeveralTimesWithNewIds) {
  Listener listener(Listener::Manner::kAnswers);
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0", "--times", "3"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("sent 24 messages; 18 of 18 planning requests answered"));
  std::multiset<std::int64_t> ids;
  for (const auto& each : listener.received(24)) {
    const auto request = wire::decode<plan_request_t>(each.data);
    if (request.message) ids.insert(request.message->request_id);
  }
  ASSERT_EQ(ids.size(), 18U);
  std::multiset<std::int64_t> expected;
  for (int id = 0; id < 18; ++id) expected.insert(*ids.begin() + id);
  EXPECT_EQ(ids, expected);
}

TEST_F(Publish, SendsTheSelectedRequestsAlone) {
  Listener listener(Listener::Manner::kAnswers);
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0", "--id", "1..2,4"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("sent 3 messages; 3 of 3 planning requests answered"));
}

TEST_F(Publish, EndsWithFourWhenNobodyAnswers) {
  Listener listener(Listener::Manner::kIsSilent);
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0", "--wait-s", "0.2"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(run.out, HasSubstr("0 of 6 planning requests answered"));
  EXPECT_THAT(run.err, HasSubstr("no daemon was heard on CAMWAY_*"));
  EXPECT_EQ(listener.received(8).size(), 8U);
}

TEST_F(Publish, NamesRequestsWithoutAnswerByTheirRecordedIds) {
  Listener listener(Listener::Manner::kAnswersHalf);
  const CliRun run = run_camway({"replay", file_, "--publish", "--speed", "0", "--wait-s", "0.5"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 of 6 planning requests answered: 3 overloaded"));
  EXPECT_THAT(run.err, HasSubstr("3 requests not answered within 0.5 s after the last message "
                                 "(client 1, client 3, client 5): --wait-s waits longer"));
}

TEST_F(Publish, RefusesTheOptionsOfPlanningHere) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--json", "out.json"},
                                                {"--html", "out.html"},
                                                {"--scene", "wall=wall.obj"},
                                                {"--threads", "2"},
                                                {"--fail-on", "worse"}}) {
    std::vector<std::string> all{"replay", file_, "--publish"};
    all.insert(all.end(), words.begin(), words.end());
    const CliRun run = run_camway(all);
    EXPECT_EQ(run.exit_code, 2) << words[0];
    EXPECT_THAT(run.err, HasSubstr(words[0]));
    EXPECT_THAT(run.err, HasSubstr("--publish"));
  }
}

TEST_F(Publish, EndsWithTwoWhereThereIsNothingToSend) {
  const CliRun run = run_camway({"replay", file_, "--publish", "--prefix", "OTHER"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("holds no requests on OTHER_"));
}

TEST_F(Publish, SaysThatNoDaemonReadsTheRequestsOfAnotherVersion) {
  Listener listener(Listener::Manner::kAnswers);
  std::vector<std::uint8_t> older =
      wire::encode(messages::to_wire(simple_request({{1, 0, 1}, {1, 0, -1}}), {"client", 9, 0}));
  older[3] ^= 1;  // within the fingerprint
  log_.add_event("CAMWAY_PLAN_REQUEST", older);
  const CliRun run =
      run_camway({"replay", folder_.write("log", log_.bytes()), "--publish", "--speed", "0"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("of another version of the wire types"));
  EXPECT_EQ(listener.received(9).size(), 9U) << "sent as recorded all the same";
}

}  // namespace
}  // namespace camway::tools
