// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <future>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <camway/plan_progress_t.hpp>

#include "lcmtypes/wire/channels.h"
#include "tests/client/c/answered_twice.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"
#include "tests/support/random.h"

namespace camway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing_support::answer_pages;
using testing_support::AnsweredTwice;
using testing_support::Bytes;
using testing_support::CClient;
using testing_support::CRequest;
using testing_support::encode_all;
using testing_support::FakeDaemon;
using testing_support::quick;
using testing_support::small_request;

class CPlanTest : public testing_support::ClientTest {
 protected:
  void SetUp() override {
    ClientTest::SetUp();
    handles_before_ = camway_num_handles();
  }
  void TearDown() override {
    EXPECT_EQ(camway_num_handles(), handles_before_) << "a handle is left";
  }

 private:
  std::int64_t handles_before_ = 0;
};

/// Answers of segments with random numbers.
std::vector<Bytes> random_answer(const plan_request_t& request) {
  testing::Random random(7);
  std::vector<plan_response_t> pages = answer_pages(request, 5, 5);
  for (segment_t& segment : pages[0].segments) {
    for (auto& point : segment.position_m) {
      for (double& coordinate : point) coordinate = random.uniform(-100.0, 100.0);
    }
    for (auto& point : segment.orientation_wxyz) {
      for (double& part : point) part = random.uniform(-1.0, 1.0);
    }
  }
  return encode_all(pages);
}

bool same_bits(const double* left, const double* right, std::size_t count) {
  return std::memcmp(left, right, count * sizeof(double)) == 0;
}

TEST_F(CPlanTest, EvaluatesAsTheClientOfCxxBitForBit) {
  FakeDaemon daemon;
  daemon.on_plan = random_answer;
  daemon.start();
  Client cxx(quick());
  const PlanResponse expected = cxx.plan(small_request());
  ASSERT_TRUE(expected.ok()) << expected.error;
  CClient client;
  const CRequest request;
  camway_answer* answer = nullptr;
  ASSERT_EQ(camway_plan(client.get(), &request, 10.0, &answer), CAMWAY_OK) << camway_last_error();
  std::vector<double> times_s = {-1e300, 0.0, 1.0, 5.0, 1e300, std::nan("")};
  for (int i = 0; i < 500; ++i) times_s.push_back(-0.1 + 5.2 * i / 499.0);
  std::vector<double> positions_m(3 * times_s.size());
  std::vector<double> orientations_wxyz(4 * times_s.size());
  ASSERT_EQ(camway_answer_poses(answer, times_s.data(), times_s.size(), positions_m.data(),
                                orientations_wxyz.data()),
            CAMWAY_OK);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const Pose pose = expected.path.pose(times_s[i]);
    EXPECT_TRUE(same_bits(&positions_m[3 * i], pose.position_m.data(), 3)) << times_s[i];
    EXPECT_TRUE(same_bits(&orientations_wxyz[4 * i], pose.orientation_wxyz.data(), 4))
        << times_s[i];
  }
  std::vector<camway_segment> segments(7);
  std::size_t count = 0;
  ASSERT_EQ(camway_answer_segments(answer, segments.data(), 2, &count), CAMWAY_OK);
  EXPECT_EQ(count, 5u);
  EXPECT_EQ(segments[2].t1_s, 0.0) << "beyond the capacity";
  ASSERT_EQ(camway_answer_segments(answer, segments.data(), 7, &count), CAMWAY_OK);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(std::memcmp(&segments[i], &expected.path.segments()[i], sizeof(camway_segment)), 0);
  }
  camway_answer_free(answer);
}

TEST_F(CPlanTest, GivesAnAnswerWithoutAPathAndSaysWhy) {
  FakeDaemon daemon;
  daemon.on_plan = [](const plan_request_t& asked) {
    std::vector<plan_response_t> pages = answer_pages(asked, 0, 1);
    pages[0].status = plan_response_t::STATUS_UNKNOWN_SCENE;
    pages[0].message = "there is no such scene";
    return encode_all(pages);
  };
  daemon.start();
  CClient client;
  const CRequest request;
  camway_answer* answer = nullptr;
  EXPECT_EQ(camway_plan(client.get(), &request, 0.0, &answer), CAMWAY_UNKNOWN_SCENE);
  EXPECT_THAT(camway_last_error(), HasSubstr("there is no such scene"));
  EXPECT_THAT(camway_answer_error(answer), HasSubstr("there is no such scene"));
  const double time_s = 0.0;
  double position_m[3];
  EXPECT_EQ(camway_answer_poses(answer, &time_s, 1, position_m, nullptr), CAMWAY_INVALID);
  camway_answer_summary summary;
  ASSERT_EQ(camway_answer_summarize(answer, &summary, sizeof summary), CAMWAY_OK);
  EXPECT_EQ(summary.status, CAMWAY_UNKNOWN_SCENE);
  EXPECT_EQ(summary.keyframe, -1);
  EXPECT_EQ(summary.scene_revision, 3);
  EXPECT_EQ(camway_answer_free(answer), CAMWAY_OK);
  EXPECT_EQ(camway_answer_free(answer), CAMWAY_BAD_ARGUMENT);
}

TEST_F(CPlanTest, TellsTheBoundsWithTheirOpenSides) {
  const AnsweredTwice answer([](plan_response_t& bounded) {
    for (int i = 0; i < 3; ++i) {
      bounded.bounds.min_m[i] = -1.0 - i;
      bounded.bounds.max_m[i] = 1.0 + i;
    }
    bounded.bounds.has_min[0] = bounded.bounds.has_min[1] = bounded.bounds.has_max[2] = 1;
  });
  constexpr double kInfinity_m = std::numeric_limits<double>::infinity();
  double min_m[3];
  double max_m[3];
  ASSERT_EQ(camway_answer_bounds(answer.in_c(), min_m, max_m), CAMWAY_OK);
  EXPECT_THAT(min_m, ElementsAre(-1.0, -2.0, -kInfinity_m));
  EXPECT_THAT(max_m, ElementsAre(kInfinity_m, kInfinity_m, 3.0));
  EXPECT_EQ(camway_answer_bounds(answer.in_c(), nullptr, max_m), CAMWAY_BAD_ARGUMENT);
  EXPECT_EQ(camway_answer_bounds(answer.in_c(), min_m, nullptr), CAMWAY_BAD_ARGUMENT);
}

/// Handlers that keep their arguments.
struct Taken {
  std::atomic<int> progress = 0;
  std::atomic<int> answers = 0;
  std::promise<camway_answer*> copy;
  camway_client* client = nullptr;
  camway_status waited = CAMWAY_OK;

  camway_plan_handlers handlers() {
    camway_plan_handlers handlers;
    camway_plan_handlers_init(&handlers, sizeof handlers);
    handlers.user = this;
    handlers.on_progress = [](void* user, const camway_progress* progress) {
      EXPECT_GE(progress->struct_size, sizeof(camway_progress));
      ++static_cast<Taken*>(user)->progress;
    };
    handlers.on_answer = [](void* user, const camway_answer* answer) {
      auto* const taken = static_cast<Taken*>(user);
      if (++taken->answers > 1) return;
      const CRequest request;
      camway_answer* none = nullptr;
      if (taken->client != nullptr)
        taken->waited = camway_plan(taken->client, &request, 1.0, &none);
      camway_answer* copy = nullptr;
      EXPECT_EQ(camway_answer_copy(answer, &copy), CAMWAY_OK);
      taken->copy.set_value(copy);
    };
    return handlers;
  }
};

TEST_F(CPlanTest, HandlersGetProgressAndTheAnswerOnce) {
  FakeDaemon daemon;
  daemon.on_plan = [&](const plan_request_t& request) {
    plan_progress_t progress{};
    progress.client_id = request.client_id;
    progress.request_id = request.request_id;
    progress.stage = plan_progress_t::CORRECTING;
    progress.num_collisions = 3;
    daemon.publish(wire::Channels().plan_progress(request.client_id), wire::encode(progress));
    // The report and the answer are of different channels, whose order LCM keeps.
    return encode_all(answer_pages(request, 2, 2));
  };
  daemon.start();
  CClient client;
  const CRequest request;
  Taken taken;
  taken.client = client.get();
  const camway_plan_handlers handlers = taken.handlers();
  camway_pending* pending = nullptr;
  ASSERT_EQ(camway_plan_start(client.get(), &request, &handlers, &pending), CAMWAY_OK);
  camway_answer* waited = nullptr;
  ASSERT_EQ(camway_pending_wait(pending, 10.0, &waited), CAMWAY_OK) << camway_last_error();
  EXPECT_EQ(taken.answers, 1) << "the handler runs before the answer can be had";
  EXPECT_GE(taken.progress, 1);
  EXPECT_EQ(taken.waited, CAMWAY_BUSY) << "a handler waited for its own client";
  camway_progress progress;
  ASSERT_EQ(camway_pending_progress(pending, &progress, sizeof progress), CAMWAY_OK);
  EXPECT_EQ(progress.stage, CAMWAY_CORRECTING);
  EXPECT_EQ(progress.num_collisions, 3);
  EXPECT_EQ(progress.is_known, 1);
  EXPECT_EQ(camway_pending_free(pending), CAMWAY_OK);
  EXPECT_EQ(camway_pending_free(pending), CAMWAY_BAD_ARGUMENT);
  // Both are answers of their own, though all else is freed.
  camway_answer* const copy = taken.copy.get_future().get();
  client.free();
  daemon.stop();
  EXPECT_EQ(daemon.plan_requests().size(), 1u) << "the call that was refused was sent";
  EXPECT_STREQ(camway_answer_message(copy), camway_answer_message(waited));
  camway_answer_free(waited);
  EXPECT_STREQ(camway_answer_message(copy), "all is well");
  camway_answer_free(copy);
}

TEST_F(CPlanTest, PollingDoesNotWaitAndACancelEndsTheCall) {
  FakeDaemon daemon;
  daemon.heartbeat_every = std::chrono::milliseconds(20);
  daemon.on_cancel = [](const cancel_t& cancel) {
    plan_request_t asked{};
    asked.client_id = cancel.client_id;
    asked.request_id = cancel.request_id;
    std::vector<plan_response_t> pages = answer_pages(asked, 0, 1);
    pages[0].status = plan_response_t::STATUS_CANCELLED;
    return encode_all(pages);
  };
  daemon.start();
  CClient client;
  const CRequest request;
  camway_pending* pending = nullptr;
  ASSERT_EQ(camway_plan_start(client.get(), &request, nullptr, &pending), CAMWAY_OK);
  EXPECT_EQ(camway_pending_wait(pending, 0.0, nullptr), CAMWAY_NOT_READY);
  EXPECT_EQ(camway_pending_wait(pending, 0.05, nullptr), CAMWAY_NOT_READY);
  EXPECT_EQ(camway_pending_wait(pending, std::nan(""), nullptr), CAMWAY_NOT_READY);
  camway_progress progress;
  ASSERT_EQ(camway_pending_progress(pending, &progress, sizeof progress), CAMWAY_OK);
  EXPECT_EQ(progress.is_known, 0);
  EXPECT_EQ(camway_pending_cancel(pending), CAMWAY_OK);
  EXPECT_EQ(camway_pending_wait(pending, std::numeric_limits<double>::infinity(), nullptr),
            CAMWAY_CANCELLED);
  EXPECT_EQ(camway_pending_cancel(pending), CAMWAY_OK) << "it has ended, so this has no effect";
  camway_pending_free(pending);
}

TEST_F(CPlanTest, ACallEndsWhenTheCallerWaitsNoLonger) {
  std::promise<std::int64_t> cancelled;
  std::atomic<bool> is_first = true;
  FakeDaemon daemon;
  daemon.heartbeat_every = std::chrono::milliseconds(20);
  daemon.on_cancel = [&](const cancel_t& cancel) {
    if (is_first.exchange(false)) cancelled.set_value(cancel.request_id);
    return std::vector<Bytes>{};
  };
  daemon.start();
  CClient client;
  const CRequest request;
  camway_answer* answer = nullptr;
  EXPECT_EQ(camway_plan(client.get(), &request, 0.2, &answer), CAMWAY_NOT_READY);
  EXPECT_EQ(answer, nullptr);
  EXPECT_NE(cancelled.get_future().get(), 0) << "the daemon goes on";
}

TEST_F(CPlanTest, FreeingTheClientAnswersWhatIsPending) {
  CClient client;
  const CRequest request;
  Taken taken;
  const camway_plan_handlers handlers = taken.handlers();
  camway_pending* pending = nullptr;
  ASSERT_EQ(camway_plan_start(client.get(), &request, &handlers, &pending), CAMWAY_OK);
  client.free();
  EXPECT_EQ(taken.answers, 1) << "a handler runs after the client was freed";
  EXPECT_EQ(camway_pending_wait(pending, 0.0, nullptr), CAMWAY_NO_ANSWER);
  EXPECT_EQ(camway_pending_cancel(pending), CAMWAY_OK);
  camway_pending_free(pending);
  camway_answer_free(taken.copy.get_future().get());
}

TEST_F(CPlanTest, AHandlerMayFreeTheClient) {
  FakeDaemon daemon;
  daemon.on_plan = random_answer;
  daemon.start();
  struct Ending {
    camway_client* client;
    std::promise<camway_status> freed;
  } ending;
  CClient client;
  ending.client = client.get();
  camway_plan_handlers handlers;
  camway_plan_handlers_init(&handlers, sizeof handlers);
  handlers.user = &ending;
  handlers.on_answer = [](void* user, const camway_answer*) {
    auto* const own = static_cast<Ending*>(user);
    own->freed.set_value(camway_client_free(own->client));
  };
  const CRequest request;
  camway_pending* pending = nullptr;
  ASSERT_EQ(camway_plan_start(client.get(), &request, &handlers, &pending), CAMWAY_OK);
  EXPECT_EQ(ending.freed.get_future().get(), CAMWAY_OK);
  EXPECT_EQ(camway_pending_wait(pending, 10.0, nullptr), CAMWAY_OK);
  camway_pending_free(pending);
}

TEST_F(CPlanTest, ManyThreadsShareAClientAndItsAnswers) {
  FakeDaemon daemon;
  daemon.on_plan = random_answer;
  daemon.start();
  CClient client;
  const CRequest request;
  camway_answer* shared = nullptr;
  ASSERT_EQ(camway_plan(client.get(), &request, 10.0, &shared), CAMWAY_OK);
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 6; ++i) {
    threads.emplace_back([&] {
      for (int k = 0; k < 10; ++k) {
        camway_answer* answer = nullptr;
        camway_answer* copy = nullptr;
        if (camway_plan(client.get(), &request, 10.0, &answer) != CAMWAY_OK) ++wrong;
        if (camway_answer_copy(shared, &copy) != CAMWAY_OK) ++wrong;
        const double times_s[2] = {0.25, 4.5};
        double mine_m[6];
        double theirs_m[6];
        if (camway_answer_poses(answer, times_s, 2, mine_m, nullptr) != CAMWAY_OK) ++wrong;
        if (camway_answer_poses(copy, times_s, 2, theirs_m, nullptr) != CAMWAY_OK) ++wrong;
        if (!same_bits(mine_m, theirs_m, 6)) ++wrong;
        // Errors are of the thread that made them.
        if (camway_answer_free(answer) != CAMWAY_OK || camway_answer_free(copy) != CAMWAY_OK)
          ++wrong;
        if (camway_answer_free(copy) != CAMWAY_BAD_ARGUMENT) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  camway_answer_free(shared);
}

}  // namespace
}  // namespace camway
