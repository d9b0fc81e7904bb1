// SPDX-License-Identifier: MIT
#include "daemon/fleet/remote_answerer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <thread>
#include <tuple>
#include <utility>

#include "daemon/messages/plan.h"
#include "daemon/service/heartbeat.h"
#include "tests/fleet/test_fleet.h"
#include "tests/messages/request_on_wire.h"
#include "tests/support/scenes.h"

namespace camway::fleet {
namespace {

using std::chrono::milliseconds;
using testing::Asked;
using testing::eventually;
using testing::MemoryNetwork;
using testing::Random;
using testing::room_request;
using testing::rooms;
using testing::TestFront;
using testing::TestPlanner;
using testing::timeless;

constexpr std::uint64_t kFleetSeed = 20261127;

/// A front and planners with one slot each, all at one revision of the room.
class RemoteAnswererTest : public ::testing::Test {
 protected:
  RemoteAnswererTest() { front_.follow(rooms_[3]); }

  TestPlanner& add(const std::string& id, int workers = 1) {
    TestPlanner& planner = planners_.emplace_back(network_, id, workers);
    planner.follow(rooms_[3]);
    planner.start();
    slots_ += workers;
    EXPECT_TRUE(eventually([&] { return front_.board.capacity() == slots_; }));
    return planner;
  }
  plan_request_t next_request() { return room_request("client", ++next_id_, random_); }
  void expect_local(const plan_request_t& request, const plan_response_t& answer) {
    EXPECT_EQ(timeless(answer), timeless(front_.local(request))) << answer.message;
  }

  const std::vector<std::shared_ptr<const scene::Snapshot>> rooms_ = rooms(8);
  Random random_{kFleetSeed};
  MemoryNetwork network_{kFleetSeed};
  std::deque<TestPlanner> planners_;
  TestFront front_{network_, "front"};
  int slots_ = 0;
  std::int64_t next_id_ = 0;
};

TEST_F(RemoteAnswererTest, PlansHereWhereThereIsNoPlanner) {
  const plan_request_t request = next_request();
  expect_local(request, front_.answer(request));
  EXPECT_EQ(front_.counts().planned_here, 1);
}

TEST_F(RemoteAnswererTest, AFleetOfThreeAnswersAsOneDoes) {
  for (const char* id : {"a", "b", "c"}) add(id);
  for (int round = 0; round < 10; ++round) {
    const std::vector<plan_request_t> requests{next_request(), next_request(), next_request()};
    std::deque<Asked> asked;
    for (const plan_request_t& request : requests) asked.emplace_back(front_, request);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      expect_local(requests[i], asked[i].answer());
      EXPECT_EQ(asked[i].answer().request_id, requests[i].request_id);
    }
  }
  EXPECT_EQ(front_.counts().planned_here, 0);
  EXPECT_EQ(front_.counts().jobs_sent_again, 0);
  EXPECT_EQ(front_.held.calls(), 0);
  for (const TestPlanner& planner : planners_) EXPECT_GT(planner.held.calls(), 0);
}

TEST_F(RemoteAnswererTest, APlannerThatDiesIsReplaced) {
  TestPlanner& a = add("a");
  a.held.hold();
  const plan_request_t request = next_request();
  Asked asked(front_, request);
  ASSERT_TRUE(a.held.wait_for_calls(1));
  TestPlanner& b = planners_.emplace_back(network_, "b");
  b.follow(rooms_[3]);
  b.start();
  a.bus.cut();
  expect_local(request, asked.answer());
  EXPECT_EQ(b.held.calls(), 1);
  EXPECT_EQ(front_.counts().jobs_sent_again, 1);
  EXPECT_EQ(front_.counts().planned_here, 0);
}

TEST_F(RemoteAnswererTest, ALoneFrontTakesOverWhereTheLastPlannerDies) {
  TestPlanner& a = add("a");
  a.held.hold();
  const plan_request_t request = next_request();
  Asked asked(front_, request);
  ASSERT_TRUE(a.held.wait_for_calls(1));
  a.bus.cut();
  expect_local(request, asked.answer());
  EXPECT_EQ(front_.counts().planned_here, 1);
}

TEST_F(RemoteAnswererTest, AnEndOfAPlannerIsNoLoss) {
  TestPlanner& a = add("a");
  TestPlanner& b = add("b");
  a.held.hold();
  const plan_request_t request = next_request();
  Asked asked(front_, request);
  ASSERT_TRUE(a.held.wait_for_calls(1));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(a.end(milliseconds(50))) << "a job ran still";
  expect_local(request, asked.answer());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(900)) << "not by its silence";
  EXPECT_EQ(b.held.calls(), 1);
  EXPECT_EQ(front_.counts().jobs_sent_again, 1);
}

TEST_F(RemoteAnswererTest, APlannerThatLeavesFinishesItsJobsAndGetsNoMore) {
  TestPlanner& a = add("a", 2);
  a.held.hold();
  const plan_request_t first = next_request();
  Asked asked(front_, first);
  ASSERT_TRUE(a.held.wait_for_calls(1));
  std::thread end([&] { EXPECT_TRUE(a.end(std::chrono::seconds(30))); });
  ASSERT_TRUE(front_.wait_for_slots(0));
  const plan_request_t second = next_request();
  expect_local(second, front_.answer(second));
  EXPECT_EQ(front_.counts().planned_here, 1);
  a.held.release();
  expect_local(first, asked.answer());
  end.join();
  EXPECT_EQ(front_.counts().jobs_sent_again, 0);
}

TEST_F(RemoteAnswererTest, TheLastAnswerOfAPlannerMayFollowItsLastWord) {
  // Statuses and answers come by two subscriptions, so their order is not that of the planner.
  testing::MemoryBus bus(network_);
  const plan_request_t request = next_request();
  const Bytes answer = wire::encode(front_.local(request));
  planner_status_t status{};
  status.planner_id = "p";
  status.start_id = 1;
  status.workers = 1;
  status.log_position = 1'000;
  std::mutex mutex;
  std::vector<fleet_job_t> jobs;
  const auto subscription =
      bus.subscribe("camway.plan.p", [&](const std::string&, std::span<const std::uint8_t> bytes) {
        const std::lock_guard lock(mutex);
        jobs.push_back(*read_job(bytes));
      });
  status.serial = 1;
  bus.publish("camway.planner", wire::encode(status));
  ASSERT_TRUE(front_.wait_for_slots(1));
  Asked asked(front_, request);
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return jobs.size() == 1;
  }));
  status.serial = 2;
  status.workers = 0;
  status.is_leaving = 1;
  bus.publish("camway.planner", wire::encode(status));
  ASSERT_TRUE(front_.wait_for_slots(0));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  fleet_answer_t head{};
  head.planner_id = "p";
  head.job = jobs[0].job;
  head.kind = fleet_answer_t::ANSWER;
  publish_parts(bus, "camway.answer." + jobs[0].front_id, head, answer);
  expect_local(request, asked.answer());
  EXPECT_EQ(front_.counts().jobs_sent_again, 0);
  EXPECT_EQ(front_.counts().planned_here, 0);
}

TEST_F(RemoteAnswererTest, AStalledPlannersLateAnswerIsComparedAndEqual) {
  TestPlanner& a = add("a");
  const plan_request_t request = next_request();
  a.held.hold();
  Asked asked(front_, request);
  ASSERT_TRUE(a.held.wait_for_calls(1));
  TestPlanner& b = add("b");
  a.bus.stall();
  expect_local(request, asked.answer());
  EXPECT_EQ(b.held.calls(), 1);
  a.held.release();
  a.bus.go_on();
  ASSERT_TRUE(eventually([&] { return a.server->answered() == 1; }));
  ASSERT_TRUE(front_.wait_for_slots(2)) << "it is heard again";
  // Answers arrive in order, so the late one was compared before this one comes.
  b.held.hold();
  const plan_request_t next = next_request();
  expect_local(next, front_.answer(next));
  EXPECT_EQ(a.held.calls(), 2);
  EXPECT_EQ(front_.counts().differing_answers, 0);
  EXPECT_EQ(front_.counts().jobs_sent_again, 1);
}

TEST_F(RemoteAnswererTest, TwoPlannersThatDifferRaiseTheAlarm) {
  TestPlanner& a = add("a");
  a.held.hold();
  a.bus.falsify([](const std::string& subject, wire::Bytes& bytes) {
    if (!subject.starts_with("camway.answer.")) return;
    wire::Decoded<fleet_answer_t> message = wire::decode<fleet_answer_t>(bytes);
    if (message.message->kind != fleet_answer_t::ANSWER) return;
    plan_response_t answer = *read_response(message.message->payload);
    ASSERT_FALSE(answer.segments.empty());
    answer.segments[0].position_m[1][0] = std::nextafter(answer.segments[0].position_m[1][0], 1e9);
    message.message->payload = wire::encode(answer);
    bytes = wire::encode(*message.message);
  });
  const plan_request_t request = next_request();
  Asked asked(front_, request);
  ASSERT_TRUE(a.held.wait_for_calls(1));
  add("b");
  a.bus.stall();
  expect_local(request, asked.answer());
  EXPECT_EQ(front_.counts().differing_answers, 0);
  a.held.release();
  a.bus.go_on();
  ASSERT_TRUE(eventually([&] { return front_.counts().differing_answers == 1; }))
      << front_.log.text() << a.log.text();
  const std::string log = front_.log.text();
  EXPECT_NE(log.find("error two planners answered a request differently client=client request=1 "
                     "planner=b other_planner=a"),
            std::string::npos)
      << log;
}

TEST_F(RemoteAnswererTest, APlannerThatIsBehindNeverAnswers) {
  TestPlanner& a = add("a");
  front_.follow(rooms_[5]);
  const plan_request_t request = next_request();
  const plan_response_t answer = front_.answer(request);
  expect_local(request, answer);
  EXPECT_EQ(answer.scene_revision, 6);
  EXPECT_EQ(front_.counts().planned_here, 1) << "it was waited for in vain";
  EXPECT_EQ(a.held.calls(), 0);

  a.position = 6;  // it says that it has read all, but lacks the scene
  ASSERT_TRUE(eventually([&] { return front_.board.planners(6).at(0).is_behind == 0; }));
  expect_local(request, front_.answer(request));
  EXPECT_EQ(front_.counts().planned_here, 2);
  EXPECT_EQ(a.held.calls(), 0);
  EXPECT_GE(network_.sent_on("camway.plan.a"), 1) << "it was asked, and said so";

  a.follow(rooms_[5]);
  ASSERT_TRUE(front_.wait_for_slots(1));
  expect_local(request, front_.answer(request));
  EXPECT_EQ(front_.counts().planned_here, 2);
}

TEST_F(RemoteAnswererTest, APlannerThatCatchesUpIsWaitedFor) {
  TestPlanner& a = add("a");
  front_.follow(rooms_[5]);
  const plan_request_t request = next_request();
  Asked asked(front_, request);
  std::this_thread::sleep_for(milliseconds(60));
  a.follow(rooms_[5]);
  expect_local(request, asked.answer());
  EXPECT_EQ(front_.counts().planned_here, 0);
}

TEST_F(RemoteAnswererTest, AnAnswerOnAnOlderSceneIsNotGiven) {
  TestPlanner& a = add("a");
  front_.follow(rooms_[5]);
  a.position = 6;
  // A planner that does not heed the least revision.
  front_.bus.falsify([](const std::string& subject, wire::Bytes& bytes) {
    if (subject != "camway.plan.a") return;
    fleet_job_t job = *read_job(bytes);
    job.least_revision = 0;
    bytes = wire::encode(job);
  });
  ASSERT_TRUE(eventually([&] { return front_.board.planners(6).at(0).is_behind == 0; }));
  const plan_request_t request = next_request();
  const plan_response_t answer = front_.answer(request);
  EXPECT_EQ(a.held.calls(), 1);
  EXPECT_EQ(answer.scene_revision, 6);
  expect_local(request, answer);
  EXPECT_NE(front_.log.text().find("it is of revision 4 of the scene, older than 6"),
            std::string::npos)
      << front_.log.text();
}

TEST_F(RemoteAnswererTest, APlannerThatIsAheadAnswersOnItsScene) {
  TestPlanner& a = add("a");
  a.follow(rooms_[6]);
  plan_request_t request = next_request();
  request.watch_lease_s = 10.0;
  ASSERT_TRUE(eventually([&] { return a.scenes.find("room")->revision == 7; }));
  const service::Answered ahead =
      front_.answerer->answer(front_.scenes.find("room"), request, base::Deadline::after_s(30.0));
  EXPECT_EQ(ahead.wire.scene_revision, 7);
  EXPECT_EQ(ahead.proved_in, nullptr) << "the front does not hold that revision";
  front_.follow(rooms_[6]);
  const service::Answered now =
      front_.answerer->answer(front_.scenes.find("room"), request, base::Deadline::after_s(30.0));
  EXPECT_EQ(now.proved_in, front_.scenes.find("room"));
}

TEST_F(RemoteAnswererTest, ABusyPlannerIsPassedOver) {
  TestPlanner& a = add("a");
  TestPlanner& b = add("b");
  TestFront other(network_, "other");
  other.follow(rooms_[3]);
  ASSERT_TRUE(other.wait_for_slots(2));
  a.held.hold();
  Asked first(other, room_request("other", 1, random_));
  ASSERT_TRUE(a.held.wait_for_calls(1));
  // The front is told that the planner is free.
  a.bus.falsify([](const std::string& subject, wire::Bytes& bytes) {
    if (subject != "camway.planner") return;
    planner_status_t status = *read_status(bytes);
    status.running = 0;
    bytes = wire::encode(status);
  });
  ASSERT_TRUE(front_.wait_for_slots(2));
  const plan_request_t request = next_request();
  expect_local(request, front_.answer(request));
  EXPECT_EQ(b.held.calls(), 1);
  EXPECT_EQ(a.held.calls(), 1);
  EXPECT_EQ(front_.counts().jobs_sent_again, 0) << "a refusal is no loss";
  a.held.release();
  first.answer();
}

TEST_F(RemoteAnswererTest, TwoFrontsShareTwoPlanners) {
  add("a");
  add("b");
  TestFront other(network_, "other");
  other.follow(rooms_[3]);
  ASSERT_TRUE(other.wait_for_slots(2));
  std::deque<std::pair<plan_request_t, Asked>> asked;
  for (int i = 0; i < 12; ++i) {
    const plan_request_t mine = next_request();
    const plan_request_t others = room_request("other", i + 1, random_);
    asked.emplace_back(std::piecewise_construct, std::tuple(mine), std::tie(front_, mine));
    asked.emplace_back(std::piecewise_construct, std::tuple(others), std::tie(other, others));
  }
  for (auto& [request, call] : asked) expect_local(request, call.answer());
  for (const TestPlanner& planner : planners_) EXPECT_EQ(planner.held.most_at_a_time(), 1);
  EXPECT_EQ(planners_[0].held.calls() + planners_[1].held.calls(), 24);
  EXPECT_EQ(front_.counts().planned_here + other.counts().planned_here, 0);
}

TEST_F(RemoteAnswererTest, ACancelIsPassedOn) {
  TestPlanner& a = add("a");
  a.held.hold();
  const plan_request_t request = next_request();
  std::stop_source stop;
  const base::Deadline deadline = base::Deadline::after_s(30.0).watched(stop.get_token(), nullptr);
  plan_response_t answer{};
  std::thread call([&] { answer = front_.answerer->answer(rooms_[3], request, deadline).wire; });
  ASSERT_TRUE(a.held.wait_for_calls(1));
  stop.request_stop();
  call.join();
  EXPECT_EQ(answer.status, plan_response_t::STATUS_CANCELLED);
  EXPECT_TRUE(eventually([&] { return a.server->running() == 0; })) << "its planner stops, too";
  EXPECT_EQ(a.server->answered(), 0);
  ASSERT_TRUE(front_.wait_for_slots(1));
}

TEST_F(RemoteAnswererTest, ThePlannerAnswersAtTheDeadline) {
  TestPlanner& a = add("a");
  a.held.hold();
  const plan_request_t request = next_request();
  const plan_response_t answer = front_.answer(request, 0.3);
  EXPECT_EQ(answer.status, plan_response_t::STATUS_TIMEOUT);
  EXPECT_EQ(answer.message.find("no planner answered"), std::string::npos) << answer.message;
  EXPECT_EQ(a.server->answered(), 1);
}

TEST_F(RemoteAnswererTest, TheFrontAnswersWhereThePlannerDoesNot) {
  TestPlanner& a = add("a");
  a.held.hold();
  a.bus.falsify([](const std::string& subject, wire::Bytes& bytes) {
    if (subject.starts_with("camway.answer.") &&
        read_answer(bytes)->kind == fleet_answer_t::ANSWER) {
      bytes.clear();
    }
  });
  const auto begin = std::chrono::steady_clock::now();
  const plan_response_t answer = front_.answer(next_request(), 0.3);
  const auto took = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(answer.status, plan_response_t::STATUS_TIMEOUT);
  EXPECT_EQ(answer.message, "no planner answered within 0.3 s, when the deadline passed");
  EXPECT_GE(took, milliseconds(1290));
  EXPECT_LT(took, milliseconds(5000));
}

TEST_F(RemoteAnswererTest, ARequestThatWaitsForASlotEndsAtItsDeadline) {
  TestPlanner& a = add("a");
  a.held.hold();
  Asked first(front_, next_request());
  ASSERT_TRUE(a.held.wait_for_calls(1));
  const plan_response_t answer = front_.answer(next_request(), 0.2);
  EXPECT_EQ(answer.status, plan_response_t::STATUS_TIMEOUT);
  EXPECT_EQ(a.held.calls(), 1);
  EXPECT_EQ(front_.counts().planned_here, 0) << "a planner lives, and will be free";
  a.held.release();
  first.answer();
}

TEST_F(RemoteAnswererTest, ProgressOfThePlannerIsProgressOfTheRequest) {
  TestPlanner& a = add("a");
  a.held.hold();
  const plan_request_t request = next_request();
  const auto progress = std::make_shared<base::Progress>();
  const base::Deadline deadline = base::Deadline::after_s(30.0).watched({}, progress);
  std::thread call([&] { front_.answerer->answer(rooms_[3], request, deadline); });
  EXPECT_TRUE(eventually([&] {
    return progress->stage == base::Progress::Stage::kCorrecting && progress->collisions == 5 &&
           progress->corrected == 2;
  }));
  std::this_thread::sleep_for(milliseconds(900));
  EXPECT_EQ(front_.counts().jobs_sent_again, 0) << "progress is a sign of life";
  a.held.release();
  call.join();
}

TEST_F(RemoteAnswererTest, LostMessagesAreSentAgainAndTheJobRunsOnce) {
  TestPlanner& a = add("a");
  std::atomic<int> lost = 0;
  a.bus.falsify([&](const std::string& subject, wire::Bytes& bytes) {
    if (!subject.starts_with("camway.answer.") || lost >= 2) return;
    ++lost;
    bytes.clear();
  });
  const plan_request_t request = next_request();
  expect_local(request, front_.answer(request));
  EXPECT_EQ(a.held.calls(), 1);
  EXPECT_EQ(front_.counts().jobs_sent_again, 1);
}

TEST_F(RemoteAnswererTest, APlannerThatHearsNoJobsIsGivenUp) {
  TestPlanner& a = add("a");
  front_.bus.falsify([](const std::string& subject, wire::Bytes& bytes) {
    if (subject == "camway.plan.a") bytes.clear();
  });
  const plan_request_t request = next_request();
  expect_local(request, front_.answer(request));
  EXPECT_EQ(a.held.calls(), 0);
  EXPECT_EQ(front_.counts().planned_here, 1);
}

TEST_F(RemoteAnswererTest, ANonsenseAnswerIsNotGiven) {
  TestPlanner& a = add("a");
  int which = 0;
  a.bus.falsify([&](const std::string& subject, wire::Bytes& bytes) {
    if (!subject.starts_with("camway.answer.")) return;
    fleet_answer_t message = *read_answer(bytes);
    if (message.kind != fleet_answer_t::ANSWER) return;
    plan_response_t answer = *read_response(message.payload);
    if (which == 0) message.payload.resize(message.payload.size() / 2);
    if (which == 1) ++answer.request_id;
    if (which == 2) answer.client_id = "another";
    if (which == 3) answer.scene = "hall";
    if (which == 4) answer.scene_digest = "of another scene";
    if (which == 5) answer.segments.at(0).t0_s = std::numeric_limits<double>::quiet_NaN();
    if (which > 0) message.payload = wire::encode(answer);
    message.num_bytes = static_cast<std::int32_t>(message.payload.size());
    bytes = wire::encode(message);
  });
  for (; which < 6; ++which) {
    SCOPED_TRACE(which);
    plan_request_t request = next_request();
    request.watch_lease_s = 1.0;
    ASSERT_TRUE(front_.wait_for_slots(1));
    expect_local(request, front_.answer(request));
    EXPECT_EQ(a.held.calls(), which + 1);
    EXPECT_EQ(front_.counts().planned_here, which + 1);
  }
}

TEST_F(RemoteAnswererTest, PlansNoMoreHereAtATimeThanItMay) {
  front_.held.hold();
  std::deque<Asked> asked;
  for (int i = 0; i < 6; ++i) asked.emplace_back(front_, next_request());
  ASSERT_TRUE(front_.held.wait_for_calls(1));
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(front_.held.calls(), 1);
  front_.held.release();
  for (Asked& call : asked) call.answer();
  EXPECT_EQ(front_.held.most_at_a_time(), 1);
  EXPECT_EQ(front_.counts().planned_here, 6);
}

TEST_F(RemoteAnswererTest, TellsAStatusOfItsPlanners) {
  add("a");
  add("b");
  status_t status{};
  front_.answerer->add_to(status, 5, true);
  EXPECT_EQ(status.role, "front");
  EXPECT_EQ(status.log_in_touch, 1);
  ASSERT_EQ(status.num_planners, 2);
  EXPECT_EQ(status.planners[0].id, "a");
  EXPECT_EQ(status.planners[0].version, "test");
  EXPECT_EQ(status.planners[0].is_behind, 1);
  for (int i = 0; i < 500; ++i) {
    planner_status_t other{};
    other.planner_id = "other-" + std::to_string(i);
    other.version = std::string(200, 'v');
    other.serial = 1;
    other.workers = 1;
    front_.board.note(other);
  }
  status = {};
  scene_info_t scene{};
  scene.name = std::string(100, 's');
  status.scenes.assign(400, scene);
  status.num_scenes = 400;
  front_.answerer->add_to(status, 5, false);
  service::fit_message(status);
  EXPECT_LE(static_cast<std::size_t>(status.getEncodedSize()), wire::kMaxMessageBytes);
  EXPECT_GT(status.num_planners, 80);
  EXPECT_GT(status.num_scenes, 80);
  EXPECT_TRUE(wire::decode<status_t>(wire::encode(status)).message);
}

}  // namespace
}  // namespace camway::fleet
