// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/scene_key.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <set>

#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

class SceneKeyTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text);
  }

  testing::TemporaryFolder folder_;
  PreparationOptions options_{{}, {}, DistanceFieldOptions{}};
};

TEST_F(SceneKeyTest, DependsOnTheBytesAndNotOnTheirPlace) {
  const auto key = scene_key(write("a.obj", "v 0 0 0"), options_);
  ASSERT_TRUE(key);
  EXPECT_EQ(key->text().size(), 32U);
  EXPECT_EQ(scene_key(write("b.OBJ", "v 0 0 0"), options_), key);
  EXPECT_NE(scene_key(write("a.obj", "v 0 0 1"), options_), key);
  EXPECT_NE(scene_key(write("a.obj", "v 0 0 0\n"), options_), key);
  EXPECT_NE(scene_key(write("a.off", "v 0 0 0"), options_), key) << "another format";
}

TEST_F(SceneKeyTest, DependsOnEachOptionThatChangesTheResult) {
  const std::string file = write("a.ply", "ply");
  std::set<std::string> keys;
  const auto add = [&](const PreparationOptions& options) {
    EXPECT_TRUE(keys.insert(scene_key(file, options)->text()).second);
  };
  const auto with = [this](auto change) {
    PreparationOptions options = options_;
    change(options);
    return options;
  };
  add(options_);
  add(with([](auto& o) { o.import.scale = 0.0254; }));
  add(with([](auto& o) { o.import.up = UpAxis::kZToY; }));
  add(with([](auto& o) { o.import.up = UpAxis::kYToZ; }));
  add(with([](auto& o) { o.import.memory_limit_bytes /= 2; }));
  add(with([](auto& o) { o.index.threshold = 17; }));
  add(with([](auto& o) { o.index.max_depth = 15; }));
  add(with([](auto& o) { o.index.max_duplication = 7.0; }));
  add(with([](auto& o) { o.field.reset(); }));
  add(with([](auto& o) { o.field->memory_limit_bytes /= 2; }));
  const auto threads = with([](auto& o) { o.index.threads = o.field->threads = 3; });
  EXPECT_EQ(scene_key(file, threads), scene_key(file, options_));
}

TEST_F(SceneKeyTest, IsThereForFormatsOfOneFileOnly) {
  for (const char* const name : {"a.gltf", "a.dae", "a.bt", "a.ot", "a.3ds", "obj", "a.obj.gz"}) {
    EXPECT_FALSE(scene_key(write(name, "bytes"), options_)) << name;
  }
}

TEST_F(SceneKeyTest, IsNotThereForWhatCannotBeRead) {
  EXPECT_FALSE(scene_key(folder_.path() / "none.obj", options_));
  std::filesystem::create_directory(folder_.path() / "folder.obj");
  EXPECT_FALSE(scene_key(folder_.path() / "folder.obj", options_));
  ASSERT_EQ(mkfifo((folder_.path() / "pipe.obj").c_str(), 0600), 0);
  EXPECT_FALSE(scene_key(folder_.path() / "pipe.obj", options_)) << "and does not wait for it";
}

TEST(SceneBuild, IsADigest) {
  EXPECT_EQ(scene_build().size(), 32U);
  EXPECT_EQ(scene_build().find_first_not_of("0123456789abcdef"), std::string_view::npos);
}

}  // namespace
}  // namespace camway::scene
