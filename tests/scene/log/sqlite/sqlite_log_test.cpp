// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/sqlite_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sqlite3.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/scene/log/log_samples.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A log that a test closes and opens again.
class SqliteLogTest : public ::testing::Test {
 protected:
  void SetUp() override { reopen(); }

  void reopen(const SqliteLogLimits& limits = {}) {
    log_.reset();
    auto opened = SqliteLog::open(state(), limits);
    ASSERT_TRUE(opened) << opened.error;
    log_ = *std::move(opened);
  }
  [[nodiscard]] fs::path state() const { return folder_.path() / "var" / "state"; }
  [[nodiscard]] fs::path file() const { return state() / "scenes.sqlite"; }

  void append(std::string_view scene, const LogEntry& entry) {
    const AppendResult result = log_->append(scene, entry);
    EXPECT_EQ(result.fault, AppendFault::kNone) << result.error;
  }
  void put(const SampleBlob& sample) {
    const AppendResult result = log_->put_blob(sample.id, sample.blob);
    EXPECT_EQ(result.fault, AppendFault::kNone) << result.error;
  }
  std::string scenes() {
    const auto scenes = log_->scenes();
    return scenes ? text_of_scenes(*scenes) : "error: " + scenes.error;
  }
  /// Runs statements of another program on the file of the closed log.
  void tamper(const char* sql) {
    log_.reset();
    sqlite3* connection = nullptr;
    ASSERT_EQ(sqlite3_open(file().c_str(), &connection), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(connection);
    sqlite3_close(connection);
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<SqliteLog> log_;
};

TEST_F(SqliteLogTest, MakesAFolderThatOthersCannotRead) {
  struct stat status {};
  ASSERT_EQ(stat(state().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0700U);
  ASSERT_EQ(stat(file().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  EXPECT_EQ(scenes(), "");
  EXPECT_TRUE(SqliteLog::open(folder_.path() / "other" / "state" / "", {}));
  EXPECT_TRUE(fs::exists(folder_.path() / "other" / "state" / "scenes.sqlite"));
}

TEST_F(SqliteLogTest, KeepsEntriesInOrder) {
  append("b", sample_entry(0, 3, "made"));
  append("a", sample_entry(0, 4, ""));
  append("b", sample_entry(3, 10, "changed"));
  const std::string expected =
      "a at 0: \n  0 -> 4: \nb at 0: \n  0 -> 3: made\n  3 -> 10: changed\n";
  EXPECT_EQ(scenes(), expected);
  reopen();
  EXPECT_EQ(scenes(), expected);
}

TEST_F(SqliteLogTest, RefusesAnEntryOnAnotherRevision) {
  const AppendResult missing = log_->append("a", sample_entry(1, 2, ""));
  EXPECT_EQ(missing.fault, AppendFault::kConflict);
  EXPECT_EQ(missing.error, "there is no scene 'a'");
  append("a", sample_entry(0, 2, "made"));
  const std::string before = scenes();
  const AppendResult refused = log_->append("a", sample_entry(0, 3, "other"));
  EXPECT_EQ(refused.fault, AppendFault::kConflict);
  EXPECT_EQ(refused.error, "scene 'a' is at revision 2, not at 0");
  EXPECT_EQ(log_->append("a", sample_entry(2, 2, "same")).fault, AppendFault::kBroken);
  EXPECT_EQ(log_->append("a", sample_entry(2, ~std::uint64_t{0}, "")).fault, AppendFault::kBroken);
  EXPECT_EQ(scenes(), before);
  reopen();
  EXPECT_EQ(scenes(), before);
}

TEST_F(SqliteLogTest, KeepsNamesAndRecordsOfAllBytes) {
  const std::string name("nu\0l '\xff\xc3 \xe2\x82\xac", 12);
  append(name, sample_entry(0, 1, std::string("\0\xff\0", 3)));
  append(std::string("nu\0", 3), sample_entry(0, 1, "other"));
  reopen();
  const auto scenes = log_->scenes();
  ASSERT_TRUE(scenes) << scenes.error;
  ASSERT_EQ(scenes->size(), 2U);
  EXPECT_EQ(scenes->at(1).name, name);
  EXPECT_EQ(scenes->at(1).entries.at(0).record, log_bytes(std::string_view("\0\xff\0", 3)));
}

TEST_F(SqliteLogTest, ReplacesEntriesByASummary) {
  append("a", sample_entry(0, 2, "made"));
  append("a", sample_entry(2, 5, "moved"));
  append("a", sample_entry(5, 6, "turned"));
  EXPECT_EQ(log_->summarize("a", 4, log_bytes("s"), {}).fault, AppendFault::kConflict);
  EXPECT_EQ(log_->summarize("a", 7, log_bytes("s"), {}).fault, AppendFault::kConflict);
  EXPECT_EQ(log_->summarize("b", 5, log_bytes("s"), {}).fault, AppendFault::kConflict);
  EXPECT_EQ(log_->summarize("a", 5, log_bytes("both"), {}).fault, AppendFault::kNone);
  EXPECT_EQ(scenes(), "a at 5: both\n  5 -> 6: turned\n");
  reopen();
  EXPECT_EQ(scenes(), "a at 5: both\n  5 -> 6: turned\n");
  EXPECT_EQ(log_->summarize("a", 2, log_bytes("old"), {}).fault, AppendFault::kConflict);
  EXPECT_EQ(log_->summarize("a", 6, log_bytes("all"), {}).fault, AppendFault::kNone);
  EXPECT_EQ(log_->summarize("a", 6, log_bytes("all, shorter"), {}).fault, AppendFault::kNone);
  append("a", sample_entry(6, 7, "more"));
  reopen();
  EXPECT_EQ(scenes(), "a at 6: all, shorter\n  6 -> 7: more\n");
}

TEST_F(SqliteLogTest, RemembersTheHighestRevisionThatWasRemoved) {
  EXPECT_EQ(log_->highest_removed(), 0U);
  append("a", sample_entry(0, 9, ""));
  append("b", sample_entry(0, 4, ""));
  EXPECT_EQ(log_->remove("a", 8).fault, AppendFault::kConflict);
  EXPECT_EQ(log_->remove("c", 8).fault, AppendFault::kConflict);
  EXPECT_EQ(log_->remove("c", 0).fault, AppendFault::kConflict);
  EXPECT_EQ(log_->highest_removed(), 0U);
  EXPECT_EQ(log_->remove("a", 9).fault, AppendFault::kNone);
  EXPECT_EQ(log_->remove("b", 4).fault, AppendFault::kNone);
  EXPECT_EQ(log_->highest_removed(), 9U);
  reopen();
  EXPECT_EQ(log_->highest_removed(), 9U);
  EXPECT_EQ(scenes(), "");
  append("a", sample_entry(0, 10, "anew"));
  EXPECT_EQ(scenes(), "a at 0: \n  0 -> 10: anew\n");
}

TEST_F(SqliteLogTest, KeepsNotes) {
  EXPECT_EQ(log_->note("key"), "");
  EXPECT_EQ(log_->set_note("key", "first").fault, AppendFault::kNone);
  EXPECT_EQ(log_->set_note("key", "second").fault, AppendFault::kNone);
  EXPECT_EQ(log_->set_note("other", "third").fault, AppendFault::kNone);
  EXPECT_EQ(log_->set_note("other", "").fault, AppendFault::kNone);
  reopen();
  EXPECT_EQ(log_->note("key"), "second");
  EXPECT_EQ(log_->note("other"), "");
}

TEST_F(SqliteLogTest, ListsNotesByTheBeginOfTheirKeys) {
  ASSERT_EQ(log_->set_note("of one", "1").error, "");
  ASSERT_EQ(log_->set_note("of two", "2").error, "");
  ASSERT_EQ(log_->set_note("other", "3").error, "");
  const auto notes = log_->notes("of ");
  ASSERT_TRUE(notes) << notes.error;
  EXPECT_EQ(*notes, (std::map<std::string, std::string>{{"of one", "1"}, {"of two", "2"}}));
}

TEST_F(SqliteLogTest, RemembersTheRequestsOfRemovals) {
  for (const char* const scene : {"a", "b", "c"}) append(scene, sample_entry(0, 1, ""));
  EXPECT_EQ(log_->remove("a", 1, "first").error, "");
  EXPECT_EQ(log_->remove("b", 1).error, "");
  EXPECT_EQ(log_->remove("c", 2, "not made").fault, AppendFault::kConflict);
  EXPECT_EQ(log_->remove("c", 1, "second").error, "");
  reopen();
  EXPECT_EQ(log_->removals(), (std::vector<std::string>{"first", "second"}));
}

TEST_F(SqliteLogTest, KeepsBlobs) {
  const SampleBlob base("base");
  const SampleBlob empty("");
  const SampleBlob large(std::string(300'000, 'x'), {base.id, empty.id, base.id});
  EXPECT_FALSE(log_->has_blob(base.id));
  EXPECT_FALSE(log_->blob(base.id));
  EXPECT_EQ(log_->put_blob(large.id, large.blob).fault, AppendFault::kBroken) << "lacks its needs";
  put(base);
  put(empty);
  put(large);
  put(large);
  EXPECT_EQ(log_->append("a", sample_entry(0, 1, "", {SampleBlob("no").id})).fault,
            AppendFault::kBroken);
  EXPECT_EQ(scenes(), "");
  append("a", sample_entry(0, 1, "", {large.id}));
  reopen();
  EXPECT_TRUE(log_->has_blob(large.id));
  for (const SampleBlob& sample : {base, empty, large}) {
    const auto bytes = log_->blob(sample.id);
    ASSERT_TRUE(bytes) << bytes.error;
    EXPECT_EQ(*bytes, sample.blob.bytes);
  }
}

TEST_F(SqliteLogTest, DropsTheBlobsThatNothingNeeds) {
  const SampleBlob first("first");
  const SampleBlob second("second", {first.id});
  const SampleBlob third("third", {second.id});
  const SampleBlob unused("unused", {first.id});
  const SampleBlob of_summary("of summary");
  for (const SampleBlob& sample : {first, second, third, unused, of_summary}) put(sample);
  append("a", sample_entry(0, 1, "", {of_summary.id}));
  ASSERT_EQ(log_->summarize("a", 1, {}, {of_summary.id}).fault, AppendFault::kNone);
  append("a", sample_entry(1, 2, "", {third.id}));
  ASSERT_EQ(log_->drop_unused_blobs().fault, AppendFault::kNone);
  reopen();
  for (const SampleBlob& sample : {first, second, third, of_summary}) {
    EXPECT_TRUE(log_->has_blob(sample.id)) << log_text(sample.blob.bytes);
  }
  EXPECT_FALSE(log_->has_blob(unused.id));
  ASSERT_EQ(log_->summarize("a", 2, {}, {second.id}).fault, AppendFault::kNone);
  ASSERT_EQ(log_->drop_unused_blobs().fault, AppendFault::kNone);
  EXPECT_FALSE(log_->has_blob(third.id));
  EXPECT_FALSE(log_->has_blob(of_summary.id));
  EXPECT_TRUE(log_->has_blob(first.id));
  ASSERT_EQ(log_->remove("a", 2).fault, AppendFault::kNone);
  ASSERT_EQ(log_->drop_unused_blobs().fault, AppendFault::kNone);
  EXPECT_FALSE(log_->has_blob(first.id));
  EXPECT_FALSE(log_->has_blob(second.id));
  reopen();
  const auto checked = SqliteLog::check(file());
  ASSERT_TRUE(checked) << checked.error;
  EXPECT_EQ(checked->blobs, 0U);
}

TEST_F(SqliteLogTest, IsForOneProcess) {
  const auto second = SqliteLog::open(state(), {});
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error, AllOf(HasSubstr(state().string()), HasSubstr("another process")));
  log_.reset();
  EXPECT_TRUE(SqliteLog::open(state(), {}));
}

TEST_F(SqliteLogTest, IsReadWhileItChanges) {
  append("a", sample_entry(0, 1, "made"));
  const auto reader = SqliteLog::open_read_only(state());
  ASSERT_TRUE(reader) << reader.error;
  append("a", sample_entry(1, 2, "moved"));
  const auto seen = (*reader)->scenes();
  ASSERT_TRUE(seen) << seen.error;
  EXPECT_EQ(text_of_scenes(*seen), scenes());
  const auto checked = SqliteLog::check(file());
  ASSERT_TRUE(checked) << checked.error;
  EXPECT_EQ(checked->entries, 2U);
  EXPECT_EQ((*reader)->append("a", sample_entry(2, 3, "")).fault, AppendFault::kBroken);
  EXPECT_EQ((*reader)->set_note("a", "b").fault, AppendFault::kBroken);
  EXPECT_FALSE(SqliteLog::open_read_only(folder_.path() / "none"));
  EXPECT_FALSE(fs::exists(folder_.path() / "none"));
}

TEST_F(SqliteLogTest, IsExportedIntoOneFileThatIsALog) {
  const SampleBlob mesh("mesh");
  put(mesh);
  append("a", sample_entry(0, 1, "made", {mesh.id}));
  ASSERT_EQ(log_->set_note("key", "text").fault, AppendFault::kNone);
  const fs::path target = folder_.path() / "export";
  EXPECT_EQ(log_->export_to(target), "");
  EXPECT_THAT(log_->export_to(target), HasSubstr("there already"));
  EXPECT_THAT(log_->export_to(folder_.path() / "none" / "export"), HasSubstr("No such file"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2) << "files were left";
  const auto checked = SqliteLog::check(target);
  ASSERT_TRUE(checked) << checked.error;
  EXPECT_EQ(checked->blob_bytes, 4U);
  const std::string before = scenes();
  append("a", sample_entry(1, 2, "moved"));
  log_.reset();
  EXPECT_THAT(SqliteLog::restore(target, file().parent_path()), HasSubstr("is there already"));
  fs::rename(file().parent_path(), folder_.path() / "aside");
  EXPECT_EQ(SqliteLog::restore(target, file().parent_path()), "");
  reopen();
  EXPECT_EQ(scenes(), before);
  EXPECT_EQ(log_->note("key"), "text");
  append("a", sample_entry(1, 2, "moved"));
}

/// Returns a copy of the folder as a killed process leaves it: most changes are in the `-wal`.
fs::path copy_of_folder(const fs::path& from, const fs::path& to) {
  fs::copy(from, to);
  return to;
}

TEST_F(SqliteLogTest, NoticesChangesThatAreLostBesideIt) {
  for (std::uint64_t i = 0; i < 5; ++i) append("a", sample_entry(i, i + 1, "changed"));
  const fs::path state = file().parent_path();
  const auto opened = [](const fs::path& folder) { return SqliteLog::open(folder, {}).error; };
  EXPECT_EQ(opened(copy_of_folder(state, folder_.path() / "whole")), "");
  const fs::path without = copy_of_folder(state, folder_.path() / "without");
  fs::remove(without / "scenes.sqlite-wal");
  EXPECT_THAT(SqliteLog::check(SqliteLog::file_of(without)).error,
              HasSubstr("5 of 5 changes that were answered are missing"));
  EXPECT_THAT(opened(without), HasSubstr("5 of 5 changes that were answered are missing"));
  const fs::path alone = folder_.path() / "alone";
  fs::create_directory(alone);
  fs::copy_file(state / "scenes.sqlite", alone / "scenes.sqlite");
  fs::copy_file(state / "scenes.sqlite-wal", alone / "scenes.sqlite-wal");
  EXPECT_THAT(opened(alone), HasSubstr("not copied as a whole"));
  const auto whole_size = fs::file_size(state / "scenes.sqlite-wal");
  for (int cut = 1; cut <= 3; ++cut) {
    const fs::path damaged = copy_of_folder(state, folder_.path() / ("cut" + std::to_string(cut)));
    fs::resize_file(damaged / "scenes.sqlite-wal",
                    whole_size - static_cast<std::uintmax_t>(cut) * 5000);
    EXPECT_THAT(opened(damaged), HasSubstr("changes that were answered are missing")) << cut;
  }
  const fs::path gone = copy_of_folder(state, folder_.path() / "gone");
  for (const char* const name : {"scenes.sqlite", "scenes.sqlite-wal", "scenes.sqlite-shm"}) {
    fs::remove(gone / name);
  }
  EXPECT_THAT(opened(gone), HasSubstr("is missing, but changes were answered"));
}

TEST_F(SqliteLogTest, SaysSoIfItsFilesAreReplacedWhileItIsInUse) {
  append("a", sample_entry(0, 1, "made"));
  const fs::path state = file().parent_path();
  fs::rename(state, folder_.path() / "aside");
  const AppendResult gone = log_->append("a", sample_entry(1, 2, "moved"));
  EXPECT_EQ(gone.fault, AppendFault::kBroken);
  EXPECT_THAT(gone.error, HasSubstr("removed or replaced"));
  fs::rename(folder_.path() / "aside", state);
  EXPECT_EQ(log_->append("a", sample_entry(1, 2, "moved")).error, "");
  fs::rename(state / "scenes.sqlite-wal", folder_.path() / "wal");
  EXPECT_THAT(log_->append("a", sample_entry(2, 3, "moved")).error,
              HasSubstr("removed or replaced"));
}

TEST_F(SqliteLogTest, IsForManyThreads) {
  constexpr int kThreads = 4;
  constexpr std::uint64_t kAppends = 25;
  std::atomic<int> appended = 0;
  {
    std::vector<std::jthread> threads;
    threads.reserve(kThreads);
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([&, i] {
        for (std::uint64_t revision = 0; revision < kAppends; ++revision) {
          const LogEntry own = sample_entry(revision, revision + 1, "own");
          const bool is_own = log_->append(std::to_string(i), own).fault == AppendFault::kNone;
          const LogEntry shared = sample_entry(revision, revision + 1, "shared");
          if (log_->append("shared", shared).fault == AppendFault::kNone && is_own) ++appended;
          EXPECT_TRUE(log_->scenes());
        }
      });
    }
  }
  EXPECT_LE(appended, kThreads * static_cast<int>(kAppends));
  const auto scenes = log_->scenes();
  ASSERT_TRUE(scenes) << scenes.error;
  ASSERT_EQ(scenes->size(), 5U);
  for (const LoggedScene& scene : *scenes) EXPECT_LE(scene.entries.size(), kAppends);
}

TEST_F(SqliteLogTest, RefusesANewerVersion) {
  tamper("PRAGMA user_version=2");
  for (const auto& opened :
       {SqliteLog::open(state(), {}).error, SqliteLog::open_read_only(state()).error,
        SqliteLog::check(file()).error}) {
    EXPECT_THAT(opened, AllOf(HasSubstr(state().string()), HasSubstr("version 2")));
  }
}

TEST_F(SqliteLogTest, RefusesOtherFiles) {
  tamper("PRAGMA application_id=7");
  EXPECT_THAT(SqliteLog::open(state(), {}).error, HasSubstr("nothing that camwayd wrote"));
  std::ofstream(file()) << "no database, but a text of some length that SQLite cannot read";
  EXPECT_THAT(SqliteLog::open(state(), {}).error, HasSubstr("is damaged"));
  fs::resize_file(file(), 0);
  EXPECT_THAT(SqliteLog::open(state(), {}).error, HasSubstr("is damaged"));
  EXPECT_THAT(SqliteLog::check(file()).error, HasSubstr("is damaged"));
  fs::remove(file());
  std::ofstream(file().string() + "-wal") << "changes";
  EXPECT_THAT(SqliteLog::open(state(), {}).error, HasSubstr("scenes.sqlite is missing"));
}

TEST_F(SqliteLogTest, BeginsAnewWhereItsMakingWasInterrupted) {
  log_.reset();
  fs::remove(file());
  std::ofstream(file().string() + ".new") << "half";
  std::ofstream(file().string() + ".new-journal") << "half";
  reopen();
  EXPECT_EQ(scenes(), "");
}

/// A statement of another program on the file, and the error of the log after it.
struct LostRow {
  const char* sql;
  const char* error;
};

constexpr LostRow kLostRows[] = {
    {"DELETE FROM entries WHERE revision=7",
     "scene 'a' lost its changes after revision 5 until "
     "revision 7"},
    {"DELETE FROM entries WHERE revision=9", "lost its changes after revision 7 until revision 9"},
    {"DELETE FROM entries", "lost its changes after revision 5 until revision 9"},
    {"DELETE FROM summaries", "lost its changes after revision 0 until revision 5"},
    {"DELETE FROM entries; DELETE FROM summaries", "lost its changes after revision 0 until"},
    {"DELETE FROM heads", "lost the number of its newest revision"},
    {"UPDATE heads SET revision=7", "lost its changes"},
    {"UPDATE entries SET record=x'00' WHERE revision=7", "a damaged change to revision 7"},
    {"UPDATE entries SET before=6 WHERE revision=7", "a damaged change to revision 7"},
    {"UPDATE entries SET digest=x'00' WHERE revision=7", "a damaged change to revision 7"},
    {"UPDATE entries SET scene='b'; UPDATE heads SET scene='b'", "scene 'b' has a damaged change"},
    {"DELETE FROM entry_needs", "a damaged change to revision 9"},
    {"UPDATE entry_needs SET blob=x'00'", "another type"},
    {"UPDATE summaries SET record=x'00'", "a damaged summary of revision 5"},
    {"DELETE FROM summary_needs", "a damaged summary of revision 5"},
    {"DELETE FROM blobs WHERE size=4", "lost a mesh or map of its summary of revision 5"},
    {"DELETE FROM blobs WHERE size=10", "lost a mesh or map of revision 9"},
    {"DELETE FROM blobs WHERE size=1", "lost another one"},
    {"DELETE FROM notes; INSERT INTO notes VALUES('key', 'text', x'00')", "the note 'key'"},
    {"DELETE FROM meta", "the highest revision of removed scenes is lost"},
    {"UPDATE meta SET value=0", "the highest revision of removed scenes is lost"}};

TEST_F(SqliteLogTest, RefusesALogThatLostRows) {
  const SampleBlob of_summary("mesh");
  const SampleBlob base("-");
  const SampleBlob difference("difference", {base.id});
  for (const SampleBlob& sample : {of_summary, base, difference}) put(sample);
  append("removed", sample_entry(0, 5, ""));
  ASSERT_EQ(log_->remove("removed", 5).fault, AppendFault::kNone);
  append("a", sample_entry(0, 5, ""));
  ASSERT_EQ(log_->summarize("a", 5, log_bytes("s"), {of_summary.id}).fault, AppendFault::kNone);
  append("a", sample_entry(5, 7, "record"));
  append("a", sample_entry(7, 9, "record", {difference.id}));
  log_.reset();
  const fs::path intact = folder_.path() / "intact";
  fs::copy_file(file(), intact);
  for (const LostRow& lost : kLostRows) {
    SCOPED_TRACE(lost.sql);
    fs::copy_file(intact, file(), fs::copy_options::overwrite_existing);
    tamper(lost.sql);
    auto opened = SqliteLog::open(state(), {});
    const std::string error = opened ? (*opened)->scenes().error : opened.error;
    EXPECT_THAT(error, AllOf(HasSubstr("the state in " + state().string() + " is damaged: "),
                             HasSubstr(lost.error), HasSubstr("camway state restore")));
    opened = base::Failure{"closed"};
    EXPECT_THAT(SqliteLog::check(file()).error, HasSubstr("is damaged"));
  }
}

TEST_F(SqliteLogTest, RefusesBlobsWithOtherBytes) {
  const SampleBlob mesh("mesh");
  put(mesh);
  append("a", sample_entry(0, 1, "", {mesh.id}));
  for (const char* const sql : {"UPDATE blobs SET bytes=CAST('mush' AS BLOB)",
                                "UPDATE blobs SET bytes=CAST('mesh' AS BLOB), size=5"}) {
    tamper(sql);
    reopen();
    EXPECT_TRUE(log_->scenes());
    const auto bytes = log_->blob(mesh.id);
    ASSERT_FALSE(bytes);
    EXPECT_THAT(bytes.error, HasSubstr("bytes is damaged"));
    EXPECT_THAT(SqliteLog::check(file()).error, HasSubstr("bytes is damaged, which scene 'a' needs"));
    EXPECT_THAT(log_->export_to(folder_.path() / "export"), HasSubstr("bytes is damaged"));
    EXPECT_FALSE(fs::exists(folder_.path() / "export"));
  }
}

/// Appends until there is no room, and returns the fault.
AppendResult fill_log(SqliteLog& log, std::uint64_t& revision) {
  const std::string record(2000, 'r');
  for (;;) {
    AppendResult result = log.append("a", sample_entry(revision, revision + 1, record));
    if (result.fault != AppendFault::kNone) return result;
    ++revision;
  }
}

TEST_F(SqliteLogTest, TellsWhenItsLimitIsReached) {
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

TEST_F(SqliteLogTest, RefusesWhatIsLargerThanARow) {
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

TEST_F(SqliteLogTest, RemovesAndSummarizesAtItsLimit) {
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

TEST_F(SqliteLogTest, GoesOnWhenAFullDiskHasRoomAgain) {
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

TEST_F(SqliteLogTest, IsCheckedOnAMediumThatIsReadOnly) {
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
