// SPDX-License-Identifier: MIT
#include "daemon/service/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>

namespace camway::service {
namespace {

/// Keeps a worker busy until it is opened.
class Gate {
 public:
  WorkerPool::Job job() {
    return {[this] {
              entered_.count_down();
              opened_.wait();
            },
            [] {}};
  }
  void wait_until_entered() const { entered_.wait(); }
  void open() { opened_.count_down(); }

 private:
  std::latch entered_{1};
  std::latch opened_{1};
};

TEST(WorkerPool, RunsEveryJobItTook) {
  std::atomic<int> done = 0;
  std::latch all(100);
  WorkerPool pool(3, 100);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(pool.try_submit({[&] {
                                   ++done;
                                   all.count_down();
                                 },
                                 [] {}}));
  }
  all.wait();
  EXPECT_EQ(done, 100);
}

TEST(WorkerPool, RefusesWhatDoesNotFitTheQueue) {
  Gate gate;
  WorkerPool pool(1, 2);
  ASSERT_TRUE(pool.try_submit(gate.job()));
  gate.wait_until_entered();
  EXPECT_EQ(pool.running(), 1U);
  std::atomic<int> done = 0;
  const WorkerPool::Job job{[&] { ++done; }, [] {}};
  EXPECT_TRUE(pool.try_submit(job));
  EXPECT_TRUE(pool.try_submit(job));
  EXPECT_FALSE(pool.try_submit(job));
  EXPECT_EQ(pool.queued(), 2U);
  gate.open();
}

TEST(WorkerPool, CloseHandsBackWhatNobodyBegan) {
  Gate gate;
  WorkerPool pool(1, 5);
  ASSERT_TRUE(pool.try_submit(gate.job()));
  gate.wait_until_entered();
  int run = 0;
  int abandoned = 0;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(pool.try_submit({[&] { ++run; }, [&] { ++abandoned; }}));
  }
  EXPECT_FALSE(pool.closed());
  const std::vector<WorkerPool::Job> left = pool.close();
  EXPECT_TRUE(pool.closed());
  ASSERT_EQ(left.size(), 3U);
  for (const WorkerPool::Job& job : left) job.abandon();
  EXPECT_EQ(abandoned, 3);
  EXPECT_EQ(run, 0);
  EXPECT_FALSE(pool.try_submit({[&] { ++run; }, [] {}}));
  EXPECT_EQ(pool.running(), 1U) << "what runs goes on";
  gate.open();
}

}  // namespace
}  // namespace camway::service
