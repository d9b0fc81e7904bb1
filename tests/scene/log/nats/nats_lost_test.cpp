// SPDX-License-Identifier: MIT
//
// The store of a server is removed while processes live that have the scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/nats/jetstream_api.h"
#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/log/nats/nats_log.h"
#include "daemon/scene/log/scene_follower.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/integration/process.h"
#include "tests/scene/log/nats/fleet_log.h"
#include "tests/scene/log/random_changes.h"
#include "tests/support/nats_server.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using integration::eventually;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing::NatsServer;

/// A server whose store can be emptied.
class EmptiedServer {
 public:
  NatsServer server;

  EmptiedServer() {
    server.kill();
    server.keep_copy();
    server.start();
  }
  void remove_store() {
    server.kill();
    server.restore_copy();
    server.start();
  }
};

/// No blob is repaired because it was put a moment ago.
NatsLogOptions without_recent() {
  NatsLogOptions options;
  options.recent_time = milliseconds(0);
  return options;
}

/// A process of a fleet with its scenes.
class FleetProcess {
 public:
  explicit FleetProcess(const std::string& url, const SceneStoreLimits& limits = {})
      : log_({url}, without_recent()),
        scenes_(*log_, std::chrono::seconds(10)),
        store_(limits, &scenes_) {
    auto histories = scenes_.load(limits.history);
    error_ = histories.error;
    if (!histories) return;
    for (SceneHistory& history : *histories) store_.adopt(std::move(history));
    follower_.emplace(*log_, scenes_, store_, [](const std::string&) {});
  }

  SceneStore& store() { return store_; }
  FleetLog& log() { return log_; }
  [[nodiscard]] const std::string& error() const { return error_; }
  [[nodiscard]] std::string digests() const {
    std::string text;
    for (const auto& snapshot : store_.list()) {
      text += snapshot->name + " " + std::to_string(snapshot->revision) + " " + snapshot->digest;
      const SceneHistory history = *store_.history(snapshot->name);
      for (const KeptRevision& kept : history.revisions()) {
        text += "\n  " + history.rebuild(kept.revision)->digest;
      }
      text += "\n";
    }
    return text;
  }

 private:
  FleetLog log_;
  DurableScenes scenes_;
  SceneStore store_;
  std::string error_;
  std::optional<SceneFollower> follower_;
};

TEST(NatsLost, AProcessThatLivesPutsAllContentsAgain) {
  EmptiedServer emptied;
  FleetProcess one(emptied.server.url());
  testing::Random random(11);
  for (int step = 0; step < 150; ++step) testing::change_at_random(one.store(), random, step);
  const std::string before = one.digests();
  ASSERT_THAT(before, HasSubstr("\n"));
  emptied.remove_store();
  ASSERT_TRUE(eventually([&] { return one.log()->is_in_touch(); })) << one.log().warnings();
  EXPECT_THAT(one.log().warnings(), HasSubstr("which were made again of the scenes here"));
  FleetProcess later(emptied.server.url());
  EXPECT_EQ(later.error(), "");
  EXPECT_EQ(later.digests(), before);
}

TEST(NatsLost, AProcessThatOnlyReadPutsAllContentsAgain) {
  EmptiedServer emptied;
  auto one = std::make_unique<FleetProcess>(emptied.server.url());
  testing::Random random(12);
  for (int step = 0; step < 60; ++step) testing::change_at_random(one->store(), random, step);
  const std::string before = one->digests();
  FleetProcess reader(emptied.server.url());
  ASSERT_EQ(reader.digests(), before);
  one.reset();
  emptied.remove_store();
  ASSERT_TRUE(eventually([&] { return reader.log()->is_in_touch(); })) << reader.log().warnings();
  FleetProcess later(emptied.server.url());
  EXPECT_EQ(later.error(), "");
  EXPECT_EQ(later.digests(), before);
}

TEST(NatsLost, WhatNobodyHasIsNamedUntilTheNextChangeMakesItNeedless) {
  EmptiedServer emptied;
  SceneStoreLimits limits;
  limits.history.changes = 1;
  FleetProcess one(emptied.server.url(), limits);
  testing::Random random(13);
  ASSERT_EQ(one.store().put(assemble("room", 1, {}, {})).error, "");
  const auto put_crate = [&] {
    return one.store()
        .change("room", {SceneChange::Kind::kPut, "crate", testing::random_box(random), {}})
        .error;
  };
  // The history forgets the first ones, which the log still has.
  for (int i = 0; i < 6; ++i) ASSERT_EQ(put_crate(), "");
  emptied.remove_store();
  ASSERT_TRUE(
      eventually([&] { return one.log().warnings().find("has not") != std::string::npos; }));
  EXPECT_THAT(one.log().warnings(), HasSubstr("meshes or maps that this process has not, of these "
                                              "scenes: 'room' ("));
  EXPECT_FALSE(one.log()->is_in_touch());
  {
    FleetProcess refused(emptied.server.url());
    EXPECT_THAT(refused.error(),
                HasSubstr("scene 'room' is not whole in the log: object 'crate': "));
    EXPECT_THAT(refused.error(), HasSubstr("Put it again or unload the scene"));
  }
  ASSERT_EQ(put_crate(), "");
  ASSERT_TRUE(eventually([&] { return one.log()->is_in_touch(); })) << one.log().warnings();
  EXPECT_THAT(one.log().warnings(), HasSubstr("nothing that scenes need is missing"));
  FleetProcess later(emptied.server.url(), limits);
  EXPECT_EQ(later.error(), "");
  EXPECT_EQ(later.digests(), one.digests());
}

// No process lives that has the contents, and none can be started to unload the scene.
TEST(NatsLost, AFrontThatStartsMayDropWhatIsLost) {
  EmptiedServer emptied;
  testing::Random random(17);
  {
    FleetProcess one(emptied.server.url());
    for (const char* const name : {"lost", "also"}) {
      ASSERT_EQ(one.store().put(assemble(name, 1, {}, {})).error, "");
      ASSERT_EQ(
          one.store()
              .change(name, {SceneChange::Kind::kPut, "crate", testing::random_box(random), {}})
              .error,
          "");
    }
  }
  // The contents alone are lost.
  {
    nats::ConnectOptions options;
    options.servers = {emptied.server.url()};
    const auto connection = nats::Connection::open(options);
    ASSERT_TRUE(connection) << connection.error;
    const auto gone =
        nats::ask_api(**connection, "STREAM.DELETE.camway_BLOBS", nullptr, milliseconds(5000));
    ASSERT_TRUE(gone) << gone.error;
  }
  const FleetProcess refused(emptied.server.url());
  EXPECT_THAT(refused.error(), HasSubstr("scene 'lost'"));
  EXPECT_THAT(refused.error(), HasSubstr("scene 'also'"));
  EXPECT_THAT(refused.error(), HasSubstr("--fleet-drop"));
  {
    FleetLog log({emptied.server.url()}, without_recent());
    EXPECT_EQ(log->drop("lost").error, "");
    EXPECT_EQ(log->drop("also").error, "");
    EXPECT_EQ(log->drop("also").fault, AppendFault::kConflict);
    EXPECT_EQ(log->drop("never").fault, AppendFault::kConflict);
  }
  FleetProcess later(emptied.server.url());
  EXPECT_EQ(later.error(), "");
  EXPECT_EQ(later.digests(), "");
  // Revisions go on above those of the scene that was dropped.
  EXPECT_EQ(later.store().put(assemble("lost", 1, {}, {})).error, "");
}

TEST(NatsLost, NotesAndLargeRecordsArePutAgain) {
  EmptiedServer emptied;
  const std::vector<std::string> urls{emptied.server.url()};
  FleetLog log(urls, without_recent());
  log.follow();
  const std::string large(300'000, 'r');
  ASSERT_EQ(log.append("office", large).error, "");
  ASSERT_EQ(log->set_note("origin", "old").error, "");
  ASSERT_EQ(log->set_note("origin", "new").error, "");
  emptied.remove_store();
  ASSERT_TRUE(eventually([&] { return log->is_in_touch(); })) << log.warnings();
  FleetLog later(urls);
  EXPECT_EQ(later->note("origin"), "new");
  EXPECT_EQ(text_of_log(urls), "office at 0: \n  0 -> 1: " + large + "\n");
}

TEST(NatsLost, ANoteOfAnotherProcessIsNotReplaced) {
  NatsServer server;
  const std::vector<std::string> urls{server.url()};
  FleetLog log(urls);
  FleetLog other(urls);
  log.follow();
  ASSERT_EQ(log->set_note("origin", "old").error, "");
  ASSERT_EQ(other->set_note("origin", "new").error, "");
  const std::uint64_t generation = log.connection().generation();
  server.kill();
  server.start();
  ASSERT_TRUE(
      eventually([&] { return log.connection().generation() > generation && log->is_in_touch(); }));
  EXPECT_EQ(log->note("origin"), "new");
}

}  // namespace
}  // namespace camway::scene
