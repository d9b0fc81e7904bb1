// SPDX-License-Identifier: MIT
//
// Servers of NATS that have no room: a full disk, and a limit that is reached.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>

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

}  // namespace
}  // namespace camway::scene
