// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "daemon/scene/log/sqlite/sqlite_log.h"
#include "tests/scene/log/log_samples.h"
#include "tests/support/random.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

constexpr std::uint64_t kStoreDamageSeed = 4711;
constexpr std::size_t kLogPage = 4096;

/// A log of all kinds of rows, some larger than a page, whose file is damaged again and again.
class SqliteLogDamage : public ::testing::Test {
 protected:
  void SetUp() override {
    blobs_ = {SampleBlob("first"), SampleBlob(std::string(20'000, 'b'))};
    blobs_.emplace_back("third", std::vector{blobs_[1].id});
    const auto log = SqliteLog::open(folder_.path(), {});
    ASSERT_TRUE(log) << log.error;
    for (const SampleBlob& sample : blobs_) (*log)->put_blob(sample.id, sample.blob);
    for (std::uint64_t i = 0; i < 30; ++i) {
      const std::string record = std::to_string(i) + std::string(i % 10 == 0 ? 9000 : 300, 'r');
      (*log)->append("a", sample_entry(i, i + 1, record, {blobs_[i % 3].id}));
      (*log)->append("b" + std::to_string(i), sample_entry(0, i + 1, "made"));
    }
    (*log)->summarize("a", 5, log_bytes(std::string(6000, 's')), {blobs_[0].id});
    (*log)->remove("b0", 1);
    (*log)->set_note("key", "text");
    intact_state_ = state_of(**log);
    ASSERT_EQ(intact_state_.substr(0, 6), "a at 5");
  }

  /// Returns all that a log holds. Empty if it is refused, which has to be with an error.
  std::string state_of(SqliteLog& log) {
    const auto scenes = log.scenes();
    EXPECT_NE(scenes.error.empty(), !scenes);
    if (!scenes) return "";
    std::string text = text_of_scenes(*scenes);
    for (const SampleBlob& sample : blobs_) {
      const auto bytes = log.blob(sample.id);
      EXPECT_NE(bytes.error.empty(), !bytes);
      if (!bytes) return "";
      text += log_text(*bytes) + "\n";
    }
    return text + log.note("key") + std::to_string(log.highest_removed());
  }

  void read_file() {
    std::ifstream file(path(), std::ios::binary);
    intact_ = std::string(std::istreambuf_iterator<char>(file), {});
    ASSERT_EQ(intact_.size() % kLogPage, 0U);
    ASSERT_GE(intact_.size(), 20 * kLogPage);
    ASSERT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 3)
        << "changes are beside the file";
  }

  /// Requires that a file with these bytes is refused, or holds all. Returns whether it was
  /// refused.
  bool is_refused(const std::string& bytes) {
    for (const char* const suffix : {"-wal", "-shm", "-journal"}) {
      std::filesystem::remove(path().string() + suffix);
    }
    std::ofstream(path(), std::ios::binary | std::ios::trunc) << bytes;
    const auto checked = SqliteLog::check(path());
    const auto log = SqliteLog::open(folder_.path(), {});
    EXPECT_NE(log.error.empty(), !log);
    const std::string state = log ? state_of(**log) : "";
    if (state.empty()) {
      EXPECT_FALSE(checked) << "opening finds more than the check does";
      return true;
    }
    EXPECT_EQ(state, intact_state_);
    return false;
  }

  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "scenes.sqlite"; }

  testing::TemporaryFolder folder_;
  std::vector<SampleBlob> blobs_;
  std::string intact_;
  std::string intact_state_;
};

TEST_F(SqliteLogDamage, IsNoticedWhereTheFileEndsTooEarly) {
  read_file();
  ASSERT_FALSE(is_refused(intact_));
  for (std::size_t size = 0; size < intact_.size(); size += kLogPage) {
    EXPECT_TRUE(is_refused(intact_.substr(0, size))) << size << " bytes";
    EXPECT_TRUE(is_refused(intact_.substr(0, size + 1000))) << size + 1000 << " bytes";
  }
}

TEST_F(SqliteLogDamage, IsNoticedWhereAPageIsLost) {
  read_file();
  std::size_t refused_at_once = 0;
  for (std::size_t begin = 0; begin < intact_.size(); begin += kLogPage) {
    std::string bytes = intact_;
    bytes.replace(begin, kLogPage, kLogPage, '\0');
    EXPECT_TRUE(is_refused(bytes)) << "page " << begin / kLogPage + 1;
    if (!SqliteLog::open(folder_.path(), {})) ++refused_at_once;
  }
  // Those that end a row of many pages are part of no structure.
  EXPECT_GT(refused_at_once, intact_.size() / kLogPage / 2);
}

TEST_F(SqliteLogDamage, IsNoticedWhereAPageIsAnother) {
  read_file();
  testing::Random random(kStoreDamageSeed);
  const int pages = static_cast<int>(intact_.size() / kLogPage);
  for (int i = 0; i < testing::runs(100); ++i) {
    const auto to = static_cast<std::size_t>(random.integer(0, pages - 1)) * kLogPage;
    const auto from = static_cast<std::size_t>(random.integer(0, pages - 1)) * kLogPage;
    std::string bytes = intact_;
    bytes.replace(to, kLogPage, intact_, from, kLogPage);
    is_refused(bytes);
  }
}

TEST_F(SqliteLogDamage, OfABitNeverChangesWhatIsRead) {
  read_file();
  testing::Random random(kStoreDamageSeed + 1);
  int refused = 0;
  for (int i = 0; i < testing::runs(200); ++i) {
    std::string bytes = intact_;
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.integer(0, 7)));
    SCOPED_TRACE("byte " + std::to_string(at));
    refused += is_refused(bytes) ? 1 : 0;
  }
  // The rest are bits of free space.
  EXPECT_GT(refused, testing::runs(200) / 4);
}

}  // namespace
}  // namespace camway::scene
