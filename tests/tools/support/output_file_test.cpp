// SPDX-License-Identifier: MIT
#include "tools/support/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temporary_folder.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// Limits the length of this process's files while it exists, like a full disk.
class LengthLimit {
 public:
  explicit LengthLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~LengthLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  LengthLimit(const LengthLimit&) = delete;
  LengthLimit& operator=(const LengthLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(OutputFile, IsWrittenAndReplaced) {
  const camway::testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "answer.json";
  const std::string bytes("a\0b\n", 4);
  EXPECT_EQ(write_file(file, bytes), "");
  EXPECT_EQ(content(file), bytes);
  EXPECT_EQ(write_file(file, "c"), "");
  EXPECT_EQ(content(file), "c");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(OutputFile, StaysAsItWasWhereTheNewOneFindsNoRoom) {
  const camway::testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "answer.json";
  ASSERT_EQ(write_file(file, "old"), "");
  {
    const LengthLimit limit(1000);
    EXPECT_THAT(write_file(file, std::string(100'000, 'x')),
                AllOf(HasSubstr("answer.json"), HasSubstr("File too large")));
  }
  EXPECT_EQ(content(file), "old");
  EXPECT_EQ(files_in(folder.path()), 1U) << "no half of it is left behind";
}

TEST(OutputFile, SaysWhichFolderIsNotThere) {
  EXPECT_THAT(write_file("/nowhere/answer.json", "x"),
              AllOf(HasSubstr("/nowhere/answer.json"), HasSubstr("No such file")));
}

TEST(OutputFile, StandardOutputAndInputsAreNotWritten) {
  const camway::testing::TemporaryFolder folder;
  const std::string input = folder.write("input", "text");
  EXPECT_NE(why_unwritable("-", {}), "");
  EXPECT_NE(why_unwritable(input, {"", input}), "");
  EXPECT_NE(why_unwritable(folder.path() / "./input", {input}), "");
  EXPECT_EQ(why_unwritable(folder.path() / "output", {"", input}), "");
}

TEST(OutputFile, ALinkStaysOne) {
  const camway::testing::TemporaryFolder folder;
  const fs::path link = folder.path() / "link";
  fs::create_symlink(folder.path() / "target", link);
  EXPECT_EQ(write_file(link, "x"), "");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content(folder.path() / "target"), "x");
  EXPECT_THAT(write_file("/dev/full", "x"), HasSubstr("/dev/full: cannot be written: No space"));
}

TEST(OutputFile, WhatCouldNotBeWrittenIsToldBeforeAndNothingIsLeft) {
  const camway::testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "answer.json";
  EXPECT_EQ(why_unwritable(file, {}), "");
  EXPECT_EQ(files_in(folder.path()), 0U);
  EXPECT_EQ(write_file(file, "before"), "");
  EXPECT_EQ(why_unwritable(file, {}), "");
  EXPECT_EQ(content(file), "before");
  EXPECT_EQ(files_in(folder.path()), 1U);
  EXPECT_EQ(why_unwritable("/dev/null", {}), "");
  for (const fs::path& bad :
       {folder.path() / "no" / "answer.json", folder.path(), file / "answer.json"}) {
    EXPECT_THAT(why_unwritable(bad, {}),
                AllOf(HasSubstr(bad.string()), HasSubstr("cannot be written")));
    EXPECT_NE(write_file(bad, "x"), "") << "both say so";
  }
}

}  // namespace
}  // namespace camway::tools
