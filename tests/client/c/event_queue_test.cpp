// SPDX-License-Identifier: MIT
#include "client/c/event_queue.h"

#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "client/c/handles.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::answer_pages;
using testing_support::CClient;
using testing_support::CRequest;
using testing_support::encode_all;
using testing_support::FakeDaemon;

constexpr double kLong_s = 20.0;

/// A queue that is freed at the end, and checks that no handle is left then.
class CEventQueueTest : public testing_support::ClientTest {
 protected:
  void SetUp() override {
    ClientTest::SetUp();
    handles_before_ = camway_num_handles();
    ASSERT_EQ(camway_event_queue_create(&queue_), CAMWAY_OK);
  }
  void TearDown() override {
    EXPECT_EQ(camway_event_queue_free(queue_), CAMWAY_OK);
    EXPECT_EQ(camway_num_handles(), handles_before_) << "a handle is left";
  }
  camway_status next(double timeout_s) {
    return camway_event_queue_next(queue_, timeout_s, &event_, sizeof event_);
  }

  camway_event_queue* queue_ = nullptr;
  camway_watch_event event_{};

 private:
  std::int64_t handles_before_ = 0;
};

/// An answer without a proof, after which the client ends the watch.
std::vector<testing_support::Bytes> unproved(const plan_request_t& asked) {
  std::vector<plan_response_t> pages = answer_pages(asked, 0, 1);
  pages[0].status = plan_response_t::STATUS_INVALID;
  pages[0].message = "keyframe 0 collides";
  return encode_all(pages);
}

WatchEvent event_of(std::int64_t watch, std::int64_t revision) {
  WatchEvent event;
  event.request_id = watch;
  event.scene_revision = revision;
  return event;
}

TEST_F(CEventQueueTest, EventsComeInTheirOrderAndStayUntilTheNextCall) {
  FakeDaemon daemon;
  daemon.on_plan = unproved;
  daemon.start();
  CClient client;
  const CRequest request;
  std::int64_t watch = 0;
  ASSERT_EQ(camway_watch_start_polled(client.get(), &request, queue_, &watch), CAMWAY_OK);
  ASSERT_EQ(next(kLong_s), CAMWAY_OK) << camway_last_error();
  EXPECT_EQ(event_.kind, CAMWAY_EVENT_ANSWER);
  EXPECT_EQ(event_.watch, watch);
  EXPECT_EQ(event_.struct_size, sizeof event_);
  EXPECT_EQ(event_.num_missed, 0);
  EXPECT_THAT(camway_answer_message(event_.answer), HasSubstr("keyframe 0 collides"));
  camway_answer* kept = nullptr;
  ASSERT_EQ(camway_answer_copy(event_.answer, &kept), CAMWAY_OK);
  const camway_answer* const before = event_.answer;

  ASSERT_EQ(next(kLong_s), CAMWAY_OK) << camway_last_error();
  EXPECT_EQ(event_.kind, CAMWAY_EVENT_ENDED);
  EXPECT_EQ(event_.status, CAMWAY_INVALID);
  EXPECT_THAT(event_.error, HasSubstr("keyframe 0 collides"));
  EXPECT_EQ(camway_answer_message(before), nullptr) << "the answer of the event before is freed";
  EXPECT_THAT(camway_answer_message(kept), HasSubstr("keyframe 0 collides"));
  EXPECT_EQ(camway_answer_free(kept), CAMWAY_OK);
  EXPECT_EQ(next(0.0), CAMWAY_NOT_READY);
  EXPECT_EQ(next(0.01), CAMWAY_NOT_READY);
  EXPECT_THAT(camway_last_error(), HasSubstr("no event came"));
}

TEST_F(CEventQueueTest, ARequestThatCannotBeSentHasNoEvent) {
  CClient client;
  CRequest request;
  const std::string too_long(1000, 's');
  request.scene = too_long.c_str();
  std::int64_t watch = 7;
  EXPECT_EQ(camway_watch_start_polled(client.get(), &request, queue_, &watch), CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("scene"));
  EXPECT_EQ(watch, 0);
  EXPECT_EQ(next(0.0), CAMWAY_NOT_READY);
}

TEST_F(CEventQueueTest, WatchesMayOutliveTheirQueue) {
  FakeDaemon daemon;
  std::atomic<bool> was_asked = false;
  daemon.on_plan = [&](const plan_request_t& asked) {
    was_asked = true;
    return unproved(asked);
  };
  CClient client;
  const CRequest request;
  std::int64_t watch = 0;
  camway_event_queue* other = nullptr;
  ASSERT_EQ(camway_event_queue_create(&other), CAMWAY_OK);
  ASSERT_EQ(camway_watch_start_polled(client.get(), &request, other, &watch), CAMWAY_OK);
  EXPECT_EQ(camway_event_queue_free(other), CAMWAY_OK);
  daemon.start();
  while (!was_asked) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  // The first answer for this one comes after the one for the other.
  ASSERT_EQ(camway_watch_start_polled(client.get(), &request, queue_, &watch), CAMWAY_OK);
  ASSERT_EQ(next(kLong_s), CAMWAY_OK);
  EXPECT_EQ(event_.watch, watch);
  EXPECT_EQ(camway_event_queue_next(other, 0.0, &event_, sizeof event_), CAMWAY_BAD_ARGUMENT);
}

/// The statuses that a handler gets: of a look for an event, and of a wait for one.
struct Looks {
  camway_event_queue* queue;
  camway_status at_once = CAMWAY_OK;
  camway_status waiting = CAMWAY_OK;
};

void look(void* user, const camway_answer*) {
  auto& looks = *static_cast<Looks*>(user);
  camway_watch_event event;
  looks.at_once = camway_event_queue_next(looks.queue, 0.0, &event, sizeof event);
  looks.waiting = camway_event_queue_next(looks.queue, kLong_s, &event, sizeof event);
}

TEST_F(CEventQueueTest, AHandlerMayLookButNotWait) {
  FakeDaemon daemon;
  daemon.on_plan = unproved;
  daemon.start();
  CClient client;
  const CRequest request;
  Looks looks{queue_};
  camway_plan_handlers handlers;
  camway_plan_handlers_init(&handlers, sizeof handlers);
  handlers.user = &looks;
  handlers.on_answer = look;
  camway_pending* pending = nullptr;
  ASSERT_EQ(camway_plan_start(client.get(), &request, &handlers, &pending), CAMWAY_OK);
  EXPECT_EQ(camway_pending_wait(pending, kLong_s, nullptr), CAMWAY_INVALID);
  client.free();  // waits for the handler
  EXPECT_EQ(looks.at_once, CAMWAY_NOT_READY);
  EXPECT_EQ(looks.waiting, CAMWAY_BUSY);
  camway_pending_free(pending);
}

TEST_F(CEventQueueTest, OlderProgramsGetTheMembersThatTheyKnow) {
  constexpr std::size_t kFirst = 56;
  camway_watch_event event{};
  event.num_missed = -1;
  c::Handles::all().find(queue_)->put(event_of(5, 1));
  EXPECT_EQ(camway_event_queue_next(queue_, 0.0, &event, kFirst - 1), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_event_queue_next(queue_, 0.0, &event, kFirst), CAMWAY_OK);
  EXPECT_EQ(event.watch, 5);
  EXPECT_EQ(event.struct_size, kFirst);
  EXPECT_EQ(event.num_missed, -1) << "it is behind the struct of that program";
  EXPECT_EQ(camway_event_queue_next(queue_, 0.0, nullptr, sizeof event), CAMWAY_BAD_ARGUMENT);
}

TEST(CEventQueue, KeepsTheNewestEventsAndCountsTheOthers) {
  // Watches 1 to 3 have more and more events, of which the scene's revision is the number.
  constexpr auto kKept = static_cast<std::int64_t>(c::EventQueue::kMostOfAWatch);
  const std::array<std::int64_t, 3> counts = {1, kKept, kKept + 3};
  c::EventQueue queue;
  for (int round = 0; round < 2; ++round) {
    for (std::int64_t i = 1; i <= kKept + 3; ++i) {
      for (std::int64_t watch = 1; watch <= 3; ++watch) {
        if (i <= counts[std::size_t(watch - 1)]) queue.put(event_of(watch, i));
      }
    }
    std::array<std::int64_t, 3> last = {0, 0, 3};
    std::size_t taken = 0;
    while (const auto event = queue.next(0.0)) {
      std::int64_t& before = last.at(std::size_t(event->watch - 1));
      EXPECT_EQ(event->num_missed, event->watch == 3 && before == 3 ? 3 : 0);
      EXPECT_EQ(event->scene_revision, ++before);
      ++taken;
    }
    EXPECT_EQ(last, counts);
    EXPECT_EQ(taken, std::size_t(1 + 2 * kKept));
  }
}

TEST(CEventQueue, AWaitEndsWithTheEvent) {
  c::EventQueue queue;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    queue.put(event_of(9, 1));
  });
  const auto event = queue.next(std::numeric_limits<double>::infinity());
  later.join();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->watch, 9);
}

}  // namespace
}  // namespace camway
