// SPDX-License-Identifier: MIT
#include "tools/support/scratch_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

TEST(ScratchFolder, IsItsOwnersAloneAndGoesWithAllThatItHolds) {
  base::Result<ScratchFolder> made = ScratchFolder::make("test");
  ASSERT_TRUE(made) << made.error;
  const fs::path path = made->path();
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
  fs::create_directory(path / "inner");
  std::ofstream(path / "inner" / "file") << "text";
  {
    const ScratchFolder moved(*std::move(made));
    made.value.reset();
    EXPECT_TRUE(fs::exists(moved.path() / "inner" / "file"));
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(ScratchFolder, TwoOfOnePurposeDiffer) {
  const base::Result<ScratchFolder> one = ScratchFolder::make("test");
  const base::Result<ScratchFolder> other = ScratchFolder::make("test");
  ASSERT_TRUE(one && other);
  EXPECT_NE(one->path(), other->path());
}

}  // namespace
}  // namespace camway::tools
