// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_roots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <optional>

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
    roots_ = *SceneRoots::make({base_ / "root"});
  }
  ~SceneRootsTest() override { fs::remove_all(base_); }

  [[nodiscard]] std::string refusal(const std::string& asked) const {
    const base::Result<fs::path> rooted = roots_.resolve(asked);
    EXPECT_FALSE(rooted) << asked;
    EXPECT_THAT(rooted.error, Not(HasSubstr("secret")));
    return rooted.error;
  }

  fs::path base_;
  SceneRoots roots_;
};

TEST_F(SceneRootsTest, FindsFilesBelowARoot) {
  EXPECT_EQ(roots_.resolve("a.obj").value, base_ / "root/a.obj");
  EXPECT_EQ(roots_.resolve("inner/b.obj").value, base_ / "root/inner/b.obj");
  EXPECT_EQ(roots_.resolve("./inner//b.obj").value, base_ / "root/inner/b.obj");
  EXPECT_EQ(roots_.resolve((base_ / "root/a.obj").string()).value, base_ / "root/a.obj");
  EXPECT_EQ(roots_.resolve("inner/in.obj").value, base_ / "root/a.obj") << "a link that stays in";
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
  const SceneRoots both = *SceneRoots::make({base_ / "root", base_ / "root2"});
  EXPECT_EQ(both.resolve("c.obj").value, base_ / "root2/c.obj");
  EXPECT_THAT(SceneRoots().resolve("a.obj").error, HasSubstr("no scene roots"));
  EXPECT_THAT(SceneRoots::make({base_ / "none"}).error, HasSubstr("none"));
  EXPECT_THAT(SceneRoots::make({base_ / "root/a.obj"}).error, HasSubstr("not a folder"));
}

/// Returns the content of a file; nothing if there is none.
std::optional<std::string> content(const fs::path& file) {
  std::ifstream in(file);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

TEST_F(SceneRootsTest, WritesBelowARootAndNowhereElse) {
  EXPECT_EQ(roots_.write("map.bt", ".bt", "first"), "");
  EXPECT_EQ(roots_.write("map.bt", ".bt", "second"), "");
  EXPECT_EQ(content(base_ / "root" / "map.bt"), "second");
  EXPECT_EQ(roots_.write((base_ / "root" / "inner" / "deep.bt").string(), ".bt", "x"), "");
  EXPECT_EQ(content(base_ / "root" / "inner" / "deep.bt"), "x");

  fs::create_symlink(base_ / "secret.bt", base_ / "root" / "link.bt");
  std::ofstream(base_ / "secret.bt") << "secret";
  EXPECT_EQ(roots_.write("link.bt", ".bt", "y"), "") << "the link is replaced, not followed";
  EXPECT_EQ(content(base_ / "secret.bt"), "secret");
  EXPECT_EQ(content(base_ / "root" / "link.bt"), "y");
  EXPECT_FALSE(fs::is_symlink(base_ / "root" / "link.bt"));

  const std::string beside = (base_ / "map.bt").string();
  const std::string in_another = (base_ / "root2" / "map.bt").string();
  for (const std::string& bad :
       {std::string("../map.bt"), std::string("up/map.bt"), std::string("a.obj"),
        std::string(".bt"), std::string(".hidden.bt"), std::string(), std::string("missing/map.bt"),
        beside, in_another}) {
    EXPECT_THAT(roots_.write(bad, ".bt", "z"), HasSubstr("file: '" + bad + "'"));
  }
  EXPECT_FALSE(fs::exists(base_ / "map.bt") || fs::exists(base_ / "root2" / "map.bt"));
  EXPECT_EQ(content(base_ / "root" / "a.obj"), "v 0 0 0\n");
  EXPECT_THAT(SceneRoots().write("map.bt", ".bt", "z"), HasSubstr("no scene roots"));
  for (const auto& entry : fs::recursive_directory_iterator(base_ / "root")) {
    EXPECT_THAT(entry.path().string(), Not(HasSubstr("unfinished")));
  }
}

}  // namespace
}  // namespace camway::service
