// SPDX-License-Identifier: MIT
//
// Logs that have no room left, or cannot be written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "tests/scene/log/log_samples.h"
#include "tests/scene/log/sqlite/sqlite_log_fixture.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

using SqliteLogLimitsTest = SqliteLogTest;

/// Appends until there is no room, and returns the fault.
AppendResult fill_log(SqliteLog& log, std::uint64_t& revision) {
  const std::string record(2000, 'r');
  for (;;) {
    AppendResult result = log.append("a", sample_entry(revision, revision + 1, record));
    if (result.fault != AppendFault::kNone) return result;
    ++revision;
  }
}

TEST_F(SqliteLogLimitsTest, TellsWhenItsLimitIsReached) {
  constexpr std::uint64_t kLimit = 200'000;
  reopen({.most_bytes = kLimit});
  std::uint64_t revision = 0;
  const AppendResult full = fill_log(*log_, revision);
  EXPECT_EQ(full.fault, AppendFault::kFull);
  EXPECT_THAT(full.error, AllOf(HasSubstr(state().string()), HasSubstr("state.most_bytes")));
  EXPECT_GT(revision, 20U);
  const std::string before = scenes();
  EXPECT_THAT(before, HasSubstr("-> " + std::to_string(revision) + ":"));
  const SampleBlob blob(std::string(100'000, 'b'));
  EXPECT_EQ(log_->put_blob(blob.id, blob.blob).fault, AppendFault::kFull);
  EXPECT_FALSE(log_->has_blob(blob.id));
  EXPECT_EQ(scenes(), before);
  reopen({.most_bytes = kLimit});
  EXPECT_LE(fs::file_size(file()), kLimit + SqliteLog::kReserveBytes);
  EXPECT_EQ(scenes(), before);
  ASSERT_EQ(log_->summarize("a", revision, log_bytes("s"), {}).fault, AppendFault::kNone);
  append("a", sample_entry(revision, revision + 1, "after"));
  put(blob);
  ++revision;
  EXPECT_EQ(fill_log(*log_, revision).fault, AppendFault::kFull);
  reopen({.most_bytes = 2 * kLimit});
  append("a", sample_entry(revision, revision + 1, "more"));
}

TEST_F(SqliteLogLimitsTest, RefusesWhatIsLargerThanARow) {
  reopen({.most_blob_bytes = 1000});
  const SampleBlob fits(std::string(1000, 'b'));
  const SampleBlob too_large(std::string(1001, 'b'));
  put(fits);
  const AppendResult refused = log_->put_blob(too_large.id, too_large.blob);
  EXPECT_EQ(refused.fault, AppendFault::kFull);
  EXPECT_THAT(refused.error, AllOf(HasSubstr(state().string()), HasSubstr("1001 bytes")));
  const LogEntry entry{0, 1, too_large.blob.bytes, {}};
  EXPECT_EQ(log_->append("a", entry).fault, AppendFault::kFull);
  append("a", sample_entry(0, 1, "", {fits.id}));
  EXPECT_EQ(log_->summarize("a", 1, too_large.blob.bytes, {}).fault, AppendFault::kFull);
}

/// A small file system of its own, until the destructor.
class TinyDisk {
 public:
  explicit TinyDisk(fs::path folder) : folder_(std::move(folder)) {
    fs::create_directories(folder_);
    is_mounted_ = unshare(CLONE_NEWNS) == 0 &&
                  mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                  mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=1m") == 0;
  }
  ~TinyDisk() {
    if (is_mounted_) umount2(folder_.c_str(), MNT_DETACH);
  }
  TinyDisk(const TinyDisk&) = delete;
  TinyDisk& operator=(const TinyDisk&) = delete;
  [[nodiscard]] bool is_mounted() const { return is_mounted_; }

 private:
  fs::path folder_;
  bool is_mounted_ = false;
};

TEST_F(SqliteLogLimitsTest, RemovesAndSummarizesAtItsLimit) {
  constexpr std::uint64_t kLimit = 2'000'000;
  reopen({.most_bytes = kLimit});
  std::uint64_t revision = 0;
  AppendResult full;
  while (full.fault == AppendFault::kNone) {
    const SampleBlob mesh(std::to_string(revision) + std::string(50'000, 'm'));
    full = log_->put_blob(mesh.id, mesh.blob);
    if (full.fault != AppendFault::kNone) break;
    full = log_->append("a", sample_entry(revision, revision + 1, "mesh", {mesh.id}));
    if (full.fault == AppendFault::kNone) ++revision;
  }
  EXPECT_EQ(full.fault, AppendFault::kFull);
  ASSERT_GT(revision, 10U);
  // As removals of objects: more than the pages that happen to have room take.
  for (int i = 0; i < 100; ++i, ++revision) {
    ASSERT_EQ(log_->append("a", sample_entry(revision, revision + 1, std::string(500, 'r'))).error,
              "");
  }
  EXPECT_EQ(log_->summarize("a", revision, log_bytes(std::string(20'000, 's')), {}).error, "");
  EXPECT_EQ(log_->append("b", sample_entry(0, 1, "b")).error, "");
  EXPECT_EQ(log_->remove("a", revision).error, "");
  EXPECT_EQ(log_->drop_unused_blobs().error, "");
  const SampleBlob mesh(std::string(1'000'000, 'n'));
  EXPECT_EQ(log_->put_blob(mesh.id, mesh.blob).error, "");
  EXPECT_EQ(log_->append("b", sample_entry(1, 2, "b", {mesh.id})).error, "");
}

TEST_F(SqliteLogLimitsTest, GoesOnWhenAFullDiskHasRoomAgain) {
  log_.reset();
  fs::remove_all(state());
  const TinyDisk disk(state());
  if (!disk.is_mounted()) GTEST_SKIP() << "this user cannot mount a file system";
  const fs::path ballast = state() / "ballast";
  std::ofstream(ballast) << std::string(400'000, 'x');
  reopen();
  std::uint64_t revision = 0;
  for (int round = 0; round < 3; ++round) {
    const AppendResult full = fill_log(*log_, revision);
    EXPECT_EQ(full.fault, AppendFault::kFull) << full.error;
    EXPECT_THAT(full.error, HasSubstr(state().string()));
    const std::string before = scenes();
    EXPECT_THAT(before, HasSubstr("-> " + std::to_string(revision) + ":"));
    if (round == 1) fs::remove(ballast);
    if (round == 2) break;
    if (round == 1) append("a", sample_entry(revision, revision + 1, "there is room"));
    if (round == 1) ++revision;
    reopen();
  }
  const std::string last = scenes();
  reopen();
  EXPECT_EQ(scenes(), last);
}

TEST_F(SqliteLogLimitsTest, IsCheckedOnAMediumThatIsReadOnly) {
  append("a", sample_entry(0, 1, "made"));
  const fs::path medium = folder_.path() / "medium";
  const TinyDisk disk(medium);
  if (!disk.is_mounted()) GTEST_SKIP() << "this user cannot mount a file system";
  log_.reset();
  fs::copy_file(file(), medium / "scenes.sqlite");
  fs::copy_file(state() / "commits", medium / "commits");
  ASSERT_EQ(mount(nullptr, medium.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  const auto checked = SqliteLog::check(medium / "scenes.sqlite");
  ASSERT_TRUE(checked) << checked.error;
  EXPECT_EQ(checked->entries, 1U);
  const auto reader = SqliteLog::open_read_only(medium);
  ASSERT_TRUE(reader) << reader.error;
  EXPECT_EQ((*reader)->scenes()->size(), 1U);
}

}  // namespace
}  // namespace camway::scene
