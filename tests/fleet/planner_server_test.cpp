// SPDX-License-Identifier: MIT
#include "daemon/fleet/planner_server.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <limits>
#include <mutex>
#include <thread>

#include <camway/plan_progress_t.hpp>

#include "daemon/messages/plan.h"
#include "tests/fleet/test_fleet.h"

namespace camway::fleet {
namespace {

using std::chrono::milliseconds;
using testing::eventually;
using testing::MemoryBus;
using testing::MemoryNetwork;
using testing::Random;
using testing::room_request;
using testing::rooms;
using testing::TestPlanner;

constexpr std::uint64_t kServerSeed = 20261128;

/// A planner, and a front that speaks for itself.
class PlannerServerTest : public ::testing::Test {
 protected:
  PlannerServerTest() {
    planner_.follow(rooms_[1]);
    answers_ = bus_.subscribe("camway.answer.front",
                              [this](const std::string&, std::span<const std::uint8_t> bytes) {
                                const std::lock_guard lock(mutex_);
                                got_.push_back(*read_answer(bytes));
                              });
    statuses_ = bus_.subscribe("camway.planner",
                               [this](const std::string&, std::span<const std::uint8_t> bytes) {
                                 const std::lock_guard lock(mutex_);
                                 told_.push_back(*read_status(bytes));
                               });
    planner_.start();
  }

  void send(std::int64_t number, std::int64_t least_revision = 2, const Bytes& payload = {}) {
    fleet_job_t job{};
    job.front_id = "front";
    job.job = number;
    job.deadline_s = 30.0;
    job.least_revision = least_revision;
    const Bytes request = wire::encode(room_request("client", number, random_));
    publish_parts(bus_, "camway.plan.p", job, payload.empty() ? request : payload);
  }
  void cancel(std::int64_t number) {
    fleet_job_t job{};
    job.front_id = "front";
    job.job = number;
    job.kind = fleet_job_t::CANCEL;
    publish_parts(bus_, "camway.plan.p", job, {});
  }
  std::vector<fleet_answer_t> got(std::int8_t kind) {
    const std::lock_guard lock(mutex_);
    std::vector<fleet_answer_t> found;
    for (const fleet_answer_t& answer : got_) {
      if (answer.kind == kind) found.push_back(answer);
    }
    return found;
  }
  bool wait_for(std::int8_t kind, std::size_t count) {
    return eventually([&] { return got(kind).size() >= count; });
  }
  planner_status_t last_status() {
    const std::lock_guard lock(mutex_);
    return told_.empty() ? planner_status_t{} : told_.back();
  }

  const std::vector<std::shared_ptr<const scene::Snapshot>> rooms_ = rooms(3);
  Random random_{kServerSeed};
  MemoryNetwork network_;
  TestPlanner planner_{network_, "p"};
  std::mutex mutex_;  ///< guards the next two
  std::vector<fleet_answer_t> got_;
  std::vector<planner_status_t> told_;
  MemoryBus bus_{network_};
  std::unique_ptr<nats::Subscription> answers_;
  std::unique_ptr<nats::Subscription> statuses_;
};

TEST_F(PlannerServerTest, TellsItsStatus) {
  ASSERT_TRUE(eventually([&] { return last_status().workers == 1; }));
  const planner_status_t first = last_status();
  EXPECT_EQ(first.planner_id, "p");
  EXPECT_EQ(first.version, "test");
  EXPECT_EQ(first.pid, getpid());
  EXPECT_EQ(first.log_position, 2);
  EXPECT_EQ(first.running, 0);
  planner_.position = 9;
  EXPECT_TRUE(eventually([&] { return last_status().log_position == 9; }));
  planner_.held.hold();
  send(1);
  EXPECT_TRUE(eventually([&] { return last_status().running == 1; }));
  planner_.held.release();
  EXPECT_TRUE(eventually([&] { return last_status().running == 0; }));
  EXPECT_EQ(last_status().answered, 1);
  EXPECT_GT(last_status().serial, first.serial);
  EXPECT_EQ(last_status().start_id, first.start_id);
  const auto before = network_.sent_on("camway.planner");
  std::this_thread::sleep_for(milliseconds(1000));
  const int in_a_second = network_.sent_on("camway.planner") - before;
  EXPECT_GE(in_a_second, 2);
  EXPECT_LE(in_a_second, 5) << "four times a second where nothing happens";
}

TEST_F(PlannerServerTest, ASecondOneOfItsIdHearsThatItIsAlive) {
  fleet::PlannerOptions options;
  options.planner_id = "p";
  EXPECT_TRUE(is_planner_alive(bus_, options));
  options.planner_id = "q";
  EXPECT_FALSE(is_planner_alive(bus_, options));
  options.planner_id = "p";
  planner_.server->stop(milliseconds(1000));
  EXPECT_FALSE(is_planner_alive(bus_, options));
}

TEST_F(PlannerServerTest, StatusesKeepTheirDistance) {
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 2000; ++i) {
    planner_.server->position_changed();
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  const auto took = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(network_.sent_on("camway.planner"), took / milliseconds(10) + 2);
}

TEST_F(PlannerServerTest, TheSameJobRunsOnceAndIsAnsweredAgain) {
  planner_.held.hold();
  send(1);
  ASSERT_TRUE(planner_.held.wait_for_calls(1));
  send(1);
  ASSERT_TRUE(wait_for(fleet_answer_t::PROGRESS, 1)) << "it says that it has it";
  EXPECT_TRUE(got(fleet_answer_t::BUSY).empty());
  planner_.held.release();
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  send(1);
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 2));
  const auto answers = got(fleet_answer_t::ANSWER);
  EXPECT_EQ(answers[0].payload, answers[1].payload);
  EXPECT_EQ(planner_.held.calls(), 1);
  EXPECT_EQ(planner_.server->answered(), 1);
}

TEST_F(PlannerServerTest, ReportsProgressOfJobsThatTakeLong) {
  send(1);
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  planner_.held.hold();
  send(2);
  ASSERT_TRUE(wait_for(fleet_answer_t::PROGRESS, 3));
  const auto decoded = wire::decode<plan_progress_t>(got(fleet_answer_t::PROGRESS).back().payload);
  ASSERT_TRUE(decoded.message);
  EXPECT_EQ(decoded.message->stage, plan_progress_t::CORRECTING);
  EXPECT_EQ(decoded.message->num_collisions, 5);
  EXPECT_GT(decoded.message->since_receipt_s, 0.2);
  for (const fleet_answer_t& progress : got(fleet_answer_t::PROGRESS)) EXPECT_EQ(progress.job, 2);
}

TEST_F(PlannerServerTest, RefusesWhatItCannotDo) {
  send(1, 3);
  ASSERT_TRUE(wait_for(fleet_answer_t::BEHIND, 1));
  EXPECT_EQ(got(fleet_answer_t::BEHIND)[0].scene_revision, 2);
  send(2, 0, Bytes{1, 2, 3});
  ASSERT_TRUE(wait_for(fleet_answer_t::UNREADABLE, 1));
  EXPECT_EQ(planner_.server->running(), 0);
  planner_.held.hold();
  send(3);
  ASSERT_TRUE(planner_.held.wait_for_calls(1));
  send(4);
  ASSERT_TRUE(wait_for(fleet_answer_t::BUSY, 1));
  EXPECT_EQ(got(fleet_answer_t::BUSY)[0].job, 4);
  planner_.held.release();
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  send(4);
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 2)) << "a refused job may come again";
  send(1, 2);
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 3));
}

TEST_F(PlannerServerTest, WaitsALittleForItsScene) {
  planner_.held.hold();
  send(1, 3);
  std::this_thread::sleep_for(milliseconds(20));
  planner_.follow(rooms_[2]);
  planner_.held.release();
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  EXPECT_EQ(read_response(got(fleet_answer_t::ANSWER)[0].payload)->scene_revision, 3);
}

TEST_F(PlannerServerTest, AnUnknownSceneIsAnsweredAsTheDaemonDoes) {
  plan_request_t request = room_request("client", 1, random_);
  request.scene = "cellar";
  send(1, 1, wire::encode(request));
  ASSERT_TRUE(wait_for(fleet_answer_t::BEHIND, 1));
  EXPECT_EQ(got(fleet_answer_t::BEHIND)[0].scene_revision, 0);
  send(2, 0, wire::encode(request));
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  const auto answer = read_response(got(fleet_answer_t::ANSWER)[0].payload);
  EXPECT_EQ(answer->status, plan_response_t::STATUS_UNKNOWN_SCENE);
  EXPECT_EQ(answer->message, "scene: 'cellar' is unknown; there are: 'room'");
}

TEST_F(PlannerServerTest, ACancelledJobHasNoAnswerAndDoesNotRunAgain) {
  planner_.held.hold();
  send(1);
  ASSERT_TRUE(planner_.held.wait_for_calls(1));
  cancel(1);
  cancel(77);
  ASSERT_TRUE(eventually([&] { return planner_.server->running() == 0; }));
  planner_.held.release();
  send(1);
  send(2);
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  EXPECT_EQ(got(fleet_answer_t::ANSWER).size(), 1U);
  EXPECT_EQ(got(fleet_answer_t::ANSWER)[0].job, 2);
  EXPECT_EQ(planner_.held.calls(), 2);
}

TEST_F(PlannerServerTest, HeedsTheDeadlineThatRemains) {
  planner_.held.hold();
  fleet_job_t job{};
  job.front_id = "front";
  job.job = 1;
  job.deadline_s = 0.1;
  const auto begin = std::chrono::steady_clock::now();
  publish_parts(bus_, "camway.plan.p", job, wire::encode(room_request("client", 1, random_)));
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(3000));
  EXPECT_EQ(read_response(got(fleet_answer_t::ANSWER)[0].payload)->status,
            plan_response_t::STATUS_TIMEOUT);
}

TEST_F(PlannerServerTest, AStopDrains) {
  planner_.held.hold();
  send(1);
  ASSERT_TRUE(planner_.held.wait_for_calls(1));
  bool is_drained = false;
  std::thread end([&] { is_drained = planner_.end(std::chrono::seconds(30)); });
  ASSERT_TRUE(eventually([&] { return last_status().is_leaving != 0; }));
  EXPECT_EQ(last_status().workers, 1);
  send(2);
  ASSERT_TRUE(wait_for(fleet_answer_t::BUSY, 1));
  planner_.held.release();
  end.join();
  EXPECT_TRUE(is_drained);
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  EXPECT_TRUE(eventually([&] { return last_status().workers == 0; })) << "its last word";
  EXPECT_EQ(last_status().is_leaving, 1);
}

TEST_F(PlannerServerTest, APlannerThatLeavesTakesNoJobThoughASlotIsFree) {
  TestPlanner other(network_, "q", 2);
  other.follow(rooms_[1]);
  other.start();
  other.held.hold();
  const auto ask = [&](std::int64_t number) {
    fleet_job_t job{};
    job.front_id = "front";
    job.job = number;
    job.deadline_s = 30.0;
    publish_parts(bus_, "camway.plan.q", job,
                  wire::encode(room_request("client", number, random_)));
  };
  ask(1);
  ASSERT_TRUE(other.held.wait_for_calls(1));
  std::thread end([&] { other.end(std::chrono::seconds(30)); });
  ASSERT_TRUE(eventually([&] {
    const planner_status_t status = last_status();
    return status.planner_id == "q" && status.is_leaving != 0;
  }));
  ask(2);
  EXPECT_TRUE(wait_for(fleet_answer_t::BUSY, 1));
  other.held.release();
  end.join();
  EXPECT_EQ(other.held.calls(), 1);
}

TEST_F(PlannerServerTest, MalformedJobsHarmNothing) {
  Random random(kServerSeed + 1);
  fleet_job_t job{};
  job.front_id = "front";
  job.deadline_s = 1.0;
  for (int i = 0; i < 300; ++i) {
    fleet_job_t bad = job;
    bad.job = i;
    switch (i % 6) {
      case 0:
        bad.front_id = "a b";
        break;
      case 1:
        bad.deadline_s = std::numeric_limits<double>::quiet_NaN();
        break;
      case 2:
        bad.part = bad.num_parts = 3;
        break;
      case 3:
        bad.num_parts = 1 << 20;
        break;
      case 4:
        bad.kind = 9;
        break;
      default:
        bad.least_revision = -1;
    }
    bus_.publish("camway.plan.p", wire::encode(bad));
  }
  send(1000);
  ASSERT_TRUE(wait_for(fleet_answer_t::ANSWER, 1));
  EXPECT_EQ(planner_.held.calls(), 1);
  EXPECT_EQ(got(fleet_answer_t::ANSWER)[0].job, 1000);
}

}  // namespace
}  // namespace camway::fleet
