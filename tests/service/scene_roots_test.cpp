// SPDX-License-Identifier: MIT
#include "daemon/service/scene_roots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace camway::service {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class SceneRootsTest : public ::testing::Test {
 protected:
  SceneRootsTest()
      : base_(fs::canonical(fs::path(::testing::TempDir())) /
              ("camway_roots_" + std::to_string(getpid()))) {
    fs::remove_all(base_);
    fs::create_directories(base_ / "root" / "inner");
    fs::create_directories(base_ / "root2");
    for (const char* name : {"secret.obj", "root/a.obj", "root/inner/b.obj", "root2/c.obj"}) {
      std::ofstream(base_ / name) << "v 0 0 0\n";
    }
    fs::create_symlink(base_ / "secret.obj", base_ / "root" / "out.obj");
    fs::create_directory_symlink(base_, base_ / "root" / "up");
    fs::create_symlink(base_ / "root" / "a.obj", base_ / "root" / "inner" / "in.obj");
    fs::create_symlink(base_ / "nowhere", base_ / "root" / "dangling.obj");
    std::string error;
    roots_ = SceneRoots::make({base_ / "root"}, error);
    EXPECT_EQ(error, "");
  }
  ~SceneRootsTest() override { fs::remove_all(base_); }

  [[nodiscard]] std::string refusal(const std::string& asked) const {
    const RootedFile rooted = roots_.resolve(asked);
    EXPECT_TRUE(rooted.file.empty()) << rooted.file;
    EXPECT_THAT(rooted.error, Not(HasSubstr("secret")));
    return rooted.error;
  }

  fs::path base_;
  SceneRoots roots_;
};

TEST_F(SceneRootsTest, FindsFilesBelowARoot) {
  EXPECT_EQ(roots_.resolve("a.obj").file, base_ / "root/a.obj");
  EXPECT_EQ(roots_.resolve("inner/b.obj").file, base_ / "root/inner/b.obj");
  EXPECT_EQ(roots_.resolve("./inner//b.obj").file, base_ / "root/inner/b.obj");
  EXPECT_EQ(roots_.resolve((base_ / "root/a.obj").string()).file, base_ / "root/a.obj");
  EXPECT_EQ(roots_.resolve("inner/in.obj").file, base_ / "root/a.obj") << "a link that stays in";
}

TEST_F(SceneRootsTest, RefusesWhatLeadsOut) {
  EXPECT_THAT(refusal("../root/a.obj"), HasSubstr("'..'"));
  EXPECT_THAT(refusal("inner/../a.obj"), HasSubstr("'..'"));
  EXPECT_THAT(refusal("out.obj"), HasSubstr("leads out"));
  EXPECT_THAT(refusal("up/root2/c.obj"), HasSubstr("leads out"));
  EXPECT_THAT(refusal((base_ / "root2/c.obj").string()), HasSubstr("leads out"))
      << "its name begins as the root's does";
  EXPECT_THAT(refusal("/etc/passwd"), HasSubstr("leads out"));
}

TEST_F(SceneRootsTest, RefusesWhatIsNoFile) {
  EXPECT_THAT(refusal(""), HasSubstr("names no file"));
  EXPECT_THAT(refusal(std::string("a.obj\0x", 7)), HasSubstr("names no file"));
  EXPECT_THAT(refusal("inner"), HasSubstr("is no file"));
  EXPECT_THAT(refusal("dangling.obj"), HasSubstr("is no file"));
  EXPECT_THAT(refusal("none.obj"), HasSubstr("'none.obj'"));
  EXPECT_THAT(refusal("\x1b[2J"), Not(HasSubstr("\x1b")));
}

TEST_F(SceneRootsTest, AsksItsRootsInTurn) {
  std::string error;
  const SceneRoots both = SceneRoots::make({base_ / "root", base_ / "root2"}, error);
  EXPECT_EQ(both.resolve("c.obj").file, base_ / "root2/c.obj");
  EXPECT_THAT(SceneRoots().resolve("a.obj").error, HasSubstr("no scene roots"));
  EXPECT_TRUE(SceneRoots::make({base_ / "none"}, error).empty());
  EXPECT_THAT(error, HasSubstr("none"));
  error.clear();
  EXPECT_TRUE(SceneRoots::make({base_ / "root/a.obj"}, error).empty());
  EXPECT_THAT(error, HasSubstr("not a folder"));
}

}  // namespace
}  // namespace camway::service
