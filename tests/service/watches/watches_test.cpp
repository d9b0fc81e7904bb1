// SPDX-License-Identifier: MIT
#include "daemon/service/watches/watches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include <camway/status_t.hpp>

#include "daemon/planning/plan.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/service/service.h"
#include "tests/messages/request_on_wire.h"
#include "tests/service/fake_transport.h"
#include "tests/support/captured_log.h"
#include "tests/support/scenes.h"

namespace camway::service {
namespace {

using namespace std::chrono_literals;
using geometry::Quat;
using geometry::Vec3;
using scene::SceneChange;
using ::testing::HasSubstr;

constexpr double kLongLease_s = 100.0;

/// A daemon with real planning, in an empty scene "room".
class WatchesTest : public ::testing::Test {
 protected:
  void SetUp() override { start({}); }
  void TearDown() override { stop(); }

  void start(ServiceConfig config) {
    config.heartbeat_period = std::chrono::milliseconds(20);
    if (!scenes_.find("room")) scenes_.put(scene::assemble("room", 1, {}, {}));
    service_.emplace(
        transport_, scenes_, config,
        [this](const scene::Snapshot& snapshot, const planning::PlanRequest& request,
               const base::Deadline& deadline) {
          ++planned_;
          return planning::plan(snapshot, request, deadline);
        },
        log_.log());
    loop_ = std::thread([this] { service_->run(); });
  }

  void stop() {
    if (!loop_.joinable()) return;
    service_->request_stop();
    loop_.join();
    service_.reset();
  }

  /// Returns a request from (0, 0, 0) to (4, 0, 0).
  static plan_request_t request(std::int64_t id, double lease_s = kLongLease_s) {
    planning::PlanRequest request;
    request.scene = "room";
    request.camera = testing::small_camera();
    request.keyframes = {{0.0, {Vec3(0, 0, 0), Quat::Identity()}},
                         {4.0, {Vec3(4, 0, 0), Quat::Identity()}}};
    request.has_times = true;
    plan_request_t wire = messages::to_wire(request, {"tester", id, 0});
    wire.watch_lease_s = lease_s;
    return wire;
  }

  void send(const plan_request_t& request) {
    for (Bytes& page : wire::encode_pages(request)) {
      transport_.deliver(channels_.plan_request(), std::move(page));
    }
  }

  static watched_path_t path(std::int64_t id, std::int64_t known_serial,
                             std::int64_t wanted_offer = 0, std::int64_t taken_offer = 0) {
    watched_path_t path{};
    path.request_id = id;
    path.known_serial = known_serial;
    path.wanted_offer = wanted_offer;
    path.taken_offer = taken_offer;
    return path;
  }

  void send_watch(std::int64_t message_id, const std::vector<watched_path_t>& paths,
                  double lease_s = 0.0) {
    watch_t message{};
    message.client_id = "tester";
    message.request_id = message_id;
    message.lease_s = lease_s;
    message.paths = paths;
    message.num_paths = static_cast<std::int32_t>(paths.size());
    transport_.deliver(channels_.watch(), wire::encode(message));
  }

  /// Puts a crate of `side_m` at a place.
  void put(const Vec3& position, double side_m = 0.5) {
    scene::Mesh mesh = *scene::box_mesh(Vec3::Constant(side_m));
    const scene::ImportReport report = scene::report_of(mesh, "box");
    std::string fault;
    scenes_.change("room",
                   {SceneChange::Kind::kPut, "crate",
                    scene::make_source(scene::ObjectKind::kBox, std::move(mesh), report, {}),
                    scene::Placement::make(position, Quat::Identity(), fault)});
  }
  void take_away() { scenes_.change("room", {SceneChange::Kind::kRemove, "crate", nullptr, {}}); }

  /// Returns the first message of this type on `channel`, from number `from` on, that satisfies the
  /// condition. Sets `from` to the number after it.
  template <class Message, class Wanted>
  std::optional<Message> next(const std::string& channel, std::size_t& from, const Wanted& wanted) {
    while (const auto bytes = transport_.message_on(channel, from++)) {
      const auto decoded = wire::decode<Message>(*bytes);
      if (!decoded.message) {
        ADD_FAILURE() << decoded.fault.text("message");
        return std::nullopt;
      }
      if (wanted(*decoded.message)) return decoded.message;
    }
    ADD_FAILURE() << "the message did not come on " << channel;
    return std::nullopt;
  }

  struct State {
    path_state_t path;
    std::vector<broken_interval_t> intervals;
    std::string message;
  };
  /// Returns the next report with this state of this path.
  State wait_for(std::int64_t id, std::int8_t state) {
    State found{};
    next<watch_report_t>(channels_.watch_report("tester"), report_, [&](const auto& report) {
      for (const path_state_t& path : report.paths) {
        if (path.request_id != id || path.state != state) continue;
        found = {path, report.intervals, report.message};
        return true;
      }
      return false;
    });
    return found;
  }

  /// Returns the report that answers this message.
  watch_report_t answer_to(std::int64_t message_id) {
    std::size_t from = 0;
    return next<watch_report_t>(channels_.watch_report("tester"), from,
                                [&](const auto& report) { return report.request_id == message_id; })
        .value_or(watch_report_t{});
  }

  plan_response_t next_answer() {
    return next<plan_response_t>(channels_.plan_response("tester"), answer_,
                                 [](const auto&) { return true; })
        .value_or(plan_response_t{});
  }

  /// Watches request 1 and puts a crate in its way. Receives the first answer and the corrected
  /// one, which is watched then.
  std::pair<plan_response_t, plan_response_t> go_round() {
    send(request(1));
    const plan_response_t first = next_answer();
    EXPECT_EQ(first.status, plan_response_t::STATUS_OK) << first.message;
    put({2, 0, 0});
    const plan_response_t corrected = next_answer();
    EXPECT_EQ(corrected.status, plan_response_t::STATUS_OK) << corrected.message;
    State state = wait_for(1, path_state_t::FREE);
    while (state.path.answer_revision != corrected.scene_revision) {
      state = wait_for(1, path_state_t::FREE);
    }
    return {first, corrected};
  }

  /// Returns the next report after one of another offer with this state of this path.
  State wait_for_offer(std::int64_t id, std::int64_t revision) {
    State state = wait_for(id, path_state_t::FREE);
    while (state.path.offer_revision != revision) state = wait_for(id, path_state_t::FREE);
    return state;
  }

  plan_response_t next_offer() {
    return next<plan_response_t>(channels_.plan_offer("tester"), offer_,
                                 [](const auto&) { return true; })
        .value_or(plan_response_t{});
  }

  static void expect_same_path(const plan_response_t& a, const plan_response_t& b) {
    ASSERT_EQ(a.num_segments, b.num_segments);
    for (std::size_t i = 0; i < a.segments.size(); ++i) {
      EXPECT_EQ(wire::encode(a.segments[i]), wire::encode(b.segments[i])) << i;
    }
  }

  void wait_until_watched(std::int32_t count) {
    std::size_t from = transport_.published_on(channels_.status()).size();
    next<status_t>(channels_.status(), from,
                   [&](const status_t& status) { return status.watched_paths == count; });
  }

  testing::CapturedLog log_;
  testing::FakeTransport transport_;
  scene::SceneStore scenes_;
  const wire::Channels channels_{};
  std::atomic<int> planned_ = 0;
  std::size_t report_ = 0;
  std::size_t answer_ = 0;
  std::size_t offer_ = 0;
  std::optional<Service> service_;
  std::thread loop_;
};

TEST_F(WatchesTest, TellsWhereAChangeBreaksAPathAndSendsACorrectedOne) {
  send(request(1));
  const plan_response_t first = next_answer();
  ASSERT_EQ(first.status, plan_response_t::STATUS_OK) << first.message;
  const State begun = wait_for(1, path_state_t::FREE);
  EXPECT_EQ(begun.path.answer_revision, first.scene_revision);

  put({2, 0, 0});
  const auto changed = static_cast<std::int64_t>(scenes_.find("room")->revision);
  const State broken = wait_for(1, path_state_t::BROKEN);
  EXPECT_EQ(broken.path.scene_revision, changed);
  EXPECT_EQ(broken.path.answer_revision, first.scene_revision);
  EXPECT_NE(broken.path.serial, begun.path.serial);
  // The crate's surface on the way in and on the way out, half of the crate and of the camera from
  // its centre.
  ASSERT_EQ(broken.intervals.size(), 2U);
  EXPECT_EQ(broken.intervals[0].request_id, 1);
  EXPECT_NEAR(broken.intervals[0].t_begin_s, 1.65, 0.01);
  EXPECT_NEAR(broken.intervals[1].t_end_s, 2.35, 0.01);

  const plan_response_t corrected = next_answer();
  EXPECT_EQ(corrected.status, plan_response_t::STATUS_OK) << corrected.message;
  EXPECT_EQ(corrected.request_id, 1);
  EXPECT_EQ(corrected.scene_revision, changed);
  State mended = wait_for(1, path_state_t::FREE);
  while (mended.path.answer_revision != changed) mended = wait_for(1, path_state_t::FREE);

  send(request(2));
  const plan_response_t fresh = next_answer();
  ASSERT_EQ(fresh.request_id, 2);
  EXPECT_EQ(fresh.num_segments, corrected.num_segments);
  for (std::size_t i = 0; i < fresh.segments.size(); ++i) {
    EXPECT_EQ(wire::encode(fresh.segments[i]), wire::encode(corrected.segments[i]));
  }
  send(request(1));
  const plan_response_t repeated = next_answer();
  EXPECT_EQ(wire::encode(repeated), wire::encode(corrected)) << "the newest answer is remembered";
  EXPECT_EQ(planned_, 3);
}

TEST_F(WatchesTest, TheCorrectedPathIsWatchedInItsTurn) {
  send(request(1));
  wait_for(1, path_state_t::FREE);
  put({2, 0, 0});
  wait_for(1, path_state_t::BROKEN);
  next_answer();
  const plan_response_t corrected = next_answer();
  ASSERT_EQ(corrected.status, plan_response_t::STATUS_OK) << corrected.message;
  // Where the corrected path is at its middle now.
  const auto path = messages::path_of(corrected.segments);
  ASSERT_TRUE(path) << path.error;
  put(path->pose(2.0).position, 0.3);
  const auto changed = static_cast<std::int64_t>(scenes_.find("room")->revision);
  State broken = wait_for(1, path_state_t::BROKEN);
  while (broken.path.scene_revision != changed) broken = wait_for(1, path_state_t::BROKEN);
}

TEST_F(WatchesTest, OffersTheFirstPathAgainOnceWhatBrokeItIsGone) {
  const auto [first, corrected] = go_round();
  take_away();
  const auto mended = static_cast<std::int64_t>(scenes_.find("room")->revision);
  const State offered = wait_for_offer(1, mended);
  EXPECT_EQ(offered.path.answer_revision, corrected.scene_revision) << "it is not forced";
  const plan_response_t better = next_offer();
  EXPECT_EQ(better.request_id, 1);
  EXPECT_EQ(better.scene_revision, mended);
  EXPECT_EQ(better.scene_digest, first.scene_digest);
  expect_same_path(better, first);
  EXPECT_EQ(planned_, 3);

  send_watch(7, {path(1, 0, 0, mended)});
  const plan_response_t taken = next_answer();
  EXPECT_EQ(wire::encode(taken), wire::encode(better));
  State state = wait_for(1, path_state_t::FREE);
  while (state.path.answer_revision != mended) state = wait_for(1, path_state_t::FREE);
  EXPECT_EQ(state.path.offer_revision, 0);
  send(request(1));
  EXPECT_EQ(wire::encode(next_answer()), wire::encode(better)) << "it is the newest answer now";
  EXPECT_EQ(planned_, 3);

  put({2, 0, 0});
  const auto broken = static_cast<std::int64_t>(scenes_.find("room")->revision);
  while (wait_for(1, path_state_t::BROKEN).path.scene_revision != broken) {
  }
}

TEST_F(WatchesTest, OffersThePathAsInterpolatedOnceWhatStoodThereAtFirstIsGone) {
  put({2, 0, 0});
  send(request(1));
  const plan_response_t corrected = next_answer();
  ASSERT_EQ(corrected.status, plan_response_t::STATUS_OK) << corrected.message;
  ASSERT_GT(corrected.measures.largest_deviation_m, 0.0);
  wait_for(1, path_state_t::FREE);
  take_away();
  const auto mended = static_cast<std::int64_t>(scenes_.find("room")->revision);
  const State offered = wait_for_offer(1, mended);
  EXPECT_EQ(offered.path.answer_revision, corrected.scene_revision) << "it is not forced";
  const plan_response_t better = next_offer();
  EXPECT_EQ(better.collisions.size(), 0U);
  EXPECT_LT(better.measures.largest_deviation_m, 1e-9);
  EXPECT_EQ(planned_, 2) << "nothing was planned as long as the scene did not change";
}

TEST_F(WatchesTest, AnOfferIsWithdrawnWhenAChangeBreaksIt) {
  const auto [first, corrected] = go_round();
  take_away();
  wait_for_offer(1, static_cast<std::int64_t>(scenes_.find("room")->revision));
  put({2, 0, 0});
  EXPECT_EQ(wait_for_offer(1, 0).path.answer_revision, corrected.scene_revision)
      << "the one that was not left still holds";
  send_watch(7, {path(1, 0, 0, corrected.scene_revision + 1)});
  EXPECT_EQ(answer_to(7).paths.at(0).offer_revision, 0);
  EXPECT_EQ(planned_, 3) << "the path that is watched was free all the time";
}

TEST_F(WatchesTest, TheLostPagesOfAnOfferAreSentAgain) {
  go_round();
  take_away();
  const auto mended = static_cast<std::int64_t>(scenes_.find("room")->revision);
  wait_for_offer(1, mended);
  const plan_response_t better = next_offer();
  send_watch(7, {path(1, 0, mended)});
  EXPECT_EQ(wire::encode(next_offer()), wire::encode(better));
}

TEST_F(WatchesTest, LooksForABetterPathOnlyWhereAnObstacleWent) {
  go_round();
  put({2, 0, 0}, 0.6);  // the path before collides for longer, and the detour may
  State state = wait_for(1, path_state_t::FREE);
  const auto changed = static_cast<std::int64_t>(scenes_.find("room")->revision);
  while (state.path.scene_revision < changed) state = wait_for(1, path_state_t::FREE);
  const int planned = planned_;
  std::string fault;
  for (int i = 0; i < 5; ++i) {
    scenes_.change(
        "room",
        {SceneChange::Kind::kPut, "far",
         scene::make_source(scene::ObjectKind::kBox, *scene::box_mesh(Vec3::Constant(0.5)), {}, {}),
         scene::Placement::make(Vec3(100.0 + i, 0, 0), Quat::Identity(), fault)});
  }
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(planned_, planned);
  EXPECT_TRUE(transport_.published_on(channels_.plan_offer("tester")).empty());
}

TEST_F(WatchesTest, ToldAgainUntilTheClientKnows) {
  send(request(1));
  const State first = wait_for(1, path_state_t::FREE);
  EXPECT_EQ(wait_for(1, path_state_t::FREE).path.serial, first.path.serial);
  send_watch(7, {path(1, first.path.serial)});
  EXPECT_EQ(answer_to(7).num_paths, 0) << "it knows";
  send_watch(8, {path(1, first.path.serial - 1)});
  const watch_report_t again = answer_to(8);
  ASSERT_EQ(again.num_paths, 1);
  EXPECT_EQ(again.paths[0].serial, first.path.serial);
}

TEST_F(WatchesTest, IsToldLessAndLessOften) {
  const auto begin = std::chrono::steady_clock::now();
  send(request(1));
  for (int told = 0; told < 4; ++told) wait_for(1, path_state_t::FREE);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 200ms + 400ms + 800ms);
}

TEST_F(WatchesTest, SaysThatItDoesNotKnowAPath) {
  send_watch(7, {path(99, 5)});
  const watch_report_t report = answer_to(7);
  ASSERT_EQ(report.num_paths, 1);
  EXPECT_EQ(report.paths[0].state, path_state_t::UNKNOWN);
  EXPECT_EQ(report.paths[0].request_id, 99);
  EXPECT_EQ(report.paths[0].serial, 0);
}

TEST_F(WatchesTest, ALeaseEndsUnlessItIsRenewed) {
  send(request(1, 0.05));
  wait_for(1, path_state_t::FREE);
  wait_until_watched(0);
  send_watch(7, {path(1, 0)});
  ASSERT_EQ(answer_to(7).num_paths, 1);
  EXPECT_EQ(answer_to(7).paths[0].state, path_state_t::UNKNOWN);
  next_answer();
  // The answer is as old as its lease, so the request is planned again.
  put({2, 0, 0});
  send(request(1, 0.05));
  EXPECT_EQ(next_answer().scene_revision,
            static_cast<std::int64_t>(scenes_.find("room")->revision));
  EXPECT_EQ(planned_, 2);
}

TEST_F(WatchesTest, ARenewalLastsAsLongAsItSays) {
  // Tries longer leases until one is renewed in time on a busy machine.
  std::int64_t id = 0;
  auto lease = 250ms;
  const auto renewed_state = [&](std::int64_t message_id) {
    send_watch(message_id, {path(id, 0)}, kLongLease_s);
    const watch_report_t report = answer_to(message_id);
    return report.paths.empty() ? path_state_t::UNKNOWN : report.paths[0].state;
  };
  do {
    lease *= 2;
    send(request(++id, std::chrono::duration<double>(lease).count()));
    wait_for(id, path_state_t::FREE);
  } while (renewed_state(100 + id) == path_state_t::UNKNOWN && lease < 30s);
  std::this_thread::sleep_for(2 * lease);
  EXPECT_EQ(renewed_state(200), path_state_t::FREE);
}

TEST_F(WatchesTest, AClientEndsItsWatch) {
  send(request(1));
  wait_for(1, path_state_t::FREE);
  wait_until_watched(1);
  send_watch(7, {path(1, 0)}, -1.0);
  EXPECT_EQ(answer_to(7).num_paths, 0);
  wait_until_watched(0);
}

TEST_F(WatchesTest, LimitsAreReported) {
  stop();
  ServiceConfig config;
  config.watches.paths_of_a_client = 1;
  start(config);
  send(request(1));
  wait_for(1, path_state_t::FREE);
  send(request(2));
  const State refused = wait_for(2, path_state_t::REFUSED);
  EXPECT_THAT(refused.message, HasSubstr("watch.paths_of_a_client"));
  EXPECT_EQ(next_answer().status, plan_response_t::STATUS_OK);
  EXPECT_EQ(next_answer().status, plan_response_t::STATUS_OK) << "the answer comes all the same";
  wait_until_watched(1);
}

TEST_F(WatchesTest, ASceneThatIsUnloadedBreaksAllOfThePath) {
  send(request(1));
  wait_for(1, path_state_t::FREE);
  scenes_.remove("room");
  const State broken = wait_for(1, path_state_t::BROKEN);
  EXPECT_EQ(broken.path.scene_revision, 0);
  ASSERT_EQ(broken.intervals.size(), 1U);
  EXPECT_EQ(broken.intervals[0].t_begin_s, 0.0);
  EXPECT_EQ(broken.intervals[0].t_end_s, 4.0);
  scenes_.put(scene::assemble("room", 1, {}, {}));
  EXPECT_EQ(wait_for(1, path_state_t::FREE).path.scene_revision,
            static_cast<std::int64_t>(scenes_.find("room")->revision));
}

TEST_F(WatchesTest, AnAnswerThatProvesNothingLeavesThePathBrokenUntilThereIsWayAgain) {
  send(request(1));
  wait_for(1, path_state_t::FREE);
  EXPECT_EQ(next_answer().status, plan_response_t::STATUS_OK);
  put({4, 0, -0.1}, 0.05);  // in the last keyframe's quadrilateral
  wait_for(1, path_state_t::BROKEN);
  const plan_response_t refusal = next_answer();
  EXPECT_EQ(refusal.status, plan_response_t::STATUS_INVALID) << refusal.message;
  State broken = wait_for(1, path_state_t::BROKEN);
  while (broken.path.answer_revision != refusal.scene_revision) {
    broken = wait_for(1, path_state_t::BROKEN);
  }
  take_away();
  EXPECT_EQ(wait_for(1, path_state_t::FREE).path.scene_revision,
            static_cast<std::int64_t>(scenes_.find("room")->revision));
}

TEST_F(WatchesTest, AMessageThatCannotBeReadHarmsNobody) {
  send(request(1));
  wait_for(1, path_state_t::FREE);
  transport_.deliver(channels_.watch(), Bytes(40, 7));
  watch_t message{};
  message.client_id = "no such id!";
  transport_.deliver(channels_.watch(), wire::encode(message));
  message.client_id = "tester";
  message.lease_s = std::nan("");
  transport_.deliver(channels_.watch(), wire::encode(message));
  send_watch(7, {path(1, 0)});
  EXPECT_EQ(answer_to(7).num_paths, 1);
}

}  // namespace
}  // namespace camway::service
