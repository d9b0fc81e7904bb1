// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/scene_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

#include "tests/scene/cache/prepared_matchers.h"
#include "tests/scene/cache/prepared_samples.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::expect_same;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kSampleKey;
using testing::small_prepared;

constexpr SceneCacheLimits kAll = {.least_triangles = 1};

SceneKey key_of(std::uint8_t number) { return {{number}}; }

/// Makes root act as an ordinary user as long as it lives.
class WithoutRights {
 public:
  WithoutRights() {
    if (is_root_) {
      EXPECT_EQ(seteuid(kNobody), 0);
    }
  }
  ~WithoutRights() {
    if (is_root_) {
      EXPECT_EQ(seteuid(0), 0);
    }
  }
  WithoutRights(const WithoutRights&) = delete;
  WithoutRights& operator=(const WithoutRights&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  const bool is_root_ = geteuid() == 0;
};

class SceneCacheTest : public ::testing::Test {
 protected:
  SceneCache cache(const SceneCacheLimits& limits = kAll) const {
    return SceneCache(folder(), limits);
  }
  fs::path folder() const { return parent_.path() / "deep/cache"; }
  fs::path file(const SceneKey& key) const { return folder() / (key.text() + ".scene"); }
  bool store(const SceneCache& cache, const SceneKey& key) const {
    return cache.store(key, "room.ply", prepared_);
  }
  /// Sets the time at which the scene was last used to so many seconds ago.
  void age(const SceneKey& key, int seconds) const {
    fs::last_write_time(file(key),
                        fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
  }

  testing::TemporaryFolder parent_;
  PreparedScene prepared_ = small_prepared(true);
};

TEST_F(SceneCacheTest, FindsWhatWasStoredAndNothingElse) {
  EXPECT_FALSE(cache().find(kSampleKey, {}));
  ASSERT_TRUE(store(cache(), kSampleKey));
  const std::optional<PreparedScene> found = cache().find(kSampleKey, {});
  ASSERT_TRUE(found);
  expect_same(prepared_, *found);
  EXPECT_FALSE(cache().find(key_of(9), {}));
}

TEST_F(SceneCacheTest, IsForTheUserAlone) {
  ASSERT_TRUE(store(cache(), kSampleKey));
  struct stat status {};
  ASSERT_EQ(stat(folder().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0700U);
  ASSERT_EQ(stat(file(kSampleKey).c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(SceneCacheTest, DoesNotUseAFolderThatOthersMayWriteTo) {
  ASSERT_TRUE(store(cache(), kSampleKey));
  EXPECT_EQ(cache().fault(), "");
  fs::permissions(folder(), fs::perms::group_write, fs::perm_options::add);
  EXPECT_THAT(cache().fault(), HasSubstr("written by others"));
  EXPECT_FALSE(cache().find(kSampleKey, {}));
  EXPECT_FALSE(store(cache(), key_of(2)));
  EXPECT_THAT(cache().scenes(), IsEmpty());
}

TEST_F(SceneCacheTest, DoesNotUseAFileThatOthersMayWriteTo) {
  ASSERT_TRUE(store(cache(), kSampleKey));
  fs::permissions(file(kSampleKey), fs::perms::others_write, fs::perm_options::add);
  EXPECT_FALSE(cache().find(kSampleKey, {}));
}

TEST_F(SceneCacheTest, DoesNotUseWhatBelongsToAnotherUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  ASSERT_TRUE(store(cache(), kSampleKey));
  ASSERT_EQ(chown(file(kSampleKey).c_str(), 1234, 0), 0);
  EXPECT_FALSE(cache().find(kSampleKey, {}));
  ASSERT_EQ(chown(folder().c_str(), 1234, 0), 0);
  EXPECT_EQ(cache().fault(), "belongs to another user");
}

TEST_F(SceneCacheTest, FollowsNoLinkInPlaceOfAFile) {
  ASSERT_TRUE(store(cache(), kSampleKey));
  fs::rename(file(kSampleKey), parent_.path() / "elsewhere");
  fs::create_symlink(parent_.path() / "elsewhere", file(kSampleKey));
  EXPECT_FALSE(cache().find(kSampleKey, {}));
}

TEST_F(SceneCacheTest, DoesWithoutAFolderThatCannotBeMade) {
  const SceneCache below_a_file(parent_.write("file", "") + "/cache", kAll);
  EXPECT_FALSE(below_a_file.store(kSampleKey, "room.ply", prepared_));
  EXPECT_FALSE(below_a_file.find(kSampleKey, {}));
  EXPECT_THAT(below_a_file.fault(), HasSubstr("cannot be opened"));
}

TEST_F(SceneCacheTest, DoesWithoutAFolderThatCannotBeWritten) {
  fs::permissions(parent_.path(), fs::perms::all);
  const WithoutRights without_rights;  // root can write to any folder
  ASSERT_TRUE(store(cache(), kSampleKey));
  fs::permissions(folder(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_TRUE(cache().find(kSampleKey, {}));
  EXPECT_FALSE(store(cache(), key_of(2)));
  fs::permissions(folder(), fs::perms::owner_all);
}

TEST_F(SceneCacheTest, TellsWhetherAFolderThatIsNotThereCanBeMade) {
  const SceneCache deep(parent_.path() / "a/b", kAll);
  EXPECT_EQ(deep.fault(), "");
  EXPECT_FALSE(fs::exists(parent_.path() / "a"));
  constexpr auto kNobodyMayWrite = fs::perms{0555};
  fs::permissions(parent_.path(), kNobodyMayWrite);
  {
    const WithoutRights without_rights;  // root can make any folder
    EXPECT_EQ(deep.fault(), "cannot be made: Permission denied");
  }
  fs::permissions(parent_.path(), fs::perms::owner_all);
}

TEST_F(SceneCacheTest, ListsHowAFileWasRead) {
  prepared_.report.scale = 0.0254;
  prepared_.report.up = UpAxis::kZToY;
  ASSERT_TRUE(store(cache(), kSampleKey));
  const std::vector<CachedScene> scenes = cache().scenes();
  ASSERT_EQ(scenes.size(), 1u);
  EXPECT_EQ(scenes[0].scale, 0.0254);
  EXPECT_EQ(scenes[0].up, UpAxis::kZToY);
}

TEST_F(SceneCacheTest, RemovesADamagedFile) {
  ASSERT_TRUE(store(cache(), kSampleKey));
  fs::resize_file(file(kSampleKey), 5000);
  EXPECT_FALSE(cache().find(kSampleKey, {}));
  EXPECT_FALSE(fs::exists(file(kSampleKey)));
}

TEST_F(SceneCacheTest, KeepsNoSmallScene) {
  const std::size_t triangles = prepared_.indexed->mesh->triangles.size();
  EXPECT_FALSE(store(cache({.least_triangles = triangles + 1}), kSampleKey));
  EXPECT_FALSE(fs::exists(folder())) << "nor is a folder made for nothing";
  EXPECT_TRUE(store(cache({.least_triangles = triangles}), kSampleKey));
}

TEST_F(SceneCacheTest, WhatWasUsedTheLongestAgoMakesRoom) {
  ASSERT_TRUE(store(cache(), key_of(1)));
  const std::uint64_t bytes = fs::file_size(file(key_of(1)));
  const SceneCache three = cache({.bytes = 3 * bytes + bytes / 2, .least_triangles = 1});
  ASSERT_TRUE(store(three, key_of(2)));
  ASSERT_TRUE(store(three, key_of(3)));
  age(key_of(1), 300);
  age(key_of(2), 200);
  age(key_of(3), 100);
  ASSERT_TRUE(three.find(key_of(1), {})) << "which makes it the last used";
  ASSERT_TRUE(store(three, key_of(4)));
  EXPECT_TRUE(three.find(key_of(1), {}));
  EXPECT_FALSE(three.find(key_of(2), {}));
  EXPECT_TRUE(three.find(key_of(3), {}));
  EXPECT_TRUE(three.find(key_of(4), {}));
}

TEST_F(SceneCacheTest, KeepsNothingThatIsLargerThanItsLimit) {
  ASSERT_TRUE(store(cache(), key_of(1)));
  const std::uint64_t bytes = fs::file_size(file(key_of(1)));
  EXPECT_FALSE(store(cache({.bytes = bytes - 1, .least_triangles = 1}), key_of(2)));
  EXPECT_TRUE(cache().find(key_of(1), {})) << "nor does anything make room for it";
}

TEST_F(SceneCacheTest, RemovesWhatAnEndedProcessLeftUnfinished) {
  ASSERT_TRUE(store(cache(), key_of(1)));
  std::ofstream(folder() / ".unfinished-1") << "half a scene";
  std::ofstream(folder() / ".unfinished-2") << "half a scene";
  std::ofstream(folder() / "of another program") << "a file";
  fs::last_write_time(folder() / ".unfinished-1",
                      fs::file_time_type::clock::now() - std::chrono::hours(2));
  ASSERT_TRUE(store(cache(), key_of(2)));
  EXPECT_FALSE(fs::exists(folder() / ".unfinished-1"));
  EXPECT_TRUE(fs::exists(folder() / ".unfinished-2")) << "it may be finished yet";
  EXPECT_EQ(cache().clear(), 2U);
  EXPECT_FALSE(fs::exists(folder() / ".unfinished-2"));
  EXPECT_TRUE(fs::exists(folder() / "of another program"));
}

TEST_F(SceneCacheTest, ListsItsScenesTheLastUsedFirst) {
  ASSERT_TRUE(store(cache(), key_of(1)));
  ASSERT_TRUE(cache().store(key_of(2), "/scenes/two\n.obj", prepared_));
  ASSERT_TRUE(store(cache(), key_of(3)));
  age(key_of(1), 10);
  age(key_of(2), 20);
  std::ofstream(file(key_of(3))) << "damaged";
  const std::vector<CachedScene> scenes = cache().scenes();
  ASSERT_EQ(scenes.size(), 2U);
  EXPECT_EQ(scenes[0].key, key_of(1).text());
  EXPECT_EQ(scenes[0].scene_file, (fs::current_path() / "room.ply").string());
  EXPECT_EQ(scenes[0].triangles, prepared_.indexed->mesh->triangles.size());
  EXPECT_EQ(scenes[0].bytes, fs::file_size(file(key_of(1))));
  EXPECT_TRUE(scenes[0].is_of_this_build);
  EXPECT_EQ(scenes[1].scene_file, "/scenes/two?.obj");
}

TEST_F(SceneCacheTest, ReadersNeverSeeHalfOfWhatWritersWrite) {
  std::vector<std::jthread> writers;
  for (int i = 0; i < 3; ++i) {
    writers.emplace_back([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) EXPECT_TRUE(store(cache(), kSampleKey));
    });
  }
  while (!fs::exists(file(kSampleKey))) std::this_thread::yield();
  for (int i = 0; i < 200; ++i) {
    const std::optional<PreparedScene> found = cache().find(kSampleKey, {});
    ASSERT_TRUE(found);
    expect_same(prepared_, *found);
  }
  writers.clear();
  EXPECT_EQ(cache().clear(), 1U);
  EXPECT_TRUE(fs::is_empty(folder()));
}

TEST_F(SceneCacheTest, WhatWasFoundOutlivesItsFile) {
  ASSERT_TRUE(store(cache(), kSampleKey));
  const std::optional<PreparedScene> found = cache().find(kSampleKey, {});
  EXPECT_EQ(cache().clear(), 1U);
  expect_same(prepared_, *found);
}

/// Sets a variable of the environment, or takes it out, until it is destroyed.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    const char* const old = std::getenv(name);
    if (old != nullptr) old_ = old;
    set(value);
  }
  ~Variable() { set(old_ ? old_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    value != nullptr ? setenv(name_, value, 1) : unsetenv(name_);
  }

  const char* name_;
  std::optional<std::string> old_;
};

TEST(SceneCacheFolder, IsWhereTheEnvironmentSays) {
  const Variable home("HOME", "/of-ada");
  {
    const Variable own("CAMWAY_CACHE_DIR", nullptr);
    const Variable none("XDG_CACHE_HOME", nullptr);
    EXPECT_EQ(cache_folder_of_environment(), "/of-ada/.cache/camway");
    const Variable relative("XDG_CACHE_HOME", "caches");
    EXPECT_EQ(cache_folder_of_environment(), "/of-ada/.cache/camway");
    const Variable xdg("XDG_CACHE_HOME", "/var/caches");
    EXPECT_EQ(cache_folder_of_environment(), "/var/caches/camway");
    const Variable nowhere("XDG_CACHE_HOME", nullptr);
    const Variable homeless("HOME", nullptr);
    EXPECT_FALSE(cache_of_environment().cache);
    EXPECT_THAT(cache_of_environment().absence, HasSubstr("HOME names a folder"));
  }
  const Variable own("CAMWAY_CACHE_DIR", "mine");
  EXPECT_EQ(cache_folder_of_environment(), "mine");
  const Variable off("CAMWAY_CACHE_DIR", "");
  EXPECT_FALSE(cache_of_environment().cache);
  EXPECT_EQ(cache_of_environment().absence, "CAMWAY_CACHE_DIR is empty");
}

TEST(SceneCacheFolder, HasTheLimitThatTheEnvironmentSays) {
  const Variable own("CAMWAY_CACHE_DIR", "mine");
  EXPECT_EQ(cache_of_environment().cache->limits().bytes, SceneCacheLimits{}.bytes);
  const Variable number("CAMWAY_CACHE_BYTES", "5000");
  EXPECT_EQ(cache_of_environment().cache->limits().bytes, 5000U);
  EXPECT_EQ(cache_of_environment().fault, "");
  for (const char* const wrong : {"5 GB", "-1", "2GiB", "abc", "", "99999999999999999999"}) {
    const Variable word("CAMWAY_CACHE_BYTES", wrong);
    EXPECT_EQ(cache_of_environment().cache->limits().bytes, SceneCacheLimits{}.bytes);
    EXPECT_EQ(cache_of_environment().fault, std::string("CAMWAY_CACHE_BYTES is '") + wrong +
                                                "'; it must be a whole number of bytes below 2^64");
  }
  const Variable zero("CAMWAY_CACHE_BYTES", "0");
  EXPECT_FALSE(cache_of_environment().cache);
  EXPECT_EQ(cache_of_environment().absence, "CAMWAY_CACHE_BYTES is 0");
}

}  // namespace
}  // namespace camway::scene
