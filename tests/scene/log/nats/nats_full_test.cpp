// SPDX-License-Identifier: MIT
//
// Servers of NATS that have no room: a full disk, and a limit that is reached.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "daemon/scene/log/nats/nats_log.h"
#include "tests/integration/process.h"
#include "tests/scene/log/nats/fleet_log.h"
#include "tests/support/nats_server.h"
#include "tests/support/small_disk.h"

namespace camway::scene {
namespace {

using integration::eventually;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing::NatsServer;
using ::testing::Not;
using testing::SmallDisk;

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

constexpr std::size_t kDiskKibibytes = std::size_t{20} << 10U;

TEST(NatsFull, AFullDiskRefusesChangesUntilTheServerIsStartedAgain) {
  const SmallDisk disk(kDiskKibibytes);
  if (!disk.is_there()) GTEST_SKIP() << "no file system can be mounted here";
  NatsServer server("jetstream { store_dir: \"" + disk.path().string() + "/js\" }\n");
  FleetLog log({server.url()});
  FleetLog other({server.url()});
  log.follow();
  other.follow();
  ASSERT_EQ(log.append("office", "before").error, "");
  disk.fill();
  // The rest of the last page of a file still takes some changes.
  std::vector<std::string> kept{"before"};
  AppendResult refused;
  for (int i = 0; i < 1000 && refused.fault == AppendFault::kNone; ++i) {
    const std::string text = std::to_string(i) + std::string(900, 'x');
    const auto begin = std::chrono::steady_clock::now();
    refused = log.append("office", text);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(7000));
    if (refused.fault == AppendFault::kNone) kept.push_back(text);
  }
  EXPECT_EQ(refused.fault, AppendFault::kFull) << refused.error;
  EXPECT_THAT(refused.error, HasSubstr("answers, but stream camway_LOG of its JetStream does not"));
  EXPECT_THAT(refused.error, HasSubstr("restart that server"));
  // From now on it is said at once, and told to the user once.
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(log.append("hall", "a").fault, AppendFault::kFull);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(500));
  ASSERT_TRUE(eventually([&] { return other.warnings() != ""; }));
  EXPECT_FALSE(log->is_in_touch());
  const std::uint64_t generation = log.connection().generation();
  disk.make_room();
  // That alone does not help this server.
  EXPECT_EQ(log.append("hall", "a").fault, AppendFault::kFull);
  std::this_thread::sleep_for(milliseconds(4000));
  EXPECT_LE(log.connection().generation(), generation + 1) << "the connection does not flap";
  server.kill();
  server.start();
  ASSERT_TRUE(eventually([&] { return log->is_in_touch() && other->is_in_touch(); }));
  ASSERT_EQ(log.append("hall", "after").error, "");
  for (FleetLog* const each : {&log, &other}) {
    EXPECT_EQ(count_of(each->warnings(), "changes of scenes are refused"), 1U) << each->warnings();
    EXPECT_EQ(count_of(each->warnings(), "answers again"), 1U) << each->warnings();
    EXPECT_EQ(each->faults(), "");
  }
  // All that was acknowledged is there; the refused change may be, too.
  FleetLog later({server.url()});
  const auto scenes = later->scenes();
  ASSERT_TRUE(scenes) << scenes.error;
  std::vector<std::string> texts;
  for (const LogEntry& entry : scenes->back().entries) texts.push_back(log_text(entry.record));
  ASSERT_EQ(scenes->back().name, "office");
  texts.resize(std::min(texts.size(), kept.size()));
  EXPECT_EQ(texts, kept);
}

TEST(NatsFull, AFullDiskRefusesMeshesAndTakesThemOnceThereIsRoom) {
  const SmallDisk disk(kDiskKibibytes);
  if (!disk.is_there()) GTEST_SKIP() << "no file system can be mounted here";
  const NatsServer server("jetstream { store_dir: \"" + disk.path().string() + "/js\" }\n");
  FleetLog log({server.url()});
  log.follow();
  disk.fill();
  const SampleBlob mesh(std::string(1'500'000, 'm'));
  const AppendResult refused = log->put_blob(mesh.id, mesh.blob);
  EXPECT_EQ(refused.fault, AppendFault::kFull) << refused.error;
  EXPECT_THAT(refused.error, HasSubstr("no space left on device"));
  disk.make_room();
  EXPECT_EQ(log->put_blob(mesh.id, mesh.blob).error, "");
  EXPECT_EQ(log.append("office", "a", {mesh.id}).error, "");
  EXPECT_THAT(log.warnings(), Not(HasSubstr("refused")));
}

/// Puts meshes into a scene until there is no room. Returns how many.
int fill_with_meshes(FleetLog& log, const std::string& scene) {
  for (int i = 0;; ++i) {
    const SampleBlob mesh(scene + std::to_string(i) + std::string(700'000, 'm'));
    const AppendResult put = log->put_blob(mesh.id, mesh.blob);
    const AppendResult done =
        put.fault == AppendFault::kNone ? log.append(scene, std::to_string(i), {mesh.id}) : put;
    if (done.fault == AppendFault::kNone) continue;
    EXPECT_EQ(done.fault, AppendFault::kFull) << done.error;
    return i;
  }
}

/// Goes on at the limit of a server: by changes without meshes, summaries and removals.
void goes_on_at_its_limit(const std::string& url, NatsLogOptions options) {
  options.blob_grace = milliseconds(400);
  FleetLog log({url}, options);
  log.follow();
  const int meshes = fill_with_meshes(log, "office");
  ASSERT_GT(meshes, 2);
  const SampleBlob mesh(std::string(600'000, 'n'));
  EXPECT_EQ(log->put_blob(mesh.id, mesh.blob).fault, AppendFault::kFull);
  // As the removal of an object.
  for (int i = 0; i < 20; ++i) ASSERT_EQ(log.append("office", "without").error, "") << i;
  ASSERT_EQ(log.append("hall", "without").error, "");
  // Until not even the smallest change has room.
  for (const std::size_t bytes : {100'000U, 10'000U, 1'000U, 1U}) {
    AppendResult small;
    for (int i = 0; i < 100 && small.fault == AppendFault::kNone; ++i) {
      small = log.append("hall", std::string(bytes, 'x'));
    }
    EXPECT_EQ(small.fault, AppendFault::kFull) << small.error;
  }
  EXPECT_EQ(log->summarize("hall", log.revision("hall"), log_bytes("sum"), {}).error, "");
  EXPECT_EQ(log->remove("office", log.revision("office")).error, "");
  ASSERT_EQ(log->drop_unused_blobs().error, "");
  // The room comes back by itself.
  EXPECT_TRUE(eventually([&] { return log->put_blob(mesh.id, mesh.blob).error.empty(); }));
  EXPECT_EQ(log.append("yard", "a", {mesh.id}).error, "");
  EXPECT_TRUE(eventually([&] { return fill_with_meshes(log, "yard") >= meshes - 2; }));
  EXPECT_EQ(log.faults(), "");
  FleetLog later({url}, options);
  EXPECT_EQ(later.revision("hall"), log.revision("hall"));
  EXPECT_EQ(later.revision("yard"), log.revision("yard"));
  EXPECT_EQ(later.revision("office"), 0U);
}

TEST(NatsFull, RemovalsAndSummariesArePossibleAtTheLimitOfTheServer) {
  const NatsServer server("jetstream { store_dir: \"STORE\", max_file_store: 8MB }\n");
  goes_on_at_its_limit(server.url(), {});
}

TEST(NatsFull, RemovalsAndSummariesArePossibleAtTheLimitOfTheStreams) {
  const NatsServer server;
  NatsLogOptions options;
  options.most_bytes = 8'000'000;
  goes_on_at_its_limit(server.url(), options);
}

}  // namespace
}  // namespace camway::scene
