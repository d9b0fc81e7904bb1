// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "daemon/nats/stream.h"
#include "tests/integration/process.h"
#include "tests/scene/log/nats/fleet_log.h"
#include "tests/support/nats_server.h"

namespace camway::scene {
namespace {

using integration::eventually;
using std::chrono::milliseconds;
using testing::NatsServer;

TEST(NatsFollow, BringsTheChangesOfOthersAndTheOwnOnes) {
  const NatsServer server;
  FleetLog one({server.url()});
  FleetLog two({server.url()});
  one.follow();
  two.follow();
  EXPECT_EQ(one.append("office", "a").error, "");
  ASSERT_TRUE(eventually([&] { return two.revision("office") == 1; }));
  EXPECT_EQ(two.append("office", "b").error, "");
  const std::string large(300'000, 'x');
  EXPECT_EQ(two.append("hall", large).error, "");
  ASSERT_TRUE(eventually([&] { return one.revision("hall") == 1; }));
  const std::vector<std::string> all{"office 1: a", "office 2: b", "hall 1: " + large};
  EXPECT_EQ(one.seen(), all);
  EXPECT_EQ(two.seen(), all);
  EXPECT_EQ(two->remove("office", 2).error, "");
  EXPECT_EQ(two->summarize("hall", 1, log_bytes("s"), {}).error, "");
  ASSERT_TRUE(eventually([&] { return one.has_seen("office removed"); }));
  EXPECT_EQ(one.append("office", "c").error, "");
  EXPECT_EQ(one->highest_removed(), 2U);
  EXPECT_EQ(one.faults() + two.faults(), "");
}

TEST(NatsFollow, CatchesUpWithWhatOthersHaveAppended) {
  NatsServer server;
  FleetLog one({server.url()});
  FleetLog two({server.url()});
  EXPECT_FALSE(two->catch_up(milliseconds(100))) << "it does not follow";
  two.follow();
  for (std::uint64_t i = 1; i <= 50; ++i) {
    ASSERT_EQ(one->append("office", sample_entry(i - 1, i, "a")).error, "");
    ASSERT_TRUE(two->catch_up(milliseconds(10'000)));
    ASSERT_EQ(two.revision("office"), i);
  }
  server.kill();
  ASSERT_TRUE(eventually([&] { return !two.connection().is_connected(); }));
  EXPECT_FALSE(two->catch_up(milliseconds(10'000)));
  server.start();
}

TEST(NatsFollow, SaysHowFarItHasRead) {
  const NatsServer server;
  FleetLog one({server.url()});
  FleetLog two({server.url()});
  EXPECT_EQ(one->position_of("office"), 0U);
  EXPECT_EQ(one->append("office", sample_entry(0, 1, "a")).error, "");
  const std::uint64_t position = one->position_of("office");
  EXPECT_GT(position, 0U);
  EXPECT_LT(two->followed(), position);
  two.follow();
  ASSERT_TRUE(eventually([&] { return two->followed() >= position; }));
  EXPECT_EQ(two.revision("office"), 1U);
  EXPECT_EQ(two->position_of("office"), position);
  EXPECT_TRUE(eventually([&] { return two->is_in_touch(); }));
  EXPECT_EQ(FleetLog({server.url()})->followed(), position);
}

TEST(NatsFollow, SaysThatItIsOutOfTouch) {
  NatsServer server;
  FleetLog log({server.url()});
  log.follow();
  ASSERT_TRUE(eventually([&] { return log->is_in_touch(); }));
  server.pause();
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(eventually([&] { return !log->is_in_touch(); }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(4000));
  server.resume();
  ASSERT_TRUE(eventually([&] { return log->is_in_touch(); }));
}

TEST(NatsFollow, BringsASummaryInsteadOfWhatItHasReplaced) {
  const NatsServer server;
  FleetLog writer({server.url()});
  FleetLog reader({server.url()});
  std::mutex mutex;
  std::vector<std::string> seen;
  std::atomic<bool> may_go_on = false;
  reader->follow([&](const LogUpdate& update) {
    {
      const std::lock_guard lock(mutex);
      seen.push_back((update.kind == LogUpdate::Kind::kSummary ? "summary " : "entry ") +
                     std::to_string(update.entry.revision));
    }
    eventually([&] { return may_go_on.load(); });
  });
  for (std::uint64_t i = 0; i < 100; ++i) {
    ASSERT_EQ(writer->append("office", sample_entry(i, i + 1, "text")).error, "");
  }
  ASSERT_EQ(writer->summarize("office", 100, log_bytes("all"), {}).error, "");
  ASSERT_EQ(writer->append("office", sample_entry(100, 101, "text")).error, "");
  may_go_on = true;
  ASSERT_TRUE(eventually([&] { return reader->followed() >= writer->position_of("office"); }));
  reader->stop_following();
  // The reader had asked for some of the first ones before they were replaced.
  EXPECT_EQ(seen.front(), "entry 1");
  ASSERT_GE(seen.size(), 3U);
  EXPECT_LT(seen.size(), 90U);
  for (std::size_t i = 0; i + 2 < seen.size(); ++i) {
    EXPECT_EQ(seen[i], "entry " + std::to_string(i + 1));
  }
  EXPECT_EQ(seen[seen.size() - 2], "summary 100");
  EXPECT_EQ(seen.back(), "entry 101");
}

// A purge removes one message after the other, so a follower can read between two removals.
TEST(NatsFollow, DoesNotPassOnAnOwnChangeWhosePredecessorsAreBeingPurged) {
  constexpr std::uint64_t kChanges = 300;
  const NatsServer server;
  FleetLog log({server.url()});
  std::mutex mutex;
  std::vector<std::string> seen;
  std::uint64_t revision = 0;
  std::atomic<bool> may_go_on = false;
  log->follow([&](const LogUpdate& update) {
    {
      const std::lock_guard lock(mutex);
      const bool is_summary = update.kind == LogUpdate::Kind::kSummary;
      if (!is_summary && update.entry.before != revision) {
        seen.push_back(std::to_string(update.entry.revision) + " after " +
                       std::to_string(revision));
      }
      revision = update.entry.revision;
      if (is_summary) seen.push_back("summary " + std::to_string(revision));
    }
    eventually([&] { return may_go_on.load(); });
  });
  for (std::uint64_t i = 0; i < kChanges; ++i) {
    ASSERT_EQ(log->append("office", sample_entry(i, i + 1, "text")).error, "");
  }
  nats::StreamConfig config;
  config.name = "camway_LOG";
  config.subject = "camway.log.>";
  config.news = "camway.news";
  const auto stream = nats::Stream::ensure(log.connection(), config, milliseconds(3000));
  ASSERT_TRUE(stream) << stream.error;
  const auto purged =
      (*stream)->purge("camway.log.scene.>", log->position_of("office") - 1, milliseconds(10'000));
  ASSERT_TRUE(purged) << purged.error;
  ASSERT_EQ(*purged, kChanges - 2);
  may_go_on = true;
  ASSERT_TRUE(eventually([&] { return log->followed() >= log->position_of("office"); }));
  ASSERT_EQ(log->summarize("office", kChanges, log_bytes("all"), {}).error, "");
  ASSERT_TRUE(eventually([&] { return log->followed() >= log->position_of("office"); }));
  log->stop_following();
  EXPECT_EQ(seen, std::vector<std::string>{"summary " + std::to_string(kChanges)});
  EXPECT_EQ(log.warnings(), "");
}

/// Changes of one scene by several threads of several processes.
class ManyWriters {
 public:
  void run(FleetLog& log, const std::string& name, int threads, int changes) {
    for (int t = 0; t < threads; ++t) {
      threads_.emplace_back([this, &log, name, t, changes] {
        for (int i = 0; i < changes; ++i) {
          const std::string text = name + std::to_string(t) + "/" + std::to_string(i);
          const AppendResult result = log.append("office", text);
          const std::lock_guard lock(mutex_);
          if (result.fault == AppendFault::kNone) acknowledged_.insert(text);
          if (result.fault != AppendFault::kNone) faults_ += result.error + "\n";
        }
      });
    }
  }
  void join() {
    for (std::thread& thread : threads_) thread.join();
  }
  [[nodiscard]] const std::multiset<std::string>& acknowledged() const { return acknowledged_; }
  [[nodiscard]] const std::string& faults() const { return faults_; }

 private:
  std::mutex mutex_;
  std::multiset<std::string> acknowledged_;
  std::string faults_;
  std::vector<std::thread> threads_;
};

std::multiset<std::string> texts_in(const std::vector<std::string>& updates) {
  std::multiset<std::string> texts;
  for (const std::string& update : updates) texts.insert(update.substr(update.find(": ") + 2));
  return texts;
}

TEST(NatsFollow, EachAcknowledgedChangeIsThereOnceAndAllSeeTheSame) {
  constexpr int kChanges = 50;
  const NatsServer server;
  FleetLog one({server.url()});
  FleetLog two({server.url()});
  one.follow();
  two.follow();
  ManyWriters writers;
  writers.run(one, "one", 2, kChanges);
  writers.run(two, "two", 2, kChanges);
  writers.join();
  EXPECT_EQ(writers.faults(), "");
  EXPECT_EQ(writers.acknowledged().size(), 4U * kChanges);
  ASSERT_TRUE(eventually([&] {
    return one.revision("office") == 4 * kChanges && two.revision("office") == 4 * kChanges;
  }));
  EXPECT_EQ(one.seen(), two.seen());
  EXPECT_EQ(texts_in(one.seen()), writers.acknowledged());
  EXPECT_EQ(one.faults() + two.faults(), "");
  EXPECT_EQ(FleetLog({server.url()}).seen(), one.seen());
  EXPECT_EQ(one.warnings() + two.warnings(), "");
}

TEST(NatsFollow, SummariesOfOneProcessDoNotDisturbAnother) {
  constexpr int kChanges = 60;
  const NatsServer server;
  FleetLog one({server.url()});
  FleetLog two({server.url()});
  one.follow();
  two.follow();
  ManyWriters writers;
  writers.run(one, "one", 2, kChanges);
  writers.run(two, "two", 2, kChanges);
  int summaries = 0;
  for (int i = 0; one.revision("office") < 4 * kChanges && i < 500; ++i) {
    const std::uint64_t revision = one.revision("office");
    const AppendResult done =
        one->summarize("office", revision, log_bytes("up to " + std::to_string(revision)), {});
    if (done.fault == AppendFault::kNone) ++summaries;
    std::this_thread::sleep_for(milliseconds(10));
  }
  writers.join();
  EXPECT_GT(summaries, 3);
  EXPECT_EQ(writers.faults(), "");
  ASSERT_TRUE(eventually([&] { return two.revision("office") == 4 * kChanges; }));
  EXPECT_EQ(one.faults() + two.faults(), "");
  EXPECT_EQ(one.warnings() + two.warnings(), "");
  EXPECT_EQ(FleetLog({server.url()}).revision("office"), 4U * kChanges);
}

}  // namespace
}  // namespace camway::scene
