// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "daemon/base/file_descriptor.h"
#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "tests/scene/log/log_samples.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kKillSeed = 977;

/// Returns how often a test kills: `usual`, or what CAMWAY_KILLS says.
int kills(int usual) {
  const char* const said = std::getenv("CAMWAY_KILLS");
  return said == nullptr ? usual : std::atoi(said);
}

constexpr const char* kKilledScene = "office";

std::string killed_record(std::uint64_t revision) {
  return std::to_string(revision) + " " + std::string(revision % 7 == 0 ? 12'000 : 200, 'r');
}

/// Appends entries until it is killed, and writes the revision of each into a pipe when it is
/// appended. Now and then it makes a summary, and a blob that nothing needs.
[[noreturn]] void append_until_killed(const std::filesystem::path& folder, std::uint64_t revision,
                                      int acknowledgements) {
  auto log = SqliteLog::open(folder, {});
  if (!log) _exit(1);
  for (;;) {
    const SampleBlob blob(killed_record(revision));
    const LogEntry entry =
        sample_entry(revision, revision + 1, killed_record(revision + 1), {blob.id});
    if ((*log)->put_blob(blob.id, blob.blob).fault != AppendFault::kNone) _exit(2);
    if ((*log)->append(kKilledScene, entry).fault != AppendFault::kNone) _exit(3);
    ++revision;
    if (write(acknowledgements, &revision, sizeof revision) != sizeof revision) _exit(4);
    if (revision % 20 != 0) continue;
    const Bytes summary = log_bytes(killed_record(revision));
    if ((*log)->summarize(kKilledScene, revision, summary, {}).fault != AppendFault::kNone ||
        (*log)->drop_unused_blobs().fault != AppendFault::kNone) {
      _exit(5);
    }
  }
}

/// Starts a child, kills it some time after a number of appends, and returns the last revision that
/// it acknowledged.
std::uint64_t kill_after(const std::filesystem::path& folder, std::uint64_t revision, int appends,
                         double time_us) {
  int ends[2] = {-1, -1};
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    append_until_killed(folder, revision, ends[1]);
  }
  close(ends[1]);
  const base::FileDescriptor acknowledgements(ends[0]);
  for (int i = 0; i < appends; ++i) {
    EXPECT_EQ(read(acknowledgements.get(), &revision, sizeof revision), ssize_t(sizeof revision));
  }
  usleep(static_cast<useconds_t>(time_us));
  EXPECT_EQ(kill(child, SIGKILL), 0);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself with " << WEXITSTATUS(status);
  while (read(acknowledgements.get(), &revision, sizeof revision) == sizeof revision) {
  }
  return revision;
}

/// Returns the newest revision of the scene, whose records are those that were appended.
std::uint64_t verified_revision(SceneLog& log) {
  const auto scenes = log.scenes();
  EXPECT_TRUE(scenes) << scenes.error;
  if (!scenes || scenes->empty()) return 0;
  const LoggedScene& scene = scenes->front();
  if (scene.summary_revision > 0) {
    EXPECT_EQ(log_text(scene.summary), killed_record(scene.summary_revision));
  }
  std::uint64_t revision = scene.summary_revision;
  for (const LogEntry& entry : scene.entries) {
    EXPECT_EQ(entry.revision, ++revision);
    EXPECT_EQ(log_text(entry.record), killed_record(revision));
    for (const BlobId& id : entry.needs) EXPECT_TRUE(log.blob(id));
  }
  return revision;
}

TEST(SqliteLogKill, LosesNothingThatWasAcknowledged) {
  const int kills_wanted = kills(60);
  testing::Random random(kKillSeed);
  const testing::TemporaryFolder folder;
  std::uint64_t revision = 0;
  for (int i = 0; i < kills_wanted; ++i) {
    SCOPED_TRACE("kill " + std::to_string(i));
    const int appends = random.integer(0, 40);
    const double time_us = random.uniform(0.0, 3000.0);
    const std::uint64_t acknowledged = kill_after(folder.path(), revision, appends, time_us);
    // Most logs are opened by the next child, with all that the last one left.
    const auto log =
        i % 10 == 9 ? SqliteLog::open(folder.path(), {}) : SqliteLog::open_read_only(folder.path());
    if (!log && acknowledged == 0) continue;  // killed before it made the log
    ASSERT_TRUE(log) << log.error;
    revision = verified_revision(**log);
    ASSERT_GE(revision, acknowledged);
    ASSERT_LE(revision, acknowledged + 1);
  }
  const auto checked = SqliteLog::check(folder.path() / "scenes.sqlite");
  EXPECT_TRUE(checked) << checked.error;
}

TEST(SqliteLogKill, MakesALogAtOnceOrNotAtAll) {
  const int kills_wanted = kills(40);
  testing::Random random(kKillSeed + 1);
  for (int i = 0; i < kills_wanted; ++i) {
    const testing::TemporaryFolder folder;
    const double time_us = random.uniform(0.0, 8000.0);
    const std::uint64_t acknowledged = kill_after(folder.path(), 0, 0, time_us);
    const auto log = SqliteLog::open(folder.path(), {});
    ASSERT_TRUE(log) << log.error;
    const std::uint64_t revision = verified_revision(**log);
    ASSERT_GE(revision, acknowledged);
    ASSERT_LE(revision, acknowledged + 1);
  }
}

}  // namespace
}  // namespace camway::scene
