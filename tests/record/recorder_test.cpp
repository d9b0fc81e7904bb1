// SPDX-License-Identifier: MIT
#include "daemon/record/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "daemon/record/event_log.h"
#include "daemon/record/recording_journal.h"
#include "daemon/record/session_events.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/support/captured_log.h"
#include "tests/support/small_disk.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::record {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kChannel[] = "CAMWAY_TEST";

std::vector<fs::path> logs_of(const fs::path& folder) {
  std::vector<fs::path> logs;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == kLogEnding) logs.push_back(entry.path());
  }
  std::ranges::sort(logs);
  return logs;
}

std::size_t blobs_in(const fs::path& folder) {
  if (!fs::exists(folder / kBlobFolder)) return 0;
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder / kBlobFolder), fs::directory_iterator()));
}

std::uint64_t bytes_below(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

/// The messages and events of a file.
struct Read {
  std::vector<std::string> messages;
  std::vector<SessionEvent> events;
};

Read read(const fs::path& log) {
  Read read;
  const LogSummary summary = read_event_log(log, [&](LogEvent&& event) {
    if (event.channel == kChannel) {
      read.messages.emplace_back(event.data.begin(), event.data.end());
      return;
    }
    EXPECT_EQ(event.channel, "CAMWAY_SESSION");
    base::Result<SessionEvent> session = session_event_from(event.data);
    ASSERT_TRUE(session) << session.error;
    read.events.push_back(*std::move(session));
  });
  EXPECT_EQ(summary.damage, "");
  return read;
}

template <class Event>
std::vector<Event> all(const std::vector<SessionEvent>& events) {
  std::vector<Event> found;
  for (const SessionEvent& event : events) {
    if (const auto* const each = std::get_if<Event>(&event)) found.push_back(*each);
  }
  return found;
}

/// Sums up the omissions of all files of a folder.
Omission missing_in(const fs::path& folder) {
  Omission sum;
  for (const fs::path& log : logs_of(folder)) {
    for (const Omission& omission : all<Omission>(read(log).events)) {
      sum.messages += omission.messages;
      sum.changes += omission.changes;
    }
  }
  return sum;
}

class RecorderTest : public ::testing::Test {
 protected:
  std::unique_ptr<Recorder> open(RecordOptions options) {
    if (options.folder.empty()) options.folder = folder_.path() / "recorded";
    options.pause = std::chrono::milliseconds(0);
    auto opened = Recorder::open(options, {"build 1", {{"queue.requests", "7"}}}, log_.log());
    EXPECT_TRUE(opened) << opened.error;
    return opened ? *std::move(opened) : nullptr;
  }

  static void say(Recorder& recorder, const std::string& text) {
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    recorder.message(kChannel, bytes);
  }

  static std::shared_ptr<const scene::Snapshot> wall() {
    return scene::make_snapshot("wall", tools::wall_mesh()).snapshot;
  }

  static scene::SceneChange box(double size_m) {
    scene::Mesh mesh = *scene::box_mesh({size_m, size_m, size_m});
    scene::ImportReport report = scene::report_of(mesh, "box");
    return {scene::SceneChange::Kind::kPut,
            "box",
            scene::make_source(scene::ObjectKind::kBox, std::move(mesh), std::move(report), {}),
            {}};
  }

  [[nodiscard]] fs::path recorded() const { return folder_.path() / "recorded"; }

  testing::TemporaryFolder folder_;
  testing::CapturedLog log_;
};

TEST_F(RecorderTest, EachFileBeginsWithTheScenesAndNoMessageIsLost) {
  RecordOptions options;
  options.limits.file_bytes = 1 << 14;
  const auto recorder = open(options);
  RecordingJournal journal(nullptr, *recorder);
  scene::SceneStore store({}, &journal);
  ASSERT_TRUE(store.put(wall()).snapshot);
  std::vector<std::string> said;
  for (int i = 0; i < 400; ++i) {
    said.push_back(std::to_string(i) + std::string(500, 'x'));
    say(*recorder, said.back());
    if (i % 40 == 0) {
      ASSERT_TRUE(store.change("wall", box(1.0 + i)).snapshot);
    }
  }
  recorder->finish();
  EXPECT_EQ(recorder->counts().dropped, 0U);
  EXPECT_EQ(recorder->counts().recorded, 400U + 11U);

  std::vector<std::string> heard;
  std::uint64_t part = 0;
  std::uint64_t revision = 1;
  for (const fs::path& log : logs_of(recorded())) {
    // However many messages are written together, the last one alone may be beyond the limit.
    constexpr std::uint64_t kLongestEvent = 2048;
    EXPECT_LE(fs::file_size(log), options.limits.file_bytes + kLongestEvent);
    const Read file = read(log);
    heard.insert(heard.end(), file.messages.begin(), file.messages.end());
    const auto* const begin = std::get_if<FileBegin>(&file.events.front());
    ASSERT_NE(begin, nullptr);
    EXPECT_EQ(begin->part, ++part);
    EXPECT_EQ(begin->version, "build 1");
    EXPECT_EQ(begin->settings.at("queue.requests"), "7");
    const auto updates = all<SceneUpdate>(file.events);
    ASSERT_FALSE(updates.empty());
    // The first one is the whole scene as the file before has left it.
    EXPECT_EQ(updates.front().update.entry.revision, revision);
    EXPECT_EQ(updates.front().update.entry.before, updates.front().update.entry.revision);
    revision = updates.back().update.entry.revision;
    EXPECT_TRUE(all<Omission>(file.events).empty());
  }
  EXPECT_GT(part, 4U);
  EXPECT_EQ(heard, said);
  EXPECT_EQ(revision, store.find("wall")->revision);
}

TEST_F(RecorderTest, RemovesOldFilesAndWhatTheyAloneNeed) {
  RecordOptions options;
  options.limits.file_bytes = 1 << 14;
  options.limits.most_bytes = 1 << 17;
  const auto recorder = open(options);
  scene::SceneStore store;
  store.put(wall());
  store.change("wall", box(9.0));
  recorder->scene_put(*store.find("wall"), {});
  store.change("wall", box(2.0));
  recorder->scene_put(*store.find("wall"), {});
  ASSERT_TRUE(integration::eventually([&] { return recorder->counts().recorded == 2; }));
  EXPECT_EQ(blobs_in(recorded()), 3U);
  for (const fs::directory_entry& blob : fs::directory_iterator(recorded() / kBlobFolder)) {
    fs::last_write_time(blob.path(), blob.last_write_time() - std::chrono::hours(1));
  }
  for (int i = 0; i < 1000; ++i) {
    say(*recorder, std::to_string(i) + std::string(1000, 'x'));
    while (i % 8 == 0 && recorder->counts().recorded < static_cast<std::uint64_t>(i)) {
      std::this_thread::yield();
    }
  }
  recorder->finish();
  EXPECT_EQ(recorder->counts().dropped, 0U);
  EXPECT_LE(bytes_below(recorded()), options.limits.most_bytes);
  const auto logs = logs_of(recorded());
  EXPECT_EQ(read(logs.back()).messages.back().substr(0, 3), "999");
  EXPECT_GT(all<FileBegin>(read(logs.front()).events).front().part, 1U);
  EXPECT_EQ(blobs_in(recorded()), 2U) << "the larger box is gone";
  // The blobs that the scenes of the last file need are there.
  for (const SceneUpdate& update : all<SceneUpdate>(read(logs.back()).events)) {
    for (const scene::BlobId& id : update.update.entry.needs) {
      EXPECT_TRUE(BlobFolder(recorded() / kBlobFolder).get(id));
    }
  }
}

TEST_F(RecorderTest, SaysWhatWasLostOnAFullDiskAndGoesOn) {
  const testing::SmallDisk disk(512);
  if (!disk.is_there()) GTEST_SKIP() << "mounting is not allowed here";
  RecordOptions options;
  options.folder = disk.path() / "recorded";
  options.trouble.calm = std::chrono::milliseconds(0);
  const auto recorder = open(options);
  ASSERT_NE(recorder, nullptr);
  RecordingJournal journal(nullptr, *recorder);
  scene::SceneStore store({}, &journal);
  store.put(wall());
  say(*recorder, "before");
  ASSERT_TRUE(integration::eventually([&] { return recorder->counts().recorded == 2; }));
  disk.fill();
  for (int i = 0; i < 50; ++i) say(*recorder, std::string(5000, 'x'));
  store.change("wall", box(1.0));
  ASSERT_TRUE(integration::eventually([&] { return recorder->counts().dropped > 1; }));
  EXPECT_THAT(recorder->counts().trouble, HasSubstr("No space left"));
  disk.make_room();
  ASSERT_TRUE(integration::eventually([&] {
    say(*recorder, "after");
    return recorder->counts().trouble.empty();
  }));
  recorder->finish();
  const RecordCounts counts = recorder->counts();
  const Omission missing = missing_in(options.folder);
  EXPECT_EQ(missing.messages + missing.changes, counts.dropped);
  EXPECT_EQ(missing.changes, 1U);
  const Read file = read(logs_of(options.folder).back());
  EXPECT_EQ(file.messages.front(), "before");
  EXPECT_EQ(file.messages.back(), "after");
  // The scene follows as a whole, with the change that was lost.
  const SceneUpdate last = all<SceneUpdate>(file.events).back();
  EXPECT_EQ(last.update.entry.revision, store.find("wall")->revision);
  EXPECT_EQ(last.digest, store.find("wall")->digest);
  const std::string lines = log_.text();
  EXPECT_THAT(lines, AllOf(HasSubstr("warning not all is recorded"), HasSubstr("No space left"),
                           HasSubstr("info the recording goes on")));
  EXPECT_EQ(lines.find("warning"), lines.rfind("warning")) << lines;
}

TEST_F(RecorderTest, SaysOnceThatADiskHoversAtFull) {
  const testing::SmallDisk disk(512);
  if (!disk.is_there()) GTEST_SKIP() << "mounting is not allowed here";
  RecordOptions options;
  options.folder = disk.path() / "recorded";
  const auto recorder = open(options);
  ASSERT_NE(recorder, nullptr);
  for (int i = 0; i < 2; ++i) {
    disk.fill();
    const std::uint64_t dropped = recorder->counts().dropped;
    ASSERT_TRUE(integration::eventually([&] {
      say(*recorder, std::string(5000, 'x'));
      return recorder->counts().dropped > dropped;
    }));
    EXPECT_THAT(recorder->counts().trouble, HasSubstr("No space left"));
    disk.make_room();
    const std::uint64_t recorded = recorder->counts().recorded;
    ASSERT_TRUE(integration::eventually([&] {
      say(*recorder, "room");
      return recorder->counts().recorded > recorded;
    }));
    // The trouble is not over with the first write that finds room.
    EXPECT_THAT(recorder->counts().trouble, HasSubstr("No space left"));
  }
  recorder->finish();
  const std::string lines = log_.text();
  EXPECT_EQ(std::ranges::count(lines, '\n'), 2) << lines;
  EXPECT_THAT(
      lines, AllOf(HasSubstr("warning not all is recorded"),
                   HasSubstr("warning not all was recorded failures="), Not(HasSubstr("goes on"))));
  const Omission missing = missing_in(options.folder);
  EXPECT_EQ(missing.messages, recorder->counts().dropped);
}

/// The follower of a fleet's log tells of a change after it was made: the daemon may have made the
/// next one meanwhile.
TEST_F(RecorderTest, AChangeOfOthersThatComesLateIsRecordedAndTurnsNothingBack) {
  RecordOptions options;
  options.limits.file_bytes = 4096;
  const auto recorder = open(options);
  scene::SceneStore store;
  store.put(wall());
  const auto first = store.find("wall");
  store.change("wall", box(1.0));
  const auto second = store.find("wall");
  store.change("wall", box(2.0));
  const auto third = store.find("wall");
  recorder->scene_put(*first, {});
  recorder->scene_changed(second->revision, *third, {box(2.0)}, {});
  recorder->scene_put(*second, {});
  say(*recorder, std::string(5000, 'x'));
  say(*recorder, "in the next file");
  recorder->finish();
  std::set<std::uint64_t> recorded_revisions;
  for (const fs::path& log : logs_of(recorded())) {
    for (const SceneUpdate& update : all<SceneUpdate>(read(log).events)) {
      recorded_revisions.insert(update.update.entry.revision);
    }
  }
  EXPECT_EQ(recorded_revisions.size(), 3U);
  const auto logs = logs_of(recorded());
  ASSERT_GT(logs.size(), 1U);
  EXPECT_EQ(all<SceneUpdate>(read(logs.back()).events).front().update.entry.revision,
            third->revision);
}

TEST_F(RecorderTest, ALateRemovalLeavesTheSceneThatWasMadeSince) {
  SceneMap newest;
  scene::SceneStore store;
  store.put(wall());
  const auto first = store.find("wall");
  store.change("wall", box(1.0));
  const auto second = store.find("wall");
  take({ChangedScene::Kind::kPut, second, 0, {}, {}}, newest);
  take({ChangedScene::Kind::kRemove, first, 0, {}, {}}, newest);
  EXPECT_EQ(newest.at("wall"), second);
  take({ChangedScene::Kind::kPut, first, 0, {}, {}}, newest);
  EXPECT_EQ(newest.at("wall"), second);
  take({ChangedScene::Kind::kRemove, second, 0, {}, {}}, newest);
  EXPECT_TRUE(newest.empty());
}

TEST_F(RecorderTest, CountsWhatDoesNotFitTheQueue) {
  RecordOptions options;
  options.waiting_bytes = 4096;
  options.waiting_changes = 1;
  const auto recorder = open(options);
  RecordingJournal journal(nullptr, *recorder);
  scene::SceneStore store({}, &journal);
  store.put(wall());
  constexpr std::uint64_t kMessages = 3000;
  for (std::uint64_t i = 0; i < kMessages; ++i) {
    say(*recorder, std::string(1000, 'x'));
    if (i % 300 == 0) store.change("wall", box(1.0 + static_cast<double>(i)));
  }
  recorder->finish();
  const RecordCounts counts = recorder->counts();
  EXPECT_EQ(counts.recorded + counts.dropped, kMessages + 11);
  EXPECT_GT(counts.dropped, 0U);
  const Omission missing = missing_in(recorded());
  EXPECT_EQ(missing.messages + missing.changes, counts.dropped);
  const auto updates = all<SceneUpdate>(read(logs_of(recorded()).back()).events);
  EXPECT_EQ(updates.back().digest, store.find("wall")->digest);
  EXPECT_THAT(log_.text(), HasSubstr("the disk is too slow"));
}

TEST_F(RecorderTest, LetsNoOtherOneRecordIntoItsFolder) {
  const auto recorder = open({});
  RecordOptions options;
  options.folder = recorded();
  const auto second = Recorder::open(options, {}, log_.log());
  EXPECT_FALSE(second);
  EXPECT_THAT(second.error, HasSubstr("another daemon records into it"));
  options.folder = folder_.write("file", "") + "/below";
  EXPECT_THAT(Recorder::open(options, {}, log_.log()).error, HasSubstr("cannot be made"));
}

TEST(SessionEvents, ReadsWhatItWritesAndRefusesTheRest) {
  SceneUpdate update;
  update.update.scene = "office";
  update.update.entry = {3, 4, {std::byte{1}, std::byte{2}}, {scene::BlobId{}}};
  update.digest = "abc";
  const std::vector<SessionEvent> events{
      FileBegin{"recording", 2, "build", {{"a", "b"}, {"c", ""}}}, update,
      Omission{1, 2, 3, 4, "full"}};
  for (const SessionEvent& event : events) {
    const std::vector<std::uint8_t> bytes = bytes_of(event);
    const auto again = session_event_from(bytes);
    ASSERT_TRUE(again) << again.error;
    EXPECT_EQ(bytes_of(*again), bytes);
    EXPECT_EQ(again->index(), event.index());
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      EXPECT_FALSE(session_event_from(std::span(bytes).first(length))) << length;
    }
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(session_event_from(longer));
  }
}

}  // namespace
}  // namespace camway::record
