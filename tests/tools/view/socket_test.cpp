// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/tools/view/door_client.h"
#include "tests/tools/view/fake_backend.h"
#include "tools/view/door.h"

namespace camway::view {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

Answer ok_answer(const std::string& text) { return {code::kOk, text, {}}; }
Answer cancelled_answer() { return failure(code::kCancelled, "cancelled"); }

class ViewSocket : public ::testing::Test {
 protected:
  /// Opens a door with these limits.
  void open(const DoorLimits& limits = {}, bool is_read_only = false) {
    auto opened =
        Door::open({.token = kSecret, .is_read_only = is_read_only, .limits = limits}, backend_);
    if (!opened) throw std::runtime_error(opened.error);
    door_ = *std::move(opened);
  }

  FakeBackend backend_;
  std::unique_ptr<Door> door_;
};

TEST_F(ViewSocket, APlanIsAnsweredUnderItsId) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(plan_message(7));
  socket.send(plan_message(8));
  FakeBackend::Asked first = backend_.take();
  FakeBackend::Asked second = backend_.take();
  EXPECT_EQ(first.order.scene, "office");
  EXPECT_EQ(first.order.request.keyframes.size(), 2U);
  EXPECT_EQ(first.progress, nullptr);
  second.done(ok_answer(R"({"status": "second"})"));
  first.done(ok_answer(R"({"status": "first"})"));
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 8, "answer": {"status": "second"}})"));
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 7, "answer": {"status": "first"}})"));
}

TEST_F(ViewSocket, ProgressComesBeforeTheAnswerAndNotAfterIt) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(plan_message(7, R"(, "progress": true)"));
  FakeBackend::Asked asked = backend_.take();
  asked.progress(R"({"stage": "detecting"})");
  asked.done(ok_answer("{}"));
  asked.progress(R"({"stage": "too late"})");
  socket.send(R"({"id": 8, "do": "version"})");
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 7, "progress": {"stage": "detecting"}})"));
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 7, "answer": {}})"));
  EXPECT_EQ(socket.next().at("id"), 8);
}

TEST_F(ViewSocket, OfADragTheLatestWins) {
  open();
  SocketClient socket(door_->port(), kSecret);
  const std::string drag = R"(, "drag": "a")";
  socket.send(plan_message(1, drag));
  FakeBackend::Asked first = backend_.take();
  for (int id = 2; id <= 5; ++id) socket.send(plan_message(id, drag));
  // Those that waited are dropped; the one under way is cancelled.
  for (int id = 2; id <= 4; ++id) {
    EXPECT_EQ(socket.next(), json({{"id", id}, {"superseded", true}}));
  }
  backend_.wait_until_cancelled(first);
  EXPECT_EQ(backend_.plans(), 1) << "one is under way at a time";
  first.done(cancelled_answer());
  EXPECT_EQ(socket.next(), json({{"id", 1}, {"superseded", true}}));
  FakeBackend::Asked last = backend_.take();
  EXPECT_FALSE(*last.is_cancelled);
  last.done(ok_answer("{}"));
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 5, "answer": {}})"));
  EXPECT_EQ(backend_.plans(), 2);
}

TEST_F(ViewSocket, AnOlderOneOfADragIsSupersededEvenIfItEnded) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(plan_message(1, R"(, "drag": "a", "progress": true)"));
  FakeBackend::Asked first = backend_.take();
  socket.send(plan_message(2, R"(, "drag": "a")"));
  backend_.wait_until_cancelled(first);
  first.progress(R"({"stage": "nobody waits for it"})");
  first.done(ok_answer("{}"));
  EXPECT_EQ(socket.next(), json({{"id", 1}, {"superseded", true}}));
  backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 2, "answer": {}})"));
}

TEST_F(ViewSocket, OneThatMayFinishIsAnsweredBeforeTheLatest) {
  open();
  SocketClient socket(door_->port(), kSecret);
  const std::string drag = R"(, "drag": "a", "finish": true)";
  socket.send(plan_message(1, drag));
  FakeBackend::Asked first = backend_.take();
  socket.send(plan_message(2, drag));
  socket.send(plan_message(3, drag));
  EXPECT_EQ(socket.next(), json({{"id", 2}, {"superseded", true}}));
  EXPECT_FALSE(*first.is_cancelled);
  EXPECT_EQ(backend_.plans(), 1);
  first.done(ok_answer("{}"));
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 1, "answer": {}})"));
  backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 3, "answer": {}})"));
}

TEST_F(ViewSocket, DragsOfOtherNamesAndOtherSocketsGoOn) {
  open();
  SocketClient one(door_->port(), kSecret);
  SocketClient other(door_->port(), kSecret);
  one.send(plan_message(1, R"(, "drag": "a")"));
  FakeBackend::Asked first = backend_.take();
  one.send(plan_message(2, R"(, "drag": "b")"));
  FakeBackend::Asked second = backend_.take();
  other.send(plan_message(1, R"(, "drag": "a")"));
  FakeBackend::Asked third = backend_.take();
  EXPECT_FALSE(*first.is_cancelled);
  first.done(ok_answer("{}"));
  second.done(ok_answer("{}"));
  third.done(ok_answer("{}"));
  EXPECT_EQ(one.next(1).count("answer"), 1U);
  EXPECT_EQ(one.next(2).count("answer"), 1U);
  EXPECT_EQ(other.next(1).count("answer"), 1U);
}

TEST_F(ViewSocket, CancelEndsAPlanAndAnsweredOnesAreLeftAlone) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(plan_message(1));
  FakeBackend::Asked asked = backend_.take();
  socket.send(R"({"id": 1, "do": "cancel"})");
  backend_.wait_until_cancelled(asked);
  asked.done(cancelled_answer());
  EXPECT_EQ(socket.next(), json({{"id", 1}, {"cancelled", true}}));
  socket.send(R"({"id": 1, "do": "cancel"})");
  socket.send(R"({"id": 2, "do": "version"})");
  EXPECT_EQ(socket.next().at("id"), 2);
}

TEST_F(ViewSocket, CancelEndsAPlanThatWaitsForItsDrag) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(plan_message(1, R"(, "drag": "a")"));
  FakeBackend::Asked first = backend_.take();
  socket.send(plan_message(2, R"(, "drag": "a")"));
  socket.send(R"({"id": 2, "do": "cancel"})");
  EXPECT_EQ(socket.next(), json({{"id", 2}, {"cancelled", true}}));
  first.done(cancelled_answer());
  EXPECT_EQ(socket.next(), json({{"id", 1}, {"superseded", true}}));
  socket.send(plan_message(3, R"(, "drag": "a")"));
  backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(socket.next().at("id"), 3);
  EXPECT_EQ(backend_.plans(), 2);
}

TEST_F(ViewSocket, PlansOfASocketThatEndsAreCancelled) {
  open();
  auto socket = std::make_unique<SocketClient>(door_->port(), kSecret);
  socket->send(plan_message(1));
  FakeBackend::Asked asked = backend_.take();
  socket->send(plan_message(2, R"(, "drag": "a")"));
  FakeBackend::Asked dragged = backend_.take();
  socket->send(plan_message(3, R"(, "drag": "a")"));
  backend_.wait_until_cancelled(dragged);
  socket.reset();
  backend_.wait_until_cancelled(asked);
  asked.done(cancelled_answer());
  dragged.done(cancelled_answer());
  EXPECT_EQ(backend_.plans(), 2) << "what waited is not begun for nobody";
}

TEST_F(ViewSocket, TheDoorClosesWhilePlansAreUnderWay) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(plan_message(1, R"(, "drag": "a")"));
  FakeBackend::Asked asked = backend_.take();
  socket.send(plan_message(2, R"(, "drag": "a")"));
  backend_.wait_until_cancelled(asked);
  door_.reset();
  EXPECT_EQ(socket.next().count("closed"), 1U);
  asked.done(cancelled_answer());
  EXPECT_EQ(backend_.plans(), 1);
}

TEST_F(ViewSocket, LimitsPlansOfASocket) {
  open({.plans = 2});
  SocketClient socket(door_->port(), kSecret);
  SocketClient other(door_->port(), kSecret);
  for (int id = 1; id <= 3; ++id) socket.send(plan_message(id));
  const json refused = socket.next();
  EXPECT_EQ(refused.at("id"), 3);
  EXPECT_EQ(refused.at("code"), 429);
  EXPECT_THAT(refused.at("error"), HasSubstr("at most 2 plans"));
  other.send(plan_message(1));
  for (int i = 0; i < 3; ++i) backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(other.next().count("answer"), 1U);
  socket.next(1);
  socket.next(2);
  socket.send(plan_message(4));
  backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(socket.next().at("id"), 4) << "a place is free again";
}

TEST_F(ViewSocket, LimitsPlansOfAllSockets) {
  open({.plans = 2, .all_plans = 3});
  SocketClient one(door_->port(), kSecret);
  SocketClient other(door_->port(), kSecret);
  // One is under way and one waits; a newer one takes the place of the one that waits.
  for (int id = 1; id <= 3; ++id) one.send(plan_message(id, R"(, "drag": "a")"));
  EXPECT_EQ(one.next(), json({{"id", 2}, {"superseded", true}}));
  other.send(plan_message(1));
  other.send(plan_message(2));
  const json refused = other.next();
  EXPECT_EQ(refused.at("id"), 2);
  EXPECT_EQ(refused.at("code"), 429);
  EXPECT_THAT(refused.at("error"), HasSubstr("at most 3 plans of all clients"));
  for (int i = 0; i < 3; ++i) backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(one.next(3).count("answer"), 1U);
  EXPECT_EQ(other.next(1).count("answer"), 1U);
  other.send(plan_message(2));
  backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(other.next(2).count("answer"), 1U) << "a place is free again";
}

TEST_F(ViewSocket, AnIdIsTakenUntilItIsAnswered) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(plan_message(1));
  FakeBackend::Asked asked = backend_.take();
  socket.send(plan_message(1));
  EXPECT_EQ(socket.next().at("code"), 400);
  asked.done(ok_answer("{}"));
  EXPECT_EQ(socket.next().count("answer"), 1U);
  socket.send(plan_message(1));
  backend_.take().done(ok_answer("{}"));
  EXPECT_EQ(socket.next().count("answer"), 1U);
}

TEST_F(ViewSocket, SaysWhatIsWrongWithAMessage) {
  open();
  SocketClient socket(door_->port(), kSecret);
  const auto error_of = [&](const std::string& message) {
    socket.send(message);
    const json answer = socket.next();
    EXPECT_EQ(answer.at("code"), 400);
    return answer.at("id").dump() + " " + answer.at("error").get<std::string>();
  };
  EXPECT_THAT(error_of("{"), HasSubstr("null message: line 1, column"));
  EXPECT_EQ(error_of("[]"), "null the message must be an object");
  EXPECT_EQ(error_of(R"({"do": "version"})"), "null id: is missing");
  EXPECT_THAT(error_of(R"({"id": -1, "do": "version"})"), HasSubstr("null id: "));
  EXPECT_THAT(error_of(R"({"id": 5, "do": "fly"})"), HasSubstr("5 do: "));
  EXPECT_EQ(error_of(R"({"id": 5, "do": "plan"})"), "5 request: is missing");
  EXPECT_THAT(error_of(R"({"id": 5, "do": "plan", "request": {"keyframes": 7}})"),
              HasSubstr("5 request: "));
  EXPECT_THAT(error_of(R"({"id": 5, "do": "version", "more": 1})"), HasSubstr("5 more: "));
  EXPECT_THAT(error_of(plan_message(5, R"(, "drag": "<b>")")), HasSubstr("5 drag: must be of"));
  socket.send(R"({"id": 6, "do": "version"})");
  EXPECT_EQ(socket.next().count("answer"), 1U);
}

TEST_F(ViewSocket, LooksAtScenesAndChangesThem) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "scene.list"})");
  socket.send(R"({"id": 2, "do": "scene.describe", "scene": "maze"})");
  socket.send(R"({"id": 3, "do": "scene.add", "object": "crate",
                  "form": {"type": "sphere", "radius_m": 0.5}, "position": [1, 2, 3]})");
  socket.send(R"({"id": 4, "do": "scene.move", "object": "crate", "orientation": [0, 0, 0, 2]})");
  socket.send(R"({"id": 5, "do": "scene.remove", "object": "crate"})");
  for (int id = 1; id <= 5; ++id) EXPECT_EQ(socket.next().count("answer"), 1U) << id;
  const auto orders = backend_.orders();
  ASSERT_EQ(orders.size(), 5U);
  EXPECT_EQ(orders[1].scene, "maze");
  EXPECT_EQ(orders[2].kind, SceneOrder::Kind::kAdd);
  EXPECT_EQ(orders[2].scene, "office");
  EXPECT_EQ(orders[2].object, "crate");
  EXPECT_EQ(std::get<SphereForm>(orders[2].form).radius_m, 0.5);
  EXPECT_EQ(orders[2].position_m->z(), 3.0);
  EXPECT_FALSE(orders[3].position_m);
  EXPECT_TRUE(orders[3].orientation);
  EXPECT_EQ(orders[4].kind, SceneOrder::Kind::kRemove);
}

TEST_F(ViewSocket, AReadOnlyDoorChangesNothing) {
  open({}, /*is_read_only=*/true);
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "scene.list"})");
  EXPECT_EQ(socket.next().count("answer"), 1U);
  socket.send(R"({"id": 2, "do": "scene.remove", "object": "crate"})");
  EXPECT_EQ(socket.next().at("code"), 403);
  // The rule comes first: whether the change could be read does not count.
  for (const char* const what : {"scene.add", "scene.move", "scene.remove"}) {
    socket.send(fmt::format(R"({{"id": 3, "do": "{}", "object": 7}})", what));
    EXPECT_EQ(socket.next().at("code"), 403) << what;
  }
  socket.send(R"({"id": 3, "do": "scene.describe", "scene": 7})");
  EXPECT_EQ(socket.next().at("code"), 400);
  EXPECT_EQ(backend_.orders().size(), 1U);
}

TEST_F(ViewSocket, ChangesComeOnlySoOften) {
  open({.changes_per_s = 1e-6, .change_burst = 2.0});
  SocketClient socket(door_->port(), kSecret);
  SocketClient other(door_->port(), kSecret);
  for (int id = 1; id <= 2; ++id) {
    socket.send(R"({"id": 1, "do": "scene.remove", "object": "crate"})");
    EXPECT_EQ(socket.next().count("answer"), 1U);
  }
  other.send(R"({"id": 1, "do": "scene.remove", "object": "crate"})");
  EXPECT_EQ(other.next().at("code"), 429);
  other.send(R"({"id": 1, "do": "scene.list"})");
  EXPECT_EQ(other.next().count("answer"), 1U) << "looking is no change";
}

TEST_F(ViewSocket, WatchesScenesUntilItSaysNotTo) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(R"({"id": 1, "do": "watch"})");
  EXPECT_EQ(socket.next(), json::parse(R"({"id": 1, "event": {"kind": "scenes"}})"));
  socket.send(R"({"id": 2, "do": "unwatch"})");
  EXPECT_EQ(socket.next().at("code"), 404);
  socket.send(R"({"id": 1, "do": "unwatch"})");
  EXPECT_EQ(socket.next(), json({{"id", 1}, {"ended", true}}));
}

TEST_F(ViewSocket, SaysWherePathsAreWatched) {
  open();
  SocketClient socket(door_->port(), kSecret);
  socket.send(std::string(R"({"id": 1, "do": "watch", "request": )") + kSmallRequest + "}");
  const json answer = socket.next();
  EXPECT_EQ(answer.at("code"), 501);
  EXPECT_THAT(answer.at("error"), HasSubstr("daemon"));
}

TEST_F(ViewSocket, EndsForMessagesThatAreTooLong) {
  open({.message_bytes = 1000});
  SocketClient socket(door_->port(), kSecret);
  socket.send(std::string(1001, ' '));
  EXPECT_EQ(socket.next().at("closed"), 1009);
}

TEST_F(ViewSocket, ASlowReaderIsClosedAndStallsNobody) {
  constexpr std::size_t kQueued = 100'000;
  open({.queued_bytes = kQueued});
  SocketClient slow(door_->port(), kSecret);
  SocketClient other(door_->port(), kSecret);
  slow.send(plan_message(1, R"(, "progress": true)"));
  FakeBackend::Asked asked = backend_.take();
  // More than the kernel takes and the door keeps.
  const std::string much = "\"" + std::string(10'000, 'x') + "\"";
  for (int i = 0; i < 3000; ++i) asked.progress(much);
  other.send(R"({"id": 1, "do": "version"})");
  EXPECT_EQ(other.next().count("answer"), 1U);
  int received = 0;
  for (;;) {
    const json message = slow.next();
    if (message.contains("closed")) break;
    ++received;
  }
  EXPECT_LT(received, 3000);
  backend_.wait_until_cancelled(asked);
}

}  // namespace
}  // namespace camway::view
