// SPDX-License-Identifier: MIT
#include "tools/camway/replay/pack/packed_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/random.h"
#include "tests/tools/camway/replay/recorded_wall.h"
#include "tools/camway/replay/replay_run.h"
#include "tools/camway/replay/scenes/session_scenes.h"
#include "tools/camway/replay/selection.h"
#include "tools/camway/session/session_pack.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A pack that was unpacked and read again.
struct ReadPack {
  SessionFiles files;
  Session session;
  std::size_t contents = 0;
  bool is_damaged = false;
};

class PackedSessionTest : public ::testing::Test {
 protected:
  /// Records boxes that come, move and go, and a request after each change. Notes for each request
  /// which boxes are there: each has a size, and so a content, of its own.
  void record() {
    record::RecordLimits limits;
    limits.file_bytes = 8192;
    WallRecording recording(folder_.file("recorded"), limits);
    std::map<std::string, double> boxes;
    std::int64_t id = 0;
    const auto plan = [&] {
      ++id;
      recording.plan(id, id % 3 == 0 ? "other" : "client");
      std::set<double>& there = there_[id];
      for (const auto& [name, size_m] : boxes) there.insert(size_m);
    };
    const auto put = [&](const std::string& name, double size_m, double x_m) {
      recording.put(name, boxes[name] = size_m, x_m);
      plan();
    };
    plan();
    put("a", 0.2, 1.5);
    put("b", 0.3, -1.5);
    recording.move("a", 0.9);
    plan();
    put("a", 0.4, 1.2);
    recording.remove("b");
    boxes.erase("b");
    plan();
    plan();
    put("c", 0.5, 3.0);
    put("b", 0.3, 1.0);
    recording.remove("a");
    boxes.erase("a");
    plan();
    recording.finish();
  }

  [[nodiscard]] Session recorded() const {
    return read_session(SessionFiles::open(fs::path(folder_.file("recorded")))->logs(), "CAMWAY");
  }

  /// Packs the requests with these ids; empty: all as they are. Unpacks and reads the pack.
  ReadPack packed(const std::set<std::int64_t>& ids) {
    const SessionFiles files = *SessionFiles::open(fs::path(folder_.file("recorded")));
    Session session = read_session(files.logs(), "CAMWAY");
    Selection selection;
    for (const std::int64_t id : ids) selection.ids.emplace_back(id, id);
    session.unwanted = select(selection, session);
    base::Result<PackedSession> made = collect_pack({.files = files,
                                                     .session = session,
                                                     .is_selection = !ids.empty(),
                                                     .prefix = "CAMWAY",
                                                     .scenes = {}});
    EXPECT_TRUE(made) << made.error;
    left_out_ = made->left_out;
    std::vector<PackedFile> members;
    std::size_t contents = 0;
    for (const auto& [name, file] : made->members) {
      members.push_back({file, name});
      contents += name.starts_with("blobs/") ? 1U : 0U;
    }
    const std::string pack = folder_.file("pack" + std::to_string(++packs_));
    EXPECT_EQ(write_pack(pack, members), "");
    base::Result<SessionFiles> opened = SessionFiles::open(fs::path(pack));
    EXPECT_TRUE(opened) << opened.error;
    EXPECT_EQ(opened->left_out(), left_out_) << "the pack says so itself";
    Session again = read_session(opened->logs(), "CAMWAY");
    return {*std::move(opened), std::move(again), contents, made->is_damaged};
  }

  static std::map<std::int64_t, ReplayedRequest> replayed(const ReadPack& pack) {
    SessionScenes scenes(pack.session, blob_folders_of(pack.files.logs()));
    std::map<std::int64_t, ReplayedRequest> by_id;
    for (ReplayedRequest& each : replay(pack.session, scenes, {})) {
      by_id.emplace(each.compared.recorded->ids.request_id, std::move(each));
    }
    return by_id;
  }

  /// Checks that a pack has exactly these requests, replays them, and has no needless content.
  void expect_part(const std::set<std::int64_t>& ids) {
    const ReadPack pack = packed(ids);
    EXPECT_FALSE(pack.is_damaged);
    const auto answers = replayed(pack);
    ASSERT_EQ(answers.size(), ids.size());
    std::set<double> sizes;
    for (const std::int64_t id : ids) {
      SCOPED_TRACE(id);
      ASSERT_TRUE(answers.contains(id));
      EXPECT_EQ(answers.at(id).compared.verdict, Verdict::kSame) << answers.at(id).compared.note;
      const RecordedRequest& before = whole_.requests.at(static_cast<std::size_t>(id) - 1);
      EXPECT_EQ(answers.at(id).compared.recorded->received_s, before.received_s);
      sizes.insert(there_.at(id).begin(), there_.at(id).end());
    }
    EXPECT_EQ(pack.contents, 1 + sizes.size()) << "the wall and the boxes that they met";
    EXPECT_EQ(pack.session.begin_utime, whole_.begin_utime);
    EXPECT_THAT(left_out_, ElementsAre(HasSubstr("of 10 requests")));
    std::uint64_t lost = 0;
    for (const record::Omission& omission : pack.session.omissions) lost += omission.messages;
    EXPECT_GE(lost, 2 * (10 - ids.size())) << "requests and answers";
  }

  TemporaryFolder folder_;
  std::map<std::int64_t, std::set<double>> there_;  ///< sizes of boxes, by request
  Session whole_;
  std::vector<std::string> left_out_;
  int packs_ = 0;
};

TEST_F(PackedSessionTest, AWholeSessionIsPackedAsItIs) {
  record();
  const ReadPack pack = packed({});
  EXPECT_FALSE(pack.is_damaged);
  EXPECT_THAT(left_out_, IsEmpty());
  EXPECT_GT(pack.files.logs().size(), 2U) << "several files";
  for (const auto& [id, answer] : replayed(pack)) {
    EXPECT_EQ(answer.compared.verdict, Verdict::kSame) << id;
  }
  EXPECT_EQ(pack.contents, 5U);
}

/// All parts take --gtest_repeat=100, each time with other ones.
TEST_F(PackedSessionTest, APartHasWhatItsRequestsNeedAndNoMore) {
  record();
  whole_ = recorded();
  ASSERT_EQ(whole_.requests.size(), 10U);
  for (std::int64_t id = 1; id <= 10; ++id) expect_part({id});
  static unsigned repetition = 0;
  testing::Random random(++repetition);
  for (int i = 0; i < 10; ++i) {
    std::set<std::int64_t> ids;
    while (ids.empty()) {
      for (std::int64_t id = 1; id <= 10; ++id) {
        if (random() % 3 == 0) ids.insert(id);
      }
    }
    expect_part(ids);
  }
}

TEST_F(PackedSessionTest, APartOfAPartIsTheSame) {
  record();
  const ReadPack part = packed({2, 5, 9});
  fs::remove_all(folder_.file("recorded"));
  fs::copy(part.files.logs().front().parent_path(), folder_.file("recorded"),
           fs::copy_options::recursive);
  const ReadPack smaller = packed({5});
  EXPECT_EQ(replayed(smaller).at(5).compared.verdict, Verdict::kSame);
  EXPECT_THAT(left_out_, ElementsAre(HasSubstr("7 of 10 requests"), HasSubstr("2 of 3 requests")));
  EXPECT_EQ(smaller.contents, 3U);
}

/// Damages or removes each content in turn: the rest is packed, and what is missing is said.
TEST_F(PackedSessionTest, WhatIsDamagedIsNamedAndTheRestReplays) {
  record();
  int damages = 0;
  for (const fs::directory_entry& blob :
       fs::directory_iterator(folder_.file("recorded") + "/blobs")) {
    const std::string good = read_all(blob.path().string());
    std::string bad = good;
    bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
    const bool is_missing = ++damages % 2 == 0;
    fs::remove(blob.path());
    if (!is_missing) std::ofstream(blob.path(), std::ios::binary) << bad;
    const std::string digest = blob.path().filename();
    for (const std::set<std::int64_t>& ids :
         {std::set<std::int64_t>(), std::set<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}}) {
      const ReadPack pack = packed(ids);
      EXPECT_TRUE(pack.is_damaged);
      EXPECT_THAT(left_out_,
                  Contains(AllOf(HasSubstr("content " + digest), HasSubstr("of object '"),
                                 HasSubstr("of scene 'wall' in revision "),
                                 HasSubstr(is_missing ? "is missing" : "is damaged"))));
      std::string said;
      for (const std::string& sentence : left_out_) said += sentence + ",\n";
      std::size_t lost = 0;
      for (const auto& [id, answer] : replayed(pack)) {
        const std::string name =
            " " + answer.compared.recorded->ids.client_id + "/" + std::to_string(id) + ",";
        if (answer.compared.verdict == Verdict::kSame) {
          EXPECT_EQ(said.find(name), std::string::npos) << said;
          continue;
        }
        ++lost;
        EXPECT_TRUE(answer.compared.scene_is_damaged) << name;
        EXPECT_THAT(said, HasSubstr(name));
      }
      EXPECT_GT(lost, 0U) << digest;
    }
    std::ofstream(blob.path(), std::ios::binary) << good;
  }
  EXPECT_EQ(damages, 5);
}

TEST_F(PackedSessionTest, ARevisionThatIsNotInTheLogsIsNamed) {
  record();
  // Answers to revisions of which the recording has no change.
  const SessionFiles files = *SessionFiles::open(fs::path(folder_.file("recorded")));
  Session session = read_session(files.logs(), "CAMWAY");
  for (RecordedRequest& request : session.requests) request.answer->scene_revision += 1000;
  const base::Result<PackedSession> made = collect_pack(
      {.files = files, .session = session, .is_selection = true, .prefix = "CAMWAY", .scenes = {}});
  ASSERT_TRUE(made) << made.error;
  EXPECT_TRUE(made->is_damaged);
  EXPECT_THAT(made->left_out, Contains(AllOf(HasSubstr("revision 1001 of scene 'wall'"),
                                             HasSubstr("a request cannot be replayed: client/1"))));
}

}  // namespace
}  // namespace camway::tools
