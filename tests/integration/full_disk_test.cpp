// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Mounts a small disk at $0 that only the next command sees.
constexpr char kMount[] = "mount -t tmpfs -o size=512k none \"$0\" && ";
/// Writes a file that fills the disk.
constexpr char kFill[] = "{ dd if=/dev/zero of=\"$0/filler\" bs=1k 2>/dev/null || true; } && ";

class FullDiskTest : public IntegrationTest {
 protected:
  void SetUp() override {
    IntegrationTest::SetUp();
    if (HasFatalFailure()) return;
    fs::create_directory(disk());
    Process probe(on_disk(std::string(kMount) + "exec \"$@\"", {"true"}), file("probe.log"));
    if (probe.wait() != 0) GTEST_SKIP() << "mounting is not allowed here: " << probe.output();
  }

  std::string disk() const { return file("disk"); }
  /// Returns the same folder as that process sees it.
  std::string disk_of(const Process& process) const {
    return "/proc/" + std::to_string(process.pid()) + "/root" + disk();
  }

  /// Returns a shell command for `script`, which must run `command` ("$@") at its end.
  std::vector<std::string> on_disk(const std::string& script,
                                   const std::vector<std::string>& command) const {
    std::vector<std::string> all{"/usr/bin/unshare", "-m", "sh", "-c", script, disk()};
    all.insert(all.end(), command.begin(), command.end());
    return all;
  }

  /// Returns the output of `camway` on a full disk, followed by the files on the disk.
  std::string said_on_full_disk(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CAMWAY_BINARY);
    const std::string script =
        std::string(kMount) + kFill + "{ \"$@\"; echo \"exit code $?\"; ls -A \"$0\"; }";
    Process process(on_disk(script, arguments), file("said.log"));
    process.wait();
    return process.output();
  }
};

/// The disk holds uploads for the importer, exported maps, and the log.
TEST_F(FullDiskTest, TheDaemonSaysSoAndServesOn) {
  std::ofstream(file("camwayd.toml")) << "[scenes]\nwrite_maps = true\n";
  run_daemons_by(on_disk(
      std::string(kMount) + kFill + "export TMPDIR=\"$0\" && exec \"$@\" >>\"$0/log\" 2>&1", {}));
  start_daemon_with_scenes({"office=" + scene_file("office") + ",occupancy=0.5"},
                           {"--config", file("camwayd.toml"), "--scene-roots", disk()});
  Client client(patient());
  const SceneAnswer refused = client.load_scene("world", long_mesh(200'000));
  EXPECT_EQ(refused.status, Status::kInvalid);
  EXPECT_THAT(refused.error, HasSubstr("no room"));
  const SceneAnswer unwritten = client.export_map_to("office", "office.bt");
  EXPECT_EQ(unwritten.status, Status::kInvalid);
  EXPECT_THAT(unwritten.error, AllOf(HasSubstr("office.bt"), HasSubstr("No space left")));
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(disk_of(daemon()))) {
    names.push_back(entry.path().filename());
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("filler", "log")) << "no half of anything";

  Pose aside;
  aside.position_m = {0, 50, 0};
  EXPECT_TRUE(client.plan(request_of("office-free-door", "office")).ok());
  EXPECT_TRUE(client.put_object("office", "crate", SceneBox{{1, 1, 1}}, aside).ok());

  ASSERT_TRUE(fs::remove(disk_of(daemon()) + "/filler"));
  EXPECT_TRUE(client.load_scene("world", long_mesh(200'000)).ok());
  EXPECT_TRUE(eventually([&] {
    return read_file(disk_of(daemon()) + "/log").find("scene=world") != std::string::npos;
  })) << "it logs again";
  const SceneAnswer written = client.export_map_to("office", "office.bt");
  EXPECT_TRUE(written.ok()) << written.error;
  EXPECT_EQ(fs::file_size(disk_of(daemon()) + "/office.bt"),
            client.export_map("office").bytes.size());
}

TEST_F(FullDiskTest, TheCommandsSaySoAndLeaveNothingBehind) {
  const auto is_clear = [](const std::string& file) {
    return AllOf(HasSubstr(file + ": cannot be written: No space left on device"),
                 HasSubstr("exit code 2\nfiller\n"), Not(HasSubstr("unfinished")));
  };
  const std::string answer = disk() + "/answer.json";
  EXPECT_THAT(said_on_full_disk({"plan", "--scene", scene_file("office"), "--request",
                                 request_file("office-free-door"), "--response", answer}),
              is_clear(answer));
  start_daemon();
  const std::string map = disk() + "/office.bt";
  EXPECT_THAT(said_on_full_disk({"scene", "export", "office", "--to", map}), is_clear(map));
}

/// LCM's logger ends when the disk is full. The complete part of its file is replayed, and the rest
/// is reported.
TEST_F(FullDiskTest, ARecordingThatWasCutShortIsReplayedAsFarAsItGoes) {
  start_daemon();
  const std::string recording = disk() + "/session.lcmlog";
  Process logger(
      on_disk(std::string(kMount) + "{ \"$@\" || cp \"$0/session.lcmlog\" \"$0/../cut.lcmlog\"; }",
              {LCM_LOGGER_BINARY, "--quiet", "--force", "--flush-interval=50", recording}),
      file("logger.log"));
  Client client(patient());
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(client.plan(request_of("office-graze-slalom", "office")).ok());
    return !logger.running();
  }));
  EXPECT_THAT(logger.output(), HasSubstr("No space left"));

  Process replay(
      {CAMWAY_BINARY, "replay", file("cut.lcmlog"), "--scene", "office=" + scene_file("office")},
      file("replay.log"));
  EXPECT_EQ(replay.wait(), 2) << replay.output();
  EXPECT_THAT(replay.output(), HasSubstr(" same, "));
}

}  // namespace
}  // namespace camway::integration
