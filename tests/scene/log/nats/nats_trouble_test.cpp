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

#include "daemon/nats/jetstream_api.h"
#include "tests/integration/process.h"
#include "tests/scene/log/nats/fleet_log.h"
#include "tests/support/nats_server.h"

namespace camway::scene {
namespace {

using integration::eventually;
using std::chrono::milliseconds;
using testing::NatsCluster;
using testing::NatsServer;

constexpr milliseconds kBetweenCrashes{400};

/// Appends changes until it is told to end. Each has a text of its own.
class SteadyWriter {
 public:
  SteadyWriter(FleetLog& log, std::string scene, std::string name)
      : thread_([this, &log, scene = std::move(scene), name = std::move(name)] {
          for (int i = 0; !ends_; ++i) {
            const std::string text = name + "/" + std::to_string(i);
            const AppendResult result = log.append(scene, text);
            const std::lock_guard lock(mutex_);
            if (result.fault == AppendFault::kNone) acknowledged_.insert(text);
            if (result.fault != AppendFault::kNone) unclear_.insert(text);
          }
        }) {}
  ~SteadyWriter() { end(); }

  void end() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::set<std::string> acknowledged() {
    const std::lock_guard lock(mutex_);
    return acknowledged_;
  }
  std::set<std::string> unclear() {
    const std::lock_guard lock(mutex_);
    return unclear_;
  }

 private:
  std::atomic<bool> ends_ = false;
  std::mutex mutex_;
  std::set<std::string> acknowledged_;
  std::set<std::string> unclear_;
  std::thread thread_;
};

/// The texts of a scene in the log, in order.
std::vector<std::string> texts_of_scene(FleetLog& log, const std::string& scene) {
  std::vector<std::string> texts;
  const auto scenes = log->scenes();
  EXPECT_TRUE(scenes) << scenes.error;
  if (!scenes) return texts;
  for (const LoggedScene& each : *scenes) {
    if (each.name != scene) continue;
    for (const LogEntry& entry : each.entries) texts.push_back(log_text(entry.record));
  }
  return texts;
}

/// Verifies that a log has all acknowledged changes once, and no others but unclear ones.
void expect_exactly(const std::vector<std::string>& texts,
                    const std::vector<std::unique_ptr<SteadyWriter>>& writers) {
  const std::set<std::string> found(texts.begin(), texts.end());
  EXPECT_EQ(found.size(), texts.size()) << "a change is there twice";
  std::set<std::string> known;
  for (const auto& writer : writers) {
    for (const std::string& text : writer->acknowledged()) {
      EXPECT_TRUE(found.contains(text)) << text << " is lost";
      known.insert(text);
    }
    known.merge(writer->unclear());
  }
  for (const std::string& text : texts) EXPECT_TRUE(known.contains(text)) << text;
}

std::size_t acknowledged_by(const std::vector<std::unique_ptr<SteadyWriter>>& writers) {
  std::size_t count = 0;
  for (const auto& writer : writers) count += writer->acknowledged().size();
  return count;
}

TEST(NatsTrouble, LosesNothingWhenTheServerIsKilled) {
  NatsServer server;
  FleetLog one({server.url()});
  FleetLog two({server.url()});
  one.follow();
  two.follow();
  std::vector<std::unique_ptr<SteadyWriter>> writers;
  writers.push_back(std::make_unique<SteadyWriter>(one, "office", "one"));
  writers.push_back(std::make_unique<SteadyWriter>(one, "office", "other"));
  writers.push_back(std::make_unique<SteadyWriter>(two, "office", "two"));
  for (int kills = 0; kills < 4; ++kills) {
    const std::size_t before = acknowledged_by(writers);
    ASSERT_TRUE(eventually([&] { return acknowledged_by(writers) > before + 10; }));
    if (kills == 2) {
      const std::uint64_t revision = one.revision("office");
      static_cast<void>(one->summarize("other", revision, log_bytes("none"), {}));
    }
    server.kill();
    std::this_thread::sleep_for(kBetweenCrashes / 8);
    server.start();
  }
  for (const auto& writer : writers) writer->end();
  FleetLog later({server.url()});
  const std::vector<std::string> texts = texts_of_scene(later, "office");
  expect_exactly(texts, writers);
  const auto head = later.revision("office");
  ASSERT_TRUE(
      eventually([&] { return one.revision("office") == head && two.revision("office") == head; }));
  EXPECT_EQ(one.seen(), two.seen());
  EXPECT_EQ(one.seen(), later.seen());
  EXPECT_EQ(one.faults() + two.faults(), "");
  EXPECT_EQ(one.warnings() + two.warnings(), "");
  // Nothing was lost, so most appends waited for the server to come back.
  EXPECT_EQ(writers[0]->unclear().size() + writers[2]->unclear().size(), 0U);
}

/// A server whose files are put back to what they were, as if its machine had lost power.
class PowerLoss {
 public:
  NatsServer server;

  std::vector<std::string> urls() const { return {server.url()}; }
  /// What the files have now is what remains.
  void sync() {
    server.kill();
    server.keep_copy();
    server.start();
  }
  void lose() {
    server.kill();
    server.restore_copy();
    server.start();
  }
};

TEST(NatsTrouble, AppendsAgainWhatTheServerLost) {
  PowerLoss power;
  FleetLog one(power.urls());
  FleetLog two(power.urls());
  one.follow();
  two.follow();
  for (int i = 0; i < 5; ++i) ASSERT_EQ(one.append("office", std::to_string(i)).error, "");
  power.sync();
  for (int i = 5; i < 15; ++i) ASSERT_EQ(one.append("office", std::to_string(i)).error, "");
  for (int i = 0; i < 3; ++i) ASSERT_EQ(two.append("hall", std::to_string(i)).error, "");
  ASSERT_TRUE(eventually([&] { return two.revision("office") == 15; }));
  const std::string before = text_of_log(power.urls());
  power.lose();
  // The next append waits for the repair.
  ASSERT_EQ(one.append("office", "15").error, "");
  ASSERT_TRUE(eventually([&] { return two.revision("office") == 16; }));
  ASSERT_TRUE(eventually([&] { return one->is_in_touch() && two->is_in_touch(); }));
  FleetLog later(power.urls());
  EXPECT_EQ(texts_of_scene(later, "office").size(), 16U);
  EXPECT_EQ(texts_of_scene(later, "hall").size(), 3U);
  EXPECT_NE((one.warnings() + two.warnings()).find("NATS had lost the last"), std::string::npos);
  EXPECT_EQ(one.faults() + two.faults(), "");
  EXPECT_EQ(one.seen().size(), 19U) << "nothing came twice";
  EXPECT_EQ(one->position_of("office"), later->position_of("office"));
  ASSERT_TRUE(eventually([&] { return two->followed() >= one->position_of("office"); }));
}

TEST(NatsTrouble, RepairsWhatAnyProcessKnows) {
  PowerLoss power;
  FleetLog reader(power.urls());
  reader.follow();
  power.sync();
  {
    FleetLog writer(power.urls());
    writer.follow();
    ASSERT_EQ(writer.append("office", "a").error, "");
    ASSERT_EQ(writer.append("office", "b").error, "");
  }
  ASSERT_TRUE(eventually([&] { return reader.revision("office") == 2; }));
  power.lose();
  ASSERT_TRUE(eventually([&] { return reader.warnings() != "" && reader->is_in_touch(); }));
  EXPECT_EQ(reader.warnings(),
            "NATS had lost the last 2 changes of scene 'office', up to revision 2, kept again "
            "now\n");
  EXPECT_EQ(text_of_log(power.urls()), "office at 0: \n  0 -> 1: a\n  1 -> 2: b\n");
}

TEST(NatsTrouble, RepairsSummariesRemovalsAndBlobs) {
  PowerLoss power;
  FleetLog log(power.urls());
  log.follow();
  for (int i = 0; i < 5; ++i) ASSERT_EQ(log.append("office", std::to_string(i)).error, "");
  ASSERT_EQ(log.append("hall", "a").error, "");
  ASSERT_EQ(log.append("attic", "a").error, "");
  power.sync();
  const SampleBlob small("small");
  const SampleBlob large(std::string(1'500'000, 'b'), {small.id});
  ASSERT_EQ(log->put_blob(small.id, small.blob).error, "");
  ASSERT_EQ(log->put_blob(large.id, large.blob).error, "");
  ASSERT_EQ(log.append("office", "5", {large.id}).error, "");
  ASSERT_EQ(log->summarize("office", 6, log_bytes("sum"), {large.id}).error, "");
  ASSERT_EQ(log.append("office", "6").error, "");
  ASSERT_EQ(log->remove("hall", 1).error, "");
  ASSERT_EQ(log->remove("attic", 1).error, "");
  ASSERT_TRUE(eventually([&] { return log.revision("attic") == 0; }));
  ASSERT_EQ(log.append("attic", "b").error, "");
  const std::string before = text_of_log(power.urls());
  power.lose();
  ASSERT_TRUE(eventually([&] { return log.warnings() != "" && log->is_in_touch(); }));
  EXPECT_EQ(text_of_log(power.urls()), before);
  FleetLog later(power.urls());
  EXPECT_EQ(later->highest_removed(), 1U);
  const auto bytes = later->blob(large.id);
  ASSERT_TRUE(bytes) << bytes.error;
  EXPECT_EQ(*bytes, large.blob.bytes);
  EXPECT_TRUE(later->blob(small.id));
}

TEST(NatsTrouble, RepairsAnEmptyStore) {
  PowerLoss power;
  power.sync();
  FleetLog log(power.urls());
  log.follow();
  for (int i = 0; i < 4; ++i) ASSERT_EQ(log.append("office", std::to_string(i)).error, "");
  ASSERT_EQ(log->summarize("office", 4, log_bytes("sum"), {}).error, "");
  ASSERT_EQ(log.append("office", "4").error, "");
  const std::string before = text_of_log(power.urls());
  // Not even the streams are there.
  power.lose();
  ASSERT_EQ(log.append("office", "5").error, "");
  EXPECT_EQ(text_of_log(power.urls()), before + "  5 -> 6: 5\n");
}

TEST(NatsTrouble, SaysThatNothingWasChangedExactlyIfNothingWasSent) {
  NatsServer server;
  NatsLogOptions options;
  options.patience = milliseconds(300);
  FleetLog log({server.url()}, options);
  ASSERT_EQ(log.append("office", "before").error, "");
  server.kill();
  ASSERT_TRUE(eventually([&] { return !log.connection().is_connected(); }));
  const AppendResult unsent = log->append("office", sample_entry(1, 2, "unsent"));
  EXPECT_EQ(unsent.fault, AppendFault::kBroken);
  EXPECT_NE(unsent.error.find("nothing was changed"), std::string::npos) << unsent.error;
  EXPECT_EQ(unsent.error.find("may still take effect"), std::string::npos) << unsent.error;
  server.start();
  ASSERT_TRUE(eventually([&] { return log.connection().is_connected(); }));
  EXPECT_EQ(text_of_log({server.url()}), "office at 0: \n  0 -> 1: before\n");
}

TEST(NatsTrouble, AppendsEitherSucceedOrSaySoWhenTheServerHangs) {
  const NatsServer server;
  NatsLogOptions options;
  options.patience = milliseconds(1500);
  FleetLog log({server.url()}, options);
  log.follow();
  ASSERT_EQ(log.append("office", "before").error, "");
  std::vector<std::unique_ptr<SteadyWriter>> writers;
  writers.push_back(std::make_unique<SteadyWriter>(log, "office", "one"));
  std::this_thread::sleep_for(milliseconds(100));
  server.pause();
  const auto begin = std::chrono::steady_clock::now();
  const AppendResult unheard = log->append("hall", sample_entry(0, 1, "unheard"));
  EXPECT_EQ(unheard.fault, AppendFault::kBroken);
  EXPECT_NE(unheard.error.find("The change may still take effect: send the same request again"),
            std::string::npos)
      << unheard.error;
  std::this_thread::sleep_until(begin + milliseconds(3500));
  server.resume();
  std::this_thread::sleep_for(milliseconds(300));
  writers[0]->end();
  FleetLog later({server.url()});
  std::vector<std::string> texts = texts_of_scene(later, "office");
  ASSERT_FALSE(texts.empty());
  texts.erase(texts.begin());
  expect_exactly(texts, writers);
  EXPECT_EQ(log.faults(), "");
}

TEST(NatsTrouble, AnAppendThatWasMadeButNotAnsweredIsThereOnce) {
  const NatsServer server;
  FleetLog log({server.url()});
  ASSERT_EQ(log->append("office", sample_entry(0, 1, "a")).error, "");
  server.pause();
  AppendResult result;
  std::thread appending([&] { result = log->append("office", sample_entry(1, 2, "b")); });
  // The first request counts as lost after two seconds and is sent again. Then the server gets
  // both.
  std::this_thread::sleep_for(milliseconds(2400));
  server.resume();
  appending.join();
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(text_of_log({server.url()}), "office at 0: \n  0 -> 1: a\n  1 -> 2: b\n");
}

/// The server that leads the stream of changes.
NatsServer& leader_of(NatsCluster& cluster, nats::Connection& connection) {
  const auto info =
      nats::ask_api(connection, "STREAM.INFO.camway_LOG", nullptr, milliseconds(5000));
  const std::string name = info ? info->value["cluster"]["leader"].get<std::string>() : "";
  return cluster.server(name);
}

TEST(NatsTrouble, AClusterGoesOnWithoutItsLeader) {
  NatsCluster cluster;
  NatsLogOptions options;
  options.replicas = 3;
  options.patience = milliseconds(15'000);
  FleetLog one(cluster.urls(), options);
  FleetLog two(cluster.urls(), options);
  one.follow();
  two.follow();
  const SampleBlob blob(std::string(1'000'000, 'b'));
  ASSERT_EQ(one->put_blob(blob.id, blob.blob).error, "");
  ASSERT_EQ(one.append("hall", "a", {blob.id}).error, "");
  std::vector<std::unique_ptr<SteadyWriter>> writers;
  writers.push_back(std::make_unique<SteadyWriter>(one, "office", "one"));
  writers.push_back(std::make_unique<SteadyWriter>(two, "office", "two"));
  std::this_thread::sleep_for(kBetweenCrashes);
  NatsServer& leader = leader_of(cluster, one.connection());
  leader.kill();
  const std::size_t before = writers[0]->acknowledged().size();
  EXPECT_TRUE(eventually([&] { return writers[0]->acknowledged().size() > before + 5; }));
  leader.start();
  std::this_thread::sleep_for(kBetweenCrashes);
  for (const auto& writer : writers) writer->end();
  FleetLog later(cluster.urls(), options);
  expect_exactly(texts_of_scene(later, "office"), writers);
  EXPECT_EQ(one.faults() + two.faults(), "");
  EXPECT_EQ(writers[0]->unclear().size() + writers[1]->unclear().size(), 0U);
  const auto bytes = later->blob(blob.id);
  ASSERT_TRUE(bytes) << bytes.error;
  EXPECT_EQ(*bytes, blob.blob.bytes);
}

}  // namespace
}  // namespace camway::scene
