// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/integration/fixture.h"
#include "tests/support/sanitizer.h"

namespace camway::integration {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Paths through the office, each of which an obstacle blocks now and then.
constexpr std::array<const char*, 4> kWays{"office-free-door", "office-graze-door",
                                           "office-free-corridor", "office-graze-column"};
constexpr std::array<std::array<double, 3>, 4> kPlaces{
    {{9.75, 1.5, 7.3}, {14.0, 1.6, 10.0}, {16.0, 1.6, 16.5}, {0.0, 50.0, 0.0}}};

Pose pose_at(const std::array<double, 3>& position_m) {
  Pose pose;
  pose.position_m = position_m;
  return pose;
}

/// A box with an upload as its mesh.
SceneMesh crate_mesh() {
  SceneMesh mesh;
  mesh.format = "obj";
  const std::string text =
      "v -.2 -.2 -.2\nv .2 -.2 -.2\nv .2 .2 -.2\nv -.2 .2 .2\nf 1 2 3\nf 1 3 4\nf 1 2 4\nf 2 3 4\n";
  mesh.bytes.assign(text.begin(), text.end());
  return mesh;
}

/// Returns the time of the request in the middle of a table of `camway session`.
std::string middle_time_of(const std::string& csv) {
  std::vector<std::string> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) rows.push_back(line);
  const auto fields = [](const std::string& row) {
    std::vector<std::string> all;
    std::istringstream cells(row);
    for (std::string cell; std::getline(cells, cell, ',');) all.push_back(cell);
    return all;
  };
  const std::vector<std::string> head = fields(rows.front());
  const auto column = std::ranges::find(head, "received_s") - head.begin();
  return fields(rows.at(rows.size() / 2)).at(static_cast<std::size_t>(column));
}

std::string verdict_line(const std::string& report) {
  return report.substr(report.find("verdict: "));
}

/// Most requests that wait at once. With a sanitizer a plan takes up to a second, for which all of
/// them wait.
constexpr int kMostPending = testing::kIsSanitized ? 6 : 96;

/// A daemon that records, clients that plan, and one that changes the scene all the while.
class RecordTest : public IntegrationTest {
 protected:
  std::string folder() const { return file("recorded"); }

  void start(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--workers", "2", "--queue", "300", "--client-queue", "150",
                             "--record", folder()});
    start_daemon_with_scenes({"office=" + scene_file("office")}, more);
  }

  /// Makes the i-th change of the office.
  static void change(Client& painter, int i) {
    const auto pose = pose_at(kPlaces.at(static_cast<std::size_t>(i) % kPlaces.size()));
    const auto is_made = [](const SceneAnswer& answer) {
      ASSERT_TRUE(answer.ok()) << answer.error;
    };
    switch (i % 6) {
      case 0:
        return is_made(painter.put_object("office", "crate", SceneBox{{0.4, 0.4, 0.4}}, pose));
      case 1:
        return is_made(painter.put_object("office", "upload", crate_mesh(), pose));
      case 2:
        return is_made(painter.move_object("office", "crate", pose));
      case 3: {
        SceneVoxels map;
        map.resolution_m = 0.2;
        if (i == 3) is_made(painter.put_object("office", "seen", map, Pose()));
        std::vector<std::array<double, 3>> wall;
        for (int k = 0; k < 20; ++k) wall.push_back({9.5 + 0.05 * k, 1.5 + 0.01 * i, 7.3});
        return is_made(painter.insert_scan("office", "seen", wall, {9.75, 1.5, 5.0}));
      }
      case 4:
        return is_made(painter.remove_object("office", "crate"));
      default:
        return is_made(painter.move_object("office", "upload", pose));
    }
  }

  /// Plans many paths while the scene changes; so many wait at once at most. Returns the revisions
  /// that they met.
  std::set<std::int64_t> work_on(int requests, int most_pending = kMostPending) {
    Client painter(patient());
    std::vector<std::unique_ptr<Client>> planners;
    // A request that is repeated while it waits is recorded twice, and the second time perhaps in
    // a later file than its scene. Only one that was lost is repeated here.
    ClientOptions slow_to_repeat = patient();
    slow_to_repeat.try_timeout_s = slow_to_repeat.max_try_timeout_s = 10.0;
    for (int i = 0; i < 3; ++i) planners.push_back(std::make_unique<Client>(slow_to_repeat));
    std::vector<PendingPlan> pending;
    for (int i = 0; i < requests; ++i) {
      // Requests that wait neither reach their deadline, nor are answered in a later file.
      if (i >= most_pending) pending[static_cast<std::size_t>(i - most_pending)].answer.wait();
      PlanRequest request =
          request_of(kWays.at(static_cast<std::size_t>(i) % kWays.size()), "office");
      pending.push_back(planners.at(static_cast<std::size_t>(i) % 3)->plan_async(request));
      // A log tells of the scene before all changes by an answer about it alone.
      if (i == 0) pending.front().answer.wait();
      if (i % 4 == 3) change(painter, i / 4);
    }
    std::set<std::int64_t> revisions;
    for (PendingPlan& plan : pending) revisions.insert(plan.answer.get().scene_revision);
    return revisions;
  }

  void stop() {
    daemon().signal(SIGTERM);
    ASSERT_EQ(daemon().wait(), 0) << daemon().output();
  }

  /// Returns exit code and output of `camway` with these arguments.
  std::pair<int, std::string> camway(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CAMWAY_BINARY);
    Process process(arguments, file("said-" + std::to_string(said_++) + ".log"));
    const int code = process.wait().value_or(-1);
    return {code, process.output()};
  }

  int said_ = 0;
};

/// The same session, recorded by the daemon and by lcm-logger.
TEST_F(RecordTest, WhatIsRecordedUnderLoadReplaysBitIdentically) {
  const std::string log = file("plain.lcmlog");
  Process logger({LCM_LOGGER_BINARY, "--quiet", "--force", "--flush-interval=50", log},
                 file("logger.log"));
  start();
  ASSERT_TRUE(
      eventually([&] { return read_file(log).find("CAMWAY_STATUS") != std::string::npos; }));
  const std::set<std::int64_t> revisions = work_on(96);
  EXPECT_GT(revisions.size(), 4U);
  Client client(patient());
  ASSERT_TRUE(client.unload_scene("office").ok());
  EXPECT_EQ(client.plan(request_of(kWays[0], "office")).status, Status::kUnknownScene);
  stop();
  logger.signal(SIGTERM);
  ASSERT_TRUE(logger.wait());

  const std::string all = "verdict: SAME: 97 requests: 97 same,";
  const auto [code, text] = camway({"replay", folder(), "--threads", "2", "--no-timing"});
  EXPECT_EQ(code, 0) << text;
  EXPECT_THAT(text, HasSubstr(all));

  // Packed, and unpacked elsewhere.
  const std::string pack = file("bug.camway-session");
  const auto [packed, pack_text] = camway({"pack", folder(), "-o", pack});
  ASSERT_EQ(packed, 0) << pack_text;
  fs::remove_all(folder());
  const auto [replayed, replay_text] = camway({"replay", pack, "--threads", "2", "--no-timing"});
  EXPECT_EQ(replayed, 0) << replay_text;
  EXPECT_EQ(replay_text, text);
  const auto [unpacked, unpack_text] = camway({"unpack", pack, file("elsewhere")});
  ASSERT_EQ(unpacked, 0) << unpack_text;
  EXPECT_EQ(camway({"replay", file("elsewhere"), "--no-timing"}).second, text);

  // The log of lcm-logger tells of changes by messages only, and of the first scene by its digest.
  const std::string scenes = fs::path(scene_file("office")).parent_path();
  const auto [plain, plain_text] = camway({"replay", log, "--root", scenes, "--no-timing"});
  EXPECT_EQ(plain, 0) << plain_text;
  EXPECT_THAT(plain_text, HasSubstr(all));
  // A part of it needs the scene with which the log begins, though none of its requests does.
  const std::string middle_s = middle_time_of(camway({"session", log, "--csv", "-"}).second);
  const std::vector<std::string> later{"--root", scenes, "--from", middle_s};
  std::vector<std::string> replay_later{"replay", log, "--no-timing"};
  replay_later.insert(replay_later.end(), later.begin(), later.end());
  const auto [part, part_text] = camway(replay_later);
  EXPECT_EQ(part, 0) << part_text;
  EXPECT_THAT(part_text, AllOf(HasSubstr(" 0 not compared"), HasSubstr("are not selected")));
  std::vector<std::string> pack_later{"pack", log, "-o", file("part.camway-session")};
  pack_later.insert(pack_later.end(), later.begin(), later.end());
  const auto [part_packed, part_pack_text] = camway(pack_later);
  ASSERT_EQ(part_packed, 0) << part_pack_text;
  const auto [again, again_text] =
      camway({"replay", file("part.camway-session"), "--from", middle_s, "--no-timing"});
  EXPECT_EQ(again, 0) << again_text;
  EXPECT_EQ(verdict_line(again_text), verdict_line(part_text));
  const std::string plain_pack = file("plain.camway-session");
  const auto [plain_packed, plain_pack_text] =
      camway({"pack", log, "-o", plain_pack, "--scene", "office=" + scene_file("office")});
  ASSERT_EQ(plain_packed, 0) << plain_pack_text;
  fs::remove(log);
  const auto [last, last_text] = camway({"replay", plain_pack, "--no-timing"});
  EXPECT_EQ(last, 0) << last_text;
  EXPECT_THAT(last_text, HasSubstr(all));
}

/// Small files, so that many follow each other while scenes change: each stands for itself.
TEST_F(RecordTest, EachFileOfARotationReplaysAlone) {
  std::ofstream(file("camwayd.toml")) << "[record]\nfile_bytes = 65536\nmost_bytes = 268435456\n";
  start({"--config", file("camwayd.toml")});
  // Requests that were planned in a scene of the file before are not compared. With few that wait,
  // these are few, however far planning lags behind the changes of scenes on a busy machine.
  work_on(64, 4);
  stop();
  std::size_t files = 0;
  std::size_t agreeing = 0;
  for (const auto& entry : fs::directory_iterator(folder())) {
    if (entry.path().extension() != ".lcmlog") continue;
    ++files;
    const auto [code, text] = camway({"replay", entry.path().string(), "--no-timing"});
    EXPECT_THAT(text, AnyOf(HasSubstr(" 0 different"), HasSubstr("holds no planning requests")));
    EXPECT_THAT(text, Not(HasSubstr("is not in the log")));
    std::smatch found;
    if (std::regex_search(text, found, std::regex("([0-9]+) same"))) {
      agreeing += std::stoul(found[1]);
    }
  }
  EXPECT_GT(files, 3U);
  EXPECT_GT(agreeing, 40U);
  const auto [code, text] = camway({"replay", folder(), "--no-timing"});
  EXPECT_EQ(code, 0) << text;
  EXPECT_THAT(text, HasSubstr("64 requests: 64 same,"));
}

}  // namespace
}  // namespace camway::integration
