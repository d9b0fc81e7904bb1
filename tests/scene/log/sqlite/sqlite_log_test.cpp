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
#include "tests/scene/log/sqlite/sqlite_log_fixture.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

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
    EXPECT_THAT(SqliteLog::check(file()).error,
                HasSubstr("bytes is damaged, which scene 'a' needs"));
    EXPECT_THAT(log_->export_to(folder_.path() / "export"), HasSubstr("bytes is damaged"));
    EXPECT_FALSE(fs::exists(folder_.path() / "export"));
  }
}

}  // namespace
}  // namespace camway::scene
