// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "daemon/scene/log/change_record.h"
#include "tests/support/random.h"
#include "tests/tools/camway/replay/recorded_wall.h"
#include "tools/camway/replay/outcome.h"
#include "tools/camway/replay/replay_run.h"
#include "tools/camway/replay/scenes/session_scenes.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The remains of a damaged recording.
struct Left {
  std::size_t whole = 0;  ///< requests whose scene and answer are there
  bool is_told = false;   ///< whether anything says that something is wrong
};

class SessionDamage : public ::testing::Test {
 protected:
  void SetUp() override {
    log_ = record_wall(folder_.file("recorded"));
    bytes_ = read_all(log_.string());
    damaged_ = (log_.parent_path() / "damaged.lcmlog").string();
  }

  /// Without `scenes`, takes the scene of every request for one that is there.
  Left left_of(const std::string& bytes, bool with_scenes = true) const {
    std::ofstream(damaged_, std::ios::binary) << bytes;
    const Session session = read_session(fs::path(damaged_), "CAMWAY");
    SessionScenes scenes(session, blob_folders_of({damaged_}));
    Left left;
    left.is_told = !session.log.damage.empty() || session.malformed > 0 || session.incomplete > 0 ||
                   session.unasked > 0 || session.conflicts > 0 || session.damaged_events > 0 ||
                   session.requests.size() != 3;
    for (const RecordedRequest& request : session.requests) {
      if (!request.request || !request.answer) {
        left.is_told = true;
        continue;
      }
      if (!with_scenes) {
        ++left.whole;
        continue;
      }
      const FoundScene found = scenes.snapshot_of(request);
      if (found.snapshot == nullptr) {
        EXPECT_TRUE(!found.why_not.empty() || scene_was_unknown(request));
        left.is_told = true;
        continue;
      }
      EXPECT_EQ(found.snapshot->digest, request.answer->scene_digest);
      ++left.whole;
    }
    return left;
  }

  TemporaryFolder folder_;
  fs::path log_;
  std::string damaged_;
  std::string bytes_;
};

TEST_F(SessionDamage, TheWholeRecordingReplays) {
  const Session session = read_session(log_, "CAMWAY");
  SessionScenes scenes(session, blob_folders_of({log_}));
  const auto replayed = replay(session, scenes, {});
  for (const ReplayedRequest& item : replayed) EXPECT_EQ(item.compared.verdict, Verdict::kSame);
  const Left left = left_of(bytes_);
  EXPECT_EQ(left.whole, 3U);
  EXPECT_FALSE(left.is_told);
}

/// All lengths take --gtest_repeat=7, each time with other ones.
TEST_F(SessionDamage, ATruncationIsToldAndLeavesWhatIsBefore) {
  std::size_t whole = 0;
  constexpr std::size_t kStep = 7;
  static std::size_t repetition = 0;
  const std::size_t first = repetition++ % kStep;
  for (std::size_t length = first; length < bytes_.size(); length += kStep) {
    const Left left = left_of(bytes_.substr(0, length), length / kStep % 16 == 0);
    ASSERT_TRUE(left.is_told) << length;
    ASSERT_GE(left.whole, whole) << "a longer log has no less";
    whole = left.whole;
  }
  EXPECT_EQ(whole, 2U);
}

/// More flips take --gtest_repeat=100, each time with other ones.
TEST_F(SessionDamage, FlippedBitsNeverCrash) {
  constexpr int kRounds = 200;
  static unsigned repetition = 0;
  testing::Random random(++repetition);
  for (int i = 0; i < kRounds; ++i) {
    std::string bytes = bytes_;
    const std::size_t flips = 1 + random() % 3;
    for (std::size_t k = 0; k < flips; ++k) {
      char& byte = bytes[random() % bytes.size()];
      byte = static_cast<char>(byte ^ (1 << random() % 8));
    }
    left_of(bytes);
  }
}

/// Options that no daemon has would end the process where scenes are built.
TEST_F(SessionDamage, ImpossibleOptionsAreRefused) {
  const Session session = read_session(log_, "CAMWAY");
  scene::Bytes record = session.updates.front().change.update.entry.record;
  const std::string key = "index_threshold";
  const auto same = [](std::byte a, char b) { return a == static_cast<std::byte>(b); };
  const auto found = std::search(record.begin(), record.end(), key.begin(), key.end(), same);
  ASSERT_NE(found, record.end());
  EXPECT_TRUE(scene::change_record_from(record));
  *(found + static_cast<std::ptrdiff_t>(key.size())) = std::byte{0};
  EXPECT_FALSE(scene::change_record_from(record));
  // Items within items, as deep as the bytes are long.
  EXPECT_FALSE(scene::change_record_from(scene::Bytes(1'000'000, std::byte{0x81})));
}

TEST_F(SessionDamage, AnObjectThatCannotBePlacedIsTold) {
  Session session = read_session(log_, "CAMWAY");
  scene::LogUpdate& update = session.updates.front().change.update;
  auto whole = std::get<scene::RecordedScene>(*scene::change_record_from(update.entry.record));
  std::string fault;
  whole.objects.front().placement =
      scene::Placement::make({1e9, 0, 0}, geometry::Quat::Identity(), fault);
  update.entry.record = scene::change_record_of(whole);
  SessionScenes scenes(session, blob_folders_of({log_}));
  EXPECT_THAT(scenes.snapshot_of(session.requests.front()).why_not, HasSubstr("cannot be rebuilt"));
}

TEST_F(SessionDamage, ADamagedOrMissingContentIsNamed) {
  const Session session = read_session(log_, "CAMWAY");
  SessionScenes whole(session, blob_folders_of({log_}));
  ASSERT_TRUE(whole.snapshot_of(session.requests.front()).snapshot);
  for (const fs::directory_entry& blob : fs::directory_iterator(log_.parent_path() / "blobs")) {
    const std::string good = read_all(blob.path().string());
    std::string bad = good;
    bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
    for (const bool is_there : {true, false}) {
      fs::remove(blob.path());
      if (is_there) std::ofstream(blob.path(), std::ios::binary) << bad;
      SessionScenes scenes(session, blob_folders_of({log_}));
      // The last revision needs all of the contents; the one at fault is named, not what follows.
      const FoundScene found = scenes.snapshot_of(session.requests.back());
      EXPECT_TRUE(found.is_damaged);
      EXPECT_THAT(found.why_not,
                  AllOf(HasSubstr("cannot be rebuilt"), HasSubstr(blob.path().filename().string()),
                        HasSubstr(is_there ? ": is damaged" : ": is missing"),
                        Not(HasSubstr(is_there ? "is missing" : "is damaged"))));
      const auto compared = replay_one(session.requests.back(), scenes, {}).compared;
      EXPECT_TRUE(compared.scene_is_damaged);
      const auto first = replay_one(session.requests.front(), whole, {}).compared;
      EXPECT_EQ(code_of({first, compared}, kFailing, false), ExitCode::kInvalidInput);
      EXPECT_EQ(code_of({first}, kFailing, false), ExitCode::kSuccess);
    }
    std::ofstream(blob.path(), std::ios::binary) << good;
  }
}

}  // namespace
}  // namespace camway::tools
