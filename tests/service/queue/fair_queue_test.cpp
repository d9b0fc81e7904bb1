// SPDX-License-Identifier: MIT
#include "daemon/service/queue/fair_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <string>

#include "tests/support/random.h"

namespace camway::service {
namespace {

using std::chrono::milliseconds;
using Clock = FairQueue::Clock;

constexpr std::uint64_t kQueueSeed = 20060619;

Job job_of(const std::string& client, Priority priority = Priority::kNormal,
           Clock::time_point expires = Clock::time_point::max()) {
  return {[] {}, [](Refusal) {}, client, {}, priority, expires};
}

FairQueue::Limits wide() { return {.jobs = 100'000, .jobs_of_a_client = 100'000}; }

/// The behaviour of a client: always `waiting` jobs in the queue, each of which takes `cost`.
struct Habit {
  int waiting;
  milliseconds cost;
  Priority priority = Priority::kNormal;
};

/// Simulates `workers` workers for `length`. Returns the time that each client's jobs got.
std::map<std::string, milliseconds> served(const std::map<std::string, Habit>& habits, int workers,
                                           milliseconds length) {
  FairQueue queue(wide());
  std::map<std::string, milliseconds> got;
  std::multimap<milliseconds, FairQueue::Begun> running;  // by when they end
  for (const auto& [client, habit] : habits) {
    for (int i = 0; i < habit.waiting; ++i) (void)queue.push(job_of(client, habit.priority));
  }
  milliseconds now{0};
  while (now < length) {
    while (static_cast<int>(running.size()) < workers && !queue.empty()) {
      FairQueue::Begun begun = queue.pop();
      running.emplace(now + habits.at(begun.job.client).cost, std::move(begun));
    }
    const auto next = running.begin();
    now = next->first;
    const std::string client = next->second.job.client;
    queue.finish(next->second, habits.at(client).cost);
    running.erase(next);
    got[client] += habits.at(client).cost;
    (void)queue.push(job_of(client, habits.at(client).priority));
  }
  return got;
}

TEST(FairQueue, AClientsOwnJobsGoByPriorityThenFirstComeFirstServed) {
  FairQueue queue(wide());
  std::vector<int> order;
  const auto push = [&](int number, Priority priority) {
    Job job = job_of("a", priority);
    job.run = [&order, number] { order.push_back(number); };
    EXPECT_FALSE(queue.push(std::move(job)));
  };
  push(1, Priority::kLow);
  push(2, Priority::kNormal);
  push(3, Priority::kNormal);
  push(4, Priority::kHigh);
  push(5, Priority::kHigh);
  while (!queue.empty()) {
    const FairQueue::Begun begun = queue.pop();
    begun.job.run();
    queue.finish(begun, milliseconds(1));
  }
  EXPECT_EQ(order, (std::vector<int>{4, 5, 2, 3, 1}));
}

TEST(FairQueue, ClientsWithEqualJobsTakeTurns) {
  FairQueue queue(wide());
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(queue.push(job_of("flood")));
  for (int i = 0; i < 5; ++i) ASSERT_FALSE(queue.push(job_of("modest")));
  int flood_before_modest = 0;
  for (int modest = 0; modest < 5;) {
    const FairQueue::Begun begun = queue.pop();
    queue.finish(begun, milliseconds(2));
    if (begun.job.client == "modest") {
      ++modest;
    } else {
      ++flood_before_modest;
    }
  }
  EXPECT_LE(flood_before_modest, 5);
}

// Clients share the time, not the number of jobs: a client whose jobs take a hundred times as long
// gets no more time, however many of them wait.
TEST(FairQueue, ClientsGetTheSameTimeWhateverTheirJobsTake) {
  for (const int workers : {1, 2, 5}) {
    const auto got = served({{"flood", {500, milliseconds(10)}},
                             {"long", {20, milliseconds(1000)}},
                             {"modest", {5, milliseconds(10)}}},
                            workers, milliseconds(300'000));
    // A client cannot use more workers than it has jobs; here each can use all.
    const double fair = 300'000.0 * workers / 3.0;
    for (const auto& [client, time] : got) {
      EXPECT_NEAR(static_cast<double>(time.count()) / fair, 1.0, 0.05)
          << client << " with " << workers << " workers";
    }
  }
}

// The client returns only when its last job is done, so it never waits beside its own job.
TEST(FairQueue, AClientThatAsksOneByOneDoesNotGetRidOfWhatItUsed) {
  const auto got = served({{"long", {1, milliseconds(1000)}}, {"short", {10, milliseconds(10)}}}, 1,
                          milliseconds(300'000));
  EXPECT_NEAR(static_cast<double>(got.at("long").count()) / 150'000.0, 1.0, 0.05);
}

TEST(FairQueue, PriorityScalesTheShareOfAClient) {
  const auto got = served({{"high", {10, milliseconds(10), Priority::kHigh}},
                           {"normal", {10, milliseconds(10)}},
                           {"low", {10, milliseconds(10), Priority::kLow}}},
                          1, milliseconds(210'000));
  EXPECT_NEAR(static_cast<double>(got.at("high").count()), 160'000.0, 4000.0);
  EXPECT_NEAR(static_cast<double>(got.at("normal").count()), 40'000.0, 4000.0);
  EXPECT_NEAR(static_cast<double>(got.at("low").count()), 10'000.0, 4000.0);
}

TEST(FairQueue, ABreakEarnsNothing) {
  FairQueue queue(wide());
  for (int i = 0; i < 1000; ++i) {
    ASSERT_FALSE(queue.push(job_of("busy")));
    ASSERT_FALSE(queue.push(job_of("busy")));
    queue.finish(queue.pop(), milliseconds(100));
  }
  // The other client had no jobs in those 100 seconds; from now on they alternate.
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(queue.push(job_of("late")));
  int late = 0;
  for (int i = 0; i < 20; ++i) {
    const FairQueue::Begun begun = queue.pop();
    late += begun.job.client == "late" ? 1 : 0;
    queue.finish(begun, milliseconds(100));
  }
  EXPECT_NEAR(late, 10, 1);
}

TEST(FairQueue, RefusesWhatAClientHasTooManyOf) {
  FairQueue queue({.jobs = 10, .jobs_of_a_client = 2});
  ASSERT_FALSE(queue.push(job_of("a", Priority::kLow)));
  ASSERT_FALSE(queue.push(job_of("a")));
  const auto refused = queue.push(job_of("a", Priority::kLow));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->why, Refusal::kClientFull);
  const auto displaced = queue.push(job_of("a", Priority::kHigh));
  ASSERT_TRUE(displaced);
  EXPECT_EQ(displaced->job.priority, Priority::kLow) << "the low one made way";
  EXPECT_FALSE(queue.push(job_of("b"))) << "another client has room";
  EXPECT_EQ(queue.size(), 3U);
}

TEST(FairQueue, AFullQueueMakesRoomAtTheCostOfWhoHasMost) {
  FairQueue queue({.jobs = 4});
  for (int i = 0; i < 4; ++i) ASSERT_FALSE(queue.push(job_of("flood")));
  for (int i = 0; i < 2; ++i) {
    const auto displaced = queue.push(job_of("modest"));
    ASSERT_TRUE(displaced);
    EXPECT_EQ(displaced->job.client, "flood");
    EXPECT_EQ(displaced->why, Refusal::kQueueFull);
  }
  const auto refused = queue.push(job_of("modest"));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->job.client, "modest") << "both have two now";
  EXPECT_EQ(queue.size(), 4U);
}

TEST(FairQueue, GivesUpWhatExpiredAndNothingElse) {
  FairQueue queue(wide());
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < 10; ++i) {
    ASSERT_FALSE(queue.push(job_of(std::string(1, static_cast<char>('a' + i % 3)),
                                   Priority::kNormal, start + milliseconds(i))));
  }
  EXPECT_EQ(queue.next_expiry(), start);
  EXPECT_EQ(queue.take_expired(start + milliseconds(3)).size(), 4U);
  EXPECT_EQ(queue.next_expiry(), start + milliseconds(4));
  EXPECT_EQ(queue.size(), 6U);
  for (int i = 0; i < 6; ++i) queue.finish(queue.pop(), milliseconds(1));
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.next_expiry(), Clock::time_point::max());
}

TEST(FairQueue, AJobThatWaitsCanBeTakenOut) {
  FairQueue queue(wide());
  for (std::int64_t id = 1; id <= 3; ++id) {
    Job job = job_of("a");
    job.id = id;
    ASSERT_FALSE(queue.push(job));
    job.client = "b";
    ASSERT_FALSE(queue.push(job));
  }
  const std::optional<Job> taken = queue.take("a", 2);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->client, "a");
  EXPECT_FALSE(queue.take("a", 2));
  EXPECT_FALSE(queue.take("c", 2));
  EXPECT_EQ(queue.size(), 5U);
  while (!queue.empty()) {
    const FairQueue::Begun begun = queue.pop();
    EXPECT_FALSE(begun.job.client == "a" && begun.job.id == 2);
    queue.finish(begun, milliseconds(1));
  }
}

TEST(FairQueue, KnowsHowManyAreAheadIfNoMoreCome) {
  testing::Random random(kQueueSeed);
  for (int trial = 0; trial < 100; ++trial) {
    FairQueue queue(wide());
    std::vector<std::pair<std::string, std::int64_t>> jobs;
    for (std::int64_t id = 0; id < 30; ++id) {
      Job job = job_of(std::string(1, static_cast<char>('a' + random() % 4)));
      job.id = id;
      jobs.emplace_back(job.client, id);
      ASSERT_FALSE(queue.push(std::move(job)));
    }
    std::map<std::int64_t, std::size_t> expected;
    for (const auto& [client, id] : jobs) expected[id] = queue.ahead_of(client, id).value();
    for (std::size_t begun_before = 0; !queue.empty(); ++begun_before) {
      const FairQueue::Begun begun = queue.pop();
      ASSERT_EQ(expected.at(*begun.job.id), begun_before) << "trial " << trial;
      EXPECT_FALSE(queue.ahead_of(begun.job.client, *begun.job.id));
      queue.finish(begun, milliseconds(1));
    }
  }
}

/// A client that returns with a job whenever its last one is done. Between two jobs so many ids are
/// invented that the queue is always full. Holds the client's part of the time, and how often it is
/// refused after its first job.
struct Siege {
  double share = 0.0;
  int refused = 0;
};
Siege besieged(const FairQueue::Limits& limits, int jobs) {
  FairQueue queue(limits);
  Siege siege;
  int invented = 0;
  int of_client = 0;
  int all = 0;
  bool waits = false;
  const auto ask = [&] {
    const auto refused = queue.push(job_of("client"));
    waits = !refused || refused->job.client != "client";
    siege.refused += waits ? 0 : 1;
  };
  ask();
  queue.finish(queue.pop(), milliseconds(5));
  waits = false;
  // Far more than the smallest expected part, so that the simulation ends even if the client is
  // never served.
  const int most = 100 * jobs;
  while (of_client < jobs && all < most) {
    for (int i = 0; i < 50; ++i) {
      (void)queue.push(job_of("invented" + std::to_string(invented++)));
    }
    if (!waits) ask();
    const FairQueue::Begun begun = queue.pop();
    queue.finish(begun, milliseconds(5));
    ++all;
    if (begun.job.client != "client") continue;
    ++of_client;
    waits = false;
  }
  siege.share = static_cast<double>(of_client) / all;
  return siege;
}

TEST(FairQueue, InventedIdsTogetherGetThePartOfAFewClients) {
  for (const std::size_t clients : {1U, 4U, 8U}) {
    const Siege siege = besieged({.jobs = 100, .newcomers_count_as = clients}, 500);
    EXPECT_GE(siege.share, 0.95 / (1.0 + static_cast<double>(clients)));
    EXPECT_EQ(siege.refused, 0) << "who was served before finds room";
  }
}

TEST(FairQueue, NewcomersMayHaveAllThatNobodyElseWants) {
  FairQueue queue({.jobs = 10});
  for (int i = 0; i < 10; ++i) ASSERT_FALSE(queue.push(job_of("new" + std::to_string(i))));
  const auto refused = queue.push(job_of("another"));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->job.client, "another");
  EXPECT_EQ(refused->why, Refusal::kQueueFull);
  while (!queue.empty()) queue.finish(queue.pop(), milliseconds(1));
}

TEST(FairQueue, AFullQueueMakesRoomForWhoIsKnownUpToHalfOfIt) {
  FairQueue queue({.jobs = 10});
  for (const char* const client : {"a", "b", "c", "d", "e", "f"}) {
    ASSERT_FALSE(queue.push(job_of(client)));
    queue.finish(queue.pop(), milliseconds(1));
  }
  for (int i = 0; i < 10; ++i) ASSERT_FALSE(queue.push(job_of("new" + std::to_string(i))));
  for (const char* const client : {"a", "b", "c", "d", "e"}) {
    const auto displaced = queue.push(job_of(client));
    ASSERT_TRUE(displaced);
    EXPECT_EQ(displaced->job.client.substr(0, 3), "new");
    EXPECT_EQ(displaced->why, Refusal::kQueueFull);
  }
  const auto refused = queue.push(job_of("f"));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->job.client, "f");
}

TEST(FairQueue, OfAStrandOneJobRunsAtATimeAndOthersGoBefore) {
  FairQueue queue(wide());
  const auto push = [&](const std::string& client, const std::string& strand, std::int64_t id) {
    Job job = job_of(client);
    job.strand = strand;
    job.id = id;
    ASSERT_FALSE(queue.push(std::move(job)));
  };
  push("a", "hall", 1);
  push("a", "hall", 2);
  push("a", "room", 3);
  push("b", "hall", 4);
  const FairQueue::Begun hall = queue.pop();
  EXPECT_EQ(hall.job.id, 1);
  const FairQueue::Begun room = queue.pop();
  EXPECT_EQ(room.job.id, 3) << "2 and 4 wait for 1";
  EXPECT_FALSE(queue.can_begin());
  EXPECT_EQ(queue.size(), 2U);
  queue.finish(room, milliseconds(1));
  EXPECT_FALSE(queue.can_begin());
  queue.finish(hall, milliseconds(1));
  const FairQueue::Begun other = queue.pop();
  EXPECT_EQ(other.job.id, 4) << "clients take turns within a strand, too";
  EXPECT_FALSE(queue.can_begin());
  queue.finish(other, milliseconds(1));
  EXPECT_EQ(queue.pop().job.id, 2);
}

TEST(FairQueue, AClientHasNoMoreWorkersThanItsPart) {
  FairQueue queue({.running_of_a_client = 2});
  for (int i = 0; i < 10; ++i) ASSERT_FALSE(queue.push(job_of("flood")));
  const FairQueue::Begun first = queue.pop();
  (void)queue.pop();
  EXPECT_FALSE(queue.can_begin());
  ASSERT_FALSE(queue.push(job_of("modest")));
  EXPECT_EQ(queue.pop().job.client, "modest");
  queue.finish(first, milliseconds(1));
  EXPECT_EQ(queue.pop().job.client, "flood");
}

/// Compares with a simple model: one job of each strand at a time, each client's in order, of each
/// client at most its quota; and a worker is idle only if no job may begin.
TEST(FairQueue, StrandsKeepTheirOrderWhateverHappens) {
  testing::Random random(kQueueSeed);
  FairQueue queue({.jobs = 60, .jobs_of_a_client = 60, .running_of_a_client = 2});
  std::map<std::pair<std::string, std::string>, std::deque<std::int64_t>> waiting;
  std::deque<FairQueue::Begun> running;
  const auto runs = [&](const auto& matches) {
    return std::ranges::count_if(running, [&](const auto& begun) { return matches(begun.job); });
  };
  const auto may_begin = [&](const std::string& client, const std::string& strand) {
    return runs([&](const Job& job) { return job.client == client; }) < 2 &&
           (strand.empty() || runs([&](const Job& job) { return job.strand == strand; }) == 0);
  };
  for (std::int64_t step = 0; step < 20'000; ++step) {
    const auto action = random() % 4;
    if (action < 2 && queue.size() < 60) {
      Job job = job_of("client" + std::to_string(random() % 4));
      if (const auto strand = random() % 5; strand > 0) job.strand = std::to_string(strand);
      job.id = step;
      waiting[{job.client, job.strand}].push_back(step);
      ASSERT_FALSE(queue.push(std::move(job)));
    } else if (action == 2 && queue.can_begin()) {
      FairQueue::Begun begun = queue.pop();
      ASSERT_TRUE(may_begin(begun.job.client, begun.job.strand));
      auto& line = waiting[{begun.job.client, begun.job.strand}];
      ASSERT_EQ(line.front(), begun.job.id);
      line.pop_front();
      running.push_back(std::move(begun));
    } else if (action == 3 && !running.empty()) {
      const auto which = static_cast<std::ptrdiff_t>(random() % running.size());
      queue.finish(running[static_cast<std::size_t>(which)], milliseconds(random() % 50));
      running.erase(running.begin() + which);
    }
    const bool any = std::ranges::any_of(waiting, [&](const auto& line) {
      return !line.second.empty() && may_begin(line.first.first, line.first.second);
    });
    ASSERT_EQ(queue.can_begin(), any) << "step " << step;
  }
}

// Checks invariants: no job is lost or doubled.
TEST(FairQueue, EveryJobLeavesOnceWhateverHappens) {
  testing::Random random(kQueueSeed);
  FairQueue queue({.jobs = 20, .jobs_of_a_client = 6});
  std::deque<FairQueue::Begun> running;
  std::size_t in = 0;
  std::size_t out = 0;
  const Clock::time_point start = Clock::now();
  for (int step = 0; step < 50'000; ++step) {
    const Clock::time_point now = start + milliseconds(step);
    const auto action = random() % 8;
    if (action < 4) {
      const auto priority = static_cast<Priority>(static_cast<int>(random() % 3) - 1);
      ++in;
      if (queue.push(job_of("client" + std::to_string(random() % 9), priority,
                            now + milliseconds(random() % 100)))) {
        ++out;
      }
    } else if (action < 6 && !queue.empty()) {
      running.push_back(queue.pop());
    } else if (action < 7 && !running.empty()) {
      queue.finish(running.front(), milliseconds(random() % 50));
      running.pop_front();
      ++out;
    } else {
      for (const Job& job : queue.take_expired(now)) {
        ASSERT_LE(job.expires, now);
        ++out;
      }
    }
    ASSERT_LE(queue.size(), 20U);
    ASSERT_EQ(in, out + queue.size() + running.size());
  }
  EXPECT_EQ(queue.take_all().size() + out + running.size(), in);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace camway::service
