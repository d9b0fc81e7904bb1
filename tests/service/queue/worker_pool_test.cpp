// SPDX-License-Identifier: MIT
#include "daemon/service/queue/worker_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <semaphore>
#include <thread>
#include <utility>

namespace camway::service {
namespace {

/// A job that keeps a worker busy until it is opened.
class Gate {
 public:
  Job job() {
    Job job;
    job.run = [this] {
      entered_.count_down();
      opened_.wait();
    };
    return job;
  }
  void wait_until_entered() const { entered_.wait(); }
  void open() { opened_.count_down(); }

 private:
  std::latch entered_{1};
  std::latch opened_{1};
};

Job job_of(std::function<void()> run) {
  Job job;
  job.run = std::move(run);
  return job;
}

TEST(WorkerPool, TellsHowLongTheLongestJobRuns) {
  Gate first;
  Gate second;
  const auto begin = Job::Clock::now();
  WorkerPool pool(2, {.jobs = 2, .jobs_of_a_client = 2});
  EXPECT_EQ(pool.longest_run(Job::Clock::now()), Job::Clock::duration::zero());
  ASSERT_FALSE(pool.submit(first.job()));
  first.wait_until_entered();
  const auto between = Job::Clock::now();
  ASSERT_FALSE(pool.submit(second.job()));
  second.wait_until_entered();
  const auto later = Job::Clock::now() + std::chrono::hours(1);
  EXPECT_GE(pool.longest_run(later), later - between);
  EXPECT_LE(pool.longest_run(later), later - begin);
  first.open();
  second.open();
}

TEST(WorkerPool, RunsEveryJobItTook) {
  std::atomic<int> done = 0;
  std::latch all(100);
  WorkerPool pool(3, {.jobs = 100, .jobs_of_a_client = 100});
  for (int i = 0; i < 100; ++i) {
    ASSERT_FALSE(pool.submit(job_of([&] {
      ++done;
      all.count_down();
    })));
  }
  all.wait();
  EXPECT_EQ(done, 100);
}

TEST(WorkerPool, RunsAsManyAtATimeAsAreAllowed) {
  std::atomic<int> running = 0;
  std::atomic<int> most = 0;
  std::counting_semaphore<64> go(0);
  std::latch all(12);
  WorkerPool pool(4, {.jobs = 100, .jobs_of_a_client = 100});
  EXPECT_EQ(pool.allowed(), 4) << "all threads at first";
  pool.allow(0);
  EXPECT_EQ(pool.allowed(), 1);
  pool.allow(5);
  EXPECT_EQ(pool.allowed(), 4);
  const auto until = [&](int count) {
    const auto patience = Job::Clock::now() + std::chrono::seconds(30);
    while (running != count && Job::Clock::now() < patience) std::this_thread::yield();
    // Time for one too many to begin.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return running.load();
  };
  pool.allow(2);
  for (int i = 0; i < 12; ++i) {
    ASSERT_FALSE(pool.submit(job_of([&] {
      most = std::max(most.load(), ++running);
      go.acquire();
      --running;
      all.count_down();
    })));
  }
  EXPECT_EQ(until(2), 2);
  pool.allow(3);
  EXPECT_EQ(until(3), 3) << "a change takes effect at once";
  pool.allow(1);
  EXPECT_EQ(until(3), 3) << "what runs goes on";
  go.release(2);
  EXPECT_EQ(until(1), 1) << "and none begins before there is room";
  EXPECT_EQ(most, 3);
  pool.allow(4);
  EXPECT_EQ(until(4), 4);
  go.release(12);
  all.wait();
}

TEST(WorkerPool, NoWorkerSleepsWhenTheEndOfAJobLetsTwoBegin) {
  // The first job blocks another of its strand and another of its client.
  for (int round = 0; round < 20; ++round) {
    Gate first;
    std::latch both(2);
    std::latch all(2);
    std::atomic<int> met = 0;
    WorkerPool pool(2, {.running_of_a_client = 1});
    const auto submit = [&](Job job, const std::string& client, const std::string& strand) {
      job.client = client;
      job.strand = strand;
      ASSERT_FALSE(pool.submit(std::move(job)));
    };
    submit(first.job(), "a", "hall");
    first.wait_until_entered();
    const auto meet = [&] {
      both.count_down();
      const auto patience = Job::Clock::now() + std::chrono::seconds(30);
      while (!both.try_wait() && Job::Clock::now() < patience) std::this_thread::yield();
      met += both.try_wait() ? 1 : 0;
      all.count_down();
    };
    submit(job_of(meet), "a", "room");
    submit(job_of(meet), "b", "hall");
    first.open();
    all.wait();
    ASSERT_EQ(met, 2) << "or they did not run at the same time";
  }
}

TEST(WorkerPool, HandsBackWhatDoesNotFitTheQueue) {
  Gate gate;
  WorkerPool pool(1, {.jobs = 2});
  ASSERT_FALSE(pool.submit(gate.job()));
  gate.wait_until_entered();
  EXPECT_EQ(pool.running(), 1U);
  EXPECT_FALSE(pool.submit(job_of([] {})));
  EXPECT_FALSE(pool.submit(job_of([] {})));
  const std::optional<FairQueue::Refused> refused = pool.submit(job_of([] {}));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->why, Refusal::kQueueFull);
  EXPECT_EQ(pool.queued(), 2U);
  gate.open();
}

TEST(WorkerPool, HandsBackWhatExpiredAndDoesNotRunIt) {
  Gate gate;
  WorkerPool pool(1, {});
  ASSERT_FALSE(pool.submit(gate.job()));
  gate.wait_until_entered();
  EXPECT_EQ(pool.next_expiry(), Job::Clock::time_point::max());
  std::atomic<int> run = 0;
  Job job = job_of([&] { ++run; });
  job.expires = Job::Clock::now();
  ASSERT_FALSE(pool.submit(job));
  EXPECT_EQ(pool.next_expiry(), job.expires);
  EXPECT_TRUE(pool.take_expired(job.expires - std::chrono::nanoseconds(1)).empty());
  EXPECT_EQ(pool.take_expired(job.expires).size(), 1U);
  EXPECT_EQ(pool.queued(), 0U);
  gate.open();
  pool.stop();
  EXPECT_EQ(run, 0);
}

TEST(WorkerPool, CloseHandsBackWhatNobodyBegan) {
  Gate gate;
  WorkerPool pool(1, {});
  ASSERT_FALSE(pool.submit(gate.job()));
  gate.wait_until_entered();
  std::atomic<int> run = 0;
  for (int i = 0; i < 3; ++i) ASSERT_FALSE(pool.submit(job_of([&] { ++run; })));
  EXPECT_EQ(pool.close().size(), 3U);
  const std::optional<FairQueue::Refused> refused = pool.submit(job_of([&] { ++run; }));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->why, Refusal::kStopping);
  EXPECT_EQ(pool.running(), 1U) << "what runs goes on";
  gate.open();
  pool.stop();
  EXPECT_EQ(run, 0);
}

}  // namespace
}  // namespace camway::service
