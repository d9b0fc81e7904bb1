// SPDX-License-Identifier: MIT
#include "daemon/process/reloader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>

#include "tests/support/captured_log.h"
#include "tests/support/notify_socket.h"
#include "tests/support/slow_mesh.h"
#include "tests/support/temporary_folder.h"

namespace camway::process {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A reloader with configurations of the test, and a service manager that reports when it is done.
class ReloaderTest : public ::testing::Test {
 protected:
  ReloaderTest() {
    running_.scenes.push_back(scene_of("room"));
    EXPECT_TRUE(scenes_.update(running_.scenes)) << log_.text();
    reloader_.emplace(
        running_, [this] { return read_(); }, scenes_, record_, manager_, log_.log());
  }

  SceneArgument scene_of(const std::string& name) const {
    SceneArgument scene;
    scene.name = name;
    scene.file = folder_.write(name + ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return scene;
  }

  /// Returns the fields of the status about reloads.
  [[nodiscard]] status_t status() const {
    status_t status{};
    record_.add_to(status);
    return status;
  }

  /// Reloads with the result of `read`. Returns all lines of the log.
  std::string reload(Reloader::Read read) {
    read_ = std::move(read);
    reloader_->request();
    EXPECT_NE(socket_.next_of("RELOADING=1"), "");
    EXPECT_NE(socket_.next_of("READY=1"), "");
    return log_.text();
  }

  testing::TemporaryFolder folder_;
  testing::NotifySocket socket_{(folder_.path() / "notify").string()};
  const ServiceManager manager_{(folder_.path() / "notify").string(), std::nullopt};
  testing::CapturedLog log_;
  scene::SceneStore store_;
  ConfiguredScenes scenes_{store_, log_.log()};
  ReloadRecord record_;
  DaemonOptions running_ = default_options();
  Reloader::Read read_;
  std::optional<Reloader> reloader_;
};

TEST_F(ReloaderTest, TakesOverScenesAndLogLevel) {
  DaemonOptions next = running_;
  next.scenes = {scene_of("hall")};
  next.log_level = service::LogLevel::kDebug;
  const std::string said = reload([&] { return ParsedOptions{next, {}, {}}; });
  EXPECT_THAT(said, HasSubstr("info reloaded setting setting=log.level value=debug"));
  EXPECT_EQ(log_.log()->level(), service::LogLevel::kDebug);
  EXPECT_NE(store_.find("hall"), nullptr);
  EXPECT_EQ(store_.find("room"), nullptr);
}

TEST_F(ReloaderTest, ReadsAWatchedFileAgainWhenItChanges) {
  reloader_.reset();
  running_.scenes.front().watch = true;
  ASSERT_TRUE(scenes_.update(running_.scenes));
  reloader_.emplace(
      running_, [this] { return read_(); }, scenes_, record_, manager_, log_.log(), nullptr,
      std::chrono::milliseconds(5));
  folder_.write("room.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (store_.find("room")->index.size() != 2 && std::chrono::steady_clock::now() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(store_.find("room")->index.size(), 2U);
  EXPECT_EQ(store_.find("room")->revision, 2U);
  DaemonOptions next = running_;
  next.log_level = service::LogLevel::kDebug;
  EXPECT_THAT(reload([&] {
                return ParsedOptions{next, {}, {}};
              }),
              HasSubstr("info reloaded configured_scenes=1"))
      << "and reloads as ever";
}

TEST_F(ReloaderTest, WaitsForNoFileThatIsBeingRead) {
  const auto is_reading = [this](const std::string& scene) {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (log_.text().find("reading scene scene=" + scene) == std::string::npos &&
           std::chrono::steady_clock::now() < patience) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::chrono::steady_clock::now() < patience;
  };
  reloader_.reset();
  running_.scenes.front().watch = true;
  ASSERT_TRUE(scenes_.update(running_.scenes));
  log_.clear();
  DaemonOptions next = running_;
  next.scenes = {scene_of("hall")};
  testing::write_slow_mesh(next.scenes.front().file);
  read_ = [&] { return ParsedOptions{next, {}, {}}; };
  reloader_.emplace(
      running_, [this] { return read_(); }, scenes_, record_, manager_, log_.log(), nullptr,
      std::chrono::milliseconds(5));
  testing::write_slow_mesh(running_.scenes.front().file);
  ASSERT_TRUE(is_reading("room")) << "because it changed";
  const auto begin = std::chrono::steady_clock::now();
  reloader_->request();
  ASSERT_TRUE(is_reading("hall")) << "because of the reload";
  next.scenes = {scene_of("attic")};
  EXPECT_THAT(reload(read_), HasSubstr("info reloaded configured_scenes=1"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(40))
      << "an import may take a minute";
  EXPECT_NE(store_.find("attic"), nullptr);
  EXPECT_THAT(log_.text(), HasSubstr("info reload cancelled"));
  EXPECT_THAT(log_.text(), Not(HasSubstr("cannot be read")));
}

TEST_F(ReloaderTest, RequestsThatComeAllTheTimeKeepNoReloadFromItsEnd) {
  DaemonOptions next = running_;
  next.scenes = {scene_of("hall")};
  constexpr int kRequests = 10;
  std::atomic<int> reads = 0;
  std::atomic<int> reads_before_it_is_there = 0;
  reload([&] {
    if (store_.find("hall") == nullptr) ++reads_before_it_is_there;
    if (++reads < kRequests) reloader_->request();
    return ParsedOptions{next, {}, {}};
  });
  EXPECT_EQ(reads_before_it_is_there, 2) << "the first is cancelled for the second";
  reloader_.reset();
}

TEST_F(ReloaderTest, SaysWhatNeedsARestart) {
  DaemonOptions next = running_;
  next.service.queue.jobs = 9;
  const std::string said = reload([&] { return ParsedOptions{next, {}, {}}; });
  EXPECT_THAT(said, HasSubstr("warning setting stays until the daemon is started again "
                              "setting=queue.requests value=256 wanted=9"));
  EXPECT_THAT(said, Not(HasSubstr("log.level")));
}

TEST_F(ReloaderTest, KeepsWhatItHasIfTheConfigurationIsBad) {
  const std::string said = reload([] {
    return ParsedOptions{std::nullopt, {}, {"c.toml:3: no", "c.toml:5: nor this"}};
  });
  EXPECT_EQ(status().failed_reloads, 1);
  EXPECT_EQ(status().failed_reload, "c.toml:3: no; c.toml:5: nor this");
  EXPECT_THAT(said, HasSubstr("all stays as it was reason=\"c.toml:3: no\"\n"));
  EXPECT_THAT(said, HasSubstr("all stays as it was reason=\"c.toml:5: nor this\"\n"));
  EXPECT_NE(store_.find("room"), nullptr);

  DaemonOptions next = running_;
  next.log_level = service::LogLevel::kError;
  next.scenes = {scene_of("hall")};
  next.scenes.back().file = "/nowhere.obj";
  EXPECT_THAT(reload([&] {
                return ParsedOptions{next, {}, {}};
              }),
              HasSubstr("not all scenes could be taken over"));
  EXPECT_EQ(status().failed_reloads, 2);
  EXPECT_THAT(status().failed_reload, HasSubstr("scene 'hall': "));
  EXPECT_EQ(log_.log()->level(), service::LogLevel::kInfo);
  EXPECT_NE(store_.find("room"), nullptr);

  EXPECT_THAT(reload([]() -> ParsedOptions { throw std::runtime_error("boo"); }),
              HasSubstr("error reload failed, all stays as it was reason=boo"));
  EXPECT_EQ(status().failed_reloads, 3);
  EXPECT_EQ(status().failed_reload, "boo");
  EXPECT_GT(status().failed_reload_utime, 0);
  EXPECT_EQ(status().reload_failed, 1);

  reload([&] { return ParsedOptions{running_, {}, {}}; });
  EXPECT_EQ(status().reload_failed, 0);
  EXPECT_EQ(status().failed_reloads, 3) << "the last failure stays to be read";
  EXPECT_EQ(status().failed_reload, "boo");
}

}  // namespace
}  // namespace camway::process
